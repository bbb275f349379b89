#pragma once

#include <string>
#include <vector>

#include "results/map_reader.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/studies/small_studies.hpp"

// Runs of a small map of one mass, for tests of the command line.
namespace runs {

using Names = std::vector<std::string>;

inline const std::string small =
    small_studies::oscillator() + small_studies::axis("f", 0, 1, 5) + small_studies::axis("r", 0.2, 2, 31);

inline Outcome run(const std::string& study, const std::string& output, const Names& more = {}) {
  Names arguments{"run", study, "-o", output, "--threads", "1", "--progress", "none"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return frahm(arguments);
}

// A text of a result's provenance.
inline std::string provenance(const std::string& path, const std::string& name) {
  for (const auto& [key, text] : ::frahm::results::MapReader(path).texts("provenance")) {
    if (key == name) return text;
  }
  return "none";
}

}  // namespace runs
