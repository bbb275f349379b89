#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "studies/reading/study/study.hpp"

// A study from its text: the parts of reading it, in their order.
namespace frahm::studies {

// Reads and checks a study. Tables and measurements it names are read too, from paths relative to its own.
// Throws StudyError for anything wrong in it (`file:line:column: key: what was found, the rule, the nearest
// key`) and for a file that cannot be read.
Study read_study(const std::filesystem::path& path);

// The same for a given text; name: of the file, for messages; its folder holds the tables.
Study parse_study(std::string text, const std::filesystem::path& name, DataFiles data = DataFiles::read);

// The study with some number parameters replaced, and checked again.
Study with_parameters(Study study, std::span<const Assignment> assignments);

}  // namespace frahm::studies
