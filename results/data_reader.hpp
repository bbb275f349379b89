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

// Reads columns of numbers from an HDF5 or netCDF-4 file, of ours or of anybody's.
class DataReader {
 public:
  // Throws StoreError if it cannot be opened.
  explicit DataReader(const std::filesystem::path& path);

  // The dataset of a path, such as "transient/time": one dimension, numbers of any type; what its _FillValue
  // marks as missing is NaN. Throws StoreError if there is none (saying what else there is), if it has
  // another shape or type, is packed by scale_factor or add_offset, or where its data are damaged.
  DataColumn read(const std::string& dataset) const;

 private:
  hdf5::File file_;
};

}  // namespace frahm::results
