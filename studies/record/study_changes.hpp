#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/reading/study.hpp"

namespace frahm::studies {

// What has changed between two studies that have not the same fingerprint, a line for each: "parameter M: 80
// kg, now 90 kg". All that their documents say; where these say the same, that it is a file or the program.
std::vector<std::string> study_changes(const Study& kept, const Study& now);

// The same of a result and the study that is to replace it; none where the result has no study that can be
// read.
std::vector<std::string> changes_since(const std::filesystem::path& result, const Study& now);

// Whether there is a result whose study says the same as this one in all that a result depends on, so that
// only the content of a file that it reads, or the program, can have changed.
bool has_same_document(const std::filesystem::path& result, const Study& now);

}  // namespace frahm::studies
