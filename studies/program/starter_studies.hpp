#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frahm::studies {

// The kinds of study that there is a starter of.
std::vector<std::string> starter_kinds();

// A study of the kind to start from, with comments, that runs as it is; "" for an unknown kind.
std::string starter_study(std::string_view kind);

}  // namespace frahm::studies
