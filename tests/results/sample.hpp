#pragma once

#include <filesystem>
#include <string>

#include "results/layout.hpp"

// One file with everything a result can hold; open_everywhere.py knows its values by the same formulas.
namespace sample {

inline constexpr std::size_t designs = 5, frequencies = 70;
inline constexpr std::size_t chunk_designs = 2, chunk_frequencies = 32;
// Tiles are one design by this many frequencies; this one is left out.
inline constexpr std::size_t tile_width = 16, missing_design = 4, missing_from = 48;

enum Variable : std::size_t { peak, phase, stops, regime, status };

// The value of variable v at design i, frequency j, as the file holds it.
double value(std::size_t v, std::size_t i, std::size_t j);

frahm::results::MapLayout layout();
std::string study_text();  // 200 kB, more than HDF5 keeps in an object header
void write(const std::filesystem::path& path);

}  // namespace sample
