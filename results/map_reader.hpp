#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "results/data_check.hpp"
#include "results/hdf5.hpp"
#include "results/layout.hpp"

namespace frahm::results {

// Whether a file is a result of frahm that HDF5 survives: check_structure(), then its format and version.
// Throws StoreError.
void check_result(const std::filesystem::path& path);

// Reads a result file (FORMAT.md). Throws StoreError if the file cannot be opened, is not frahm's, is of a
// newer format, or has damaged data (each chunk carries a checksum).
class MapReader {
 public:
  explicit MapReader(const std::filesystem::path& path);

  // The map in a group of the file (MapWriter::create_map), or numbers on no axis. StoreError if there is no
  // such group. The texts and groups are those of the file.
  MapReader(const std::filesystem::path& path, const std::string& group);

  const std::filesystem::path& path() const { return path_; }

  // The layout of the map; its chunk is that of the variables; where
  // these are not in chunks, some rows.
  const MapLayout& layout() const { return layout_; }

  // A box of a variable (index into layout().variables), row-major, in its unit; missing values as stored:
  // NaN in floats, -1 in integers, 0 in flags. Throws std::invalid_argument for a box outside the map.
  std::vector<double> read(std::size_t variable, std::span<const std::uint64_t> start,
                           std::span<const std::uint64_t> count) const;

  bool has_group(const std::string& name) const;
  std::vector<std::string> groups() const;  // their paths ("optimum", "optimum/front")

  // The texts of a group ("provenance"), in order of writing. StoreError if there is no such group.
  std::vector<Text> texts(const std::string& group) const;

  // All numbers and columns of a group except its indices: dimension scales first, then in order of
  // writing. In ragged groups row i has the samples row_start[i] <= s < row_start[i + 1], the last row those
  // up to the end. StoreError if there is no such group.
  std::vector<Column> columns(const std::string& group) const;

  // Reads all numbers of the file. Throws StoreError, naming the dataset, for the first that are damaged.
  void check_data(Completeness completeness) const;

 private:
  void read_map(const hdf5::Group& group);

  std::filesystem::path path_;
  hdf5::File file_;
  MapLayout layout_;
  std::vector<hdf5::Dataset> datasets_;  // of the variables
};

}  // namespace frahm::results
