#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

namespace frahm::studies {

struct ExportOptions {
  std::filesystem::path file;
  std::filesystem::path output;  // "-": `out`; empty: the file's name with .csv
  std::string group = {};        // "resonance", "orbits", ...: its columns instead of the map; empty: the map
  bool csv = false;              // asked for by name; the only form there is
};

// Writes a map as CSV: a row a point, coordinates first, then variables, numbers to 17 significant digits,
// what was not computed as an empty field (0 in flags). Points in the order of the map. Of a decay or
// transient, or where a group is asked for, the columns of the group side by side, the shorter ones filled with empty fields. Returns 0.
// Throws results::StoreError, engine::IoError.
int export_command(const ExportOptions& options, std::ostream& out);

}  // namespace frahm::studies
