#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/map_reader.hpp"
#include "studies/record/study_plan.hpp"

namespace frahm::studies {

// What has changed between two studies that have not the same fingerprint, a line for each: "parameter M: 80
// kg, now 90 kg". All that their documents say; where these say the same, that it is a file or the program.
std::vector<std::string> study_changes(const Study& kept, const Study& now);

// The same of a result and what is to replace it, a branch with its course; of the study none where the
// result has no study that can be read.  file: the result's own.
std::vector<std::string> changes_since(const results::MapReader& result, const std::filesystem::path& file,
                                       const StudyPlan& now);

// What pages tell of a study and no number depends on, where it is not that of the result: "title",
// "[report]".
std::vector<std::string> words_changed_since(const results::MapReader& result,
                                             const std::filesystem::path& file, const Study& now);

// Whether there is a result whose study says the same as this one in all that a result depends on, so that
// only the content of a file that it reads, or the program, can have changed.
bool has_same_document(const std::filesystem::path& result, const Study& now);

}  // namespace frahm::studies
