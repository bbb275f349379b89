#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/map_reader.hpp"
#include "studies/provenance/study_plan.hpp"

namespace frahm::studies {

// What has changed between two studies that have not the same fingerprint, a line for each: "parameter M: 80
// kg, now 90 kg". All that their documents say; where these say the same, that it is a file or the program.
std::vector<std::string> study_changes(const Study& kept, const Study& now);

// The same for a result and what is to replace it, a branch with its course; of the study none where the
// result has no study that can be read.  file: the result's own.
std::vector<std::string> changes_since(const results::MapReader& result, const std::filesystem::path& file,
                                       const StudyPlan& now);

// What a finished result says in other words than a study with its fingerprint: titles, units, whatever
// changes no number; and that an earlier version has not written /page.
struct OtherWords {
  std::optional<Study> kept = std::nullopt;  // the study of the result, where there is something to write
  std::vector<std::string> changes = {};     // a line for each
};

// Throws StudyError where the study of the result can no longer be read, as without a table of samples.
OtherWords other_words(const results::MapReader& result, const std::filesystem::path& file,
                       const StudyPlan& now);

}  // namespace frahm::studies
