#pragma once

#include <optional>

#include "solvers/mechanics/network.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/profile.hpp"

namespace frahm::studies {

// The profile of [report], else that of a system of more than eight masses: all of them, as the study lists
// them. Nothing for other systems.  report: null if the study has no such table. Throws StudyError.
std::optional<Profile> read_profile(const TomlSection* report, const mechanics::Network& network);

}  // namespace frahm::studies
