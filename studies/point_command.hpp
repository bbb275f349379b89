#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace frahm::studies {

struct PointOptions {
  std::filesystem::path study;
  std::vector<std::string>
      at;  // name=value, a unit behind the value or none; the rest as the study states it
  std::vector<std::string> set;  // the same, applied to the study before
  std::optional<std::filesystem::path>
      history;        // CSV of the time history; "-" is refused: `out` has the report
  bool json = false;  // the report as one JSON object
};

// Tells the periodic response of one point in full: status, every quantity, the sequence of modes over the
// period. Returns 0, or 3 for a point that failed. Throws StudyError for a wrong study, name or value,
// engine::IoError for a history that cannot be written (nothing is left of it then).
int point_command(const PointOptions& options, std::ostream& out);

}  // namespace frahm::studies
