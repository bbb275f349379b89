#pragma once

#include <filesystem>

#include "results/map_reader.hpp"

namespace frahm::studies {

// Opens the map that --from names.  Throws engine::IoError for a folder or a file that is not HDF5,
// StudyError for the result of another kind of study, results::StoreError for a file that is damaged or not
// of this program.
results::MapReader open_earlier_map(const std::filesystem::path& file);

}  // namespace frahm::studies
