#pragma once

#include <string>

#include "tests/invariants/drawn_network.hpp"

namespace frahm::invariants {

// The network as a study of one point, for `frahm point`.
std::string study_text(const Case& shown, const std::string& title);

}  // namespace frahm::invariants
