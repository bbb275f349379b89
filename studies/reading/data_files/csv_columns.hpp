#pragma once

#include <filesystem>

#include "studies/reading/data_files/record_columns.hpp"

namespace frahm::studies {

// The columns of a CSV file.
RawRecord read_csv_columns(const ColumnReading& reading, const std::filesystem::path& path);

}  // namespace frahm::studies
