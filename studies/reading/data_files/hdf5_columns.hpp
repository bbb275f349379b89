#pragma once

#include <filesystem>

#include "studies/reading/data_files/record_columns.hpp"

namespace frahm::studies {

// The columns of an HDF5 file.
RawRecord read_hdf5_columns(ColumnReading reading, const std::filesystem::path& path);

}  // namespace frahm::studies
