#pragma once

#include <vector>

#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Texts of /page with the names of quantities, separated by commas: those that the page of a map shows unless
// others are asked for, and those that it shows whatever is asked for.
inline constexpr const char* shown_text = "shown";
inline constexpr const char* always_shown_text = "always_shown";

// What a result says of its study to the page: /page, and the groups in it, each after the one above it
// (results/FORMAT.md). layout: of the map in the file; without axes for any other result.
std::vector<results::GroupContent> page_groups(const Study& study, const results::MapLayout& layout);

}  // namespace frahm::studies
