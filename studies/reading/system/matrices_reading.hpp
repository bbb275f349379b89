#pragma once

#include <filesystem>

#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// [[matrices]]: its degrees of freedom become masses, without mass of their own. folder: of the files.
void read_matrices(NetworkReading& reading, const TomlValue& root, const std::filesystem::path& folder);

}  // namespace frahm::studies
