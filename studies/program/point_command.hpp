#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "solvers/response/periodic_response.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

struct PointOptions {
  std::filesystem::path study;
  // name=value each, a unit after the value or none. Other parameters have the study's values.
  std::vector<std::string> at = {};
  std::vector<std::string> set = {};  // applied to the study before
  // CSV file of the time history; "-" is refused, as `out` has the report.
  std::optional<std::filesystem::path> history = {};
  std::string path = "fastest";  // or "general": every orbit by shooting
  bool gradient = false;         // derivatives too: exact, by differences, and their deviation
  bool responses = false;        // every stable response that was found too
  bool json = false;             // the report as one JSON object
  bool all = false;              // every quantity and mode, of a large system too
};

// Prints the periodic response of one point in full: status, every quantity, the sequence of modes over the
// period. Returns 0, or 3 for a point that failed. Throws StudyError for a wrong study, name or value, and
// for the history of a point without one; engine::IoError for a history that cannot be written (no part of it
// is left).
int point_command(const PointOptions& options, std::ostream& out);

// Refuses a study whose points have no periodic response. Throws StudyError.
void require_responses(const Study& study);
// General, if the word or the study asks for it.
periodic::Path path_of(const Study& study, const std::string& asked);

}  // namespace frahm::studies
