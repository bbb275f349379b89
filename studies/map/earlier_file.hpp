#pragma once

#include <filesystem>

#include "results/map_reader.hpp"

namespace frahm::studies {

// Opens the map that --from names.  Throws engine::IoError for a folder and for what is no HDF5 file,
// StudyError for the result of another kind of study, results::StoreError for one that is damaged or not of
// this program.
results::MapReader open_earlier_map(const std::filesystem::path& file);

}  // namespace frahm::studies
