#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/hdf5.hpp"

namespace frahm::results {

// A column of numbers and the unit that the file gives it.
struct DataColumn {
  std::vector<double> values;
  std::optional<std::string> unit;  // the attribute "units"
};

// A matrix of numbers, row after row.
struct DataMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
};

// What a reader does with a file before it reads: whether it can be opened; whether a dataset of it can be
// read, of so many dimensions. Throw StoreError.
void check_opening(const std::filesystem::path& path);
void check_dataset(const std::filesystem::path& path, const std::string& dataset, std::size_t dimensions);

// Reads columns and matrices of numbers from any HDF5 or netCDF-4 file, written by frahm or by another
// program.
class DataReader {
 public:
  // Throws StoreError if it cannot be opened.
  explicit DataReader(const std::filesystem::path& path);

  // The dataset at a path, such as "transient/time": one dimension, numbers of any type; values equal to its
  // _FillValue become NaN. Throws StoreError if it does not exist (the message lists what does), has another
  // shape or type, is packed by scale_factor or add_offset, lies in another file or behind a soft link, or is
  // damaged.
  DataColumn read(const std::string& dataset) const;
  // The same for a dataset of two dimensions.
  DataMatrix read_matrix(const std::string& dataset) const;

 private:
  std::filesystem::path path_;
  hdf5::File file_;
};

}  // namespace frahm::results
