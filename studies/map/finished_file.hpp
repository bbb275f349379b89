#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/fingerprint.hpp"
#include "results/map_reader.hpp"

namespace frahm::studies {

// The fingerprint of the study that a result file was made from; nothing if there is no such file.
// Throws results::StoreError for a file that is no result of this program.
std::optional<engine::Fingerprint> fingerprint_of_file(const std::filesystem::path& path);

// A text of /provenance; empty if there is none of this name.
std::string provenance_text(const results::MapReader& map, const std::string& name);

}  // namespace frahm::studies
