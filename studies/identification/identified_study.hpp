#pragma once

#include <filesystem>
#include <string>

namespace frahm::studies {

// The first line of each such study.
inline constexpr const char* identified_mark =
    "# Made by frahm export from an identification, whose estimates it contains.";

// A study with the estimates of an identification's file, ready to run, to sweep and to tune:
// - the study's own system, its parameters at their estimates, swept over its modes: under its excitation, or
//   under a force on its first mass if it has none. Where the frequency is computed from other parameters,
//   the motion of the first record instead;
// - without a system the one mass whose damping ratio was found, under a force.
// Throws StudyError for a file that is no identification, and where an estimate is missing or not determined.
std::string identified_study(const std::filesystem::path& file);

}  // namespace frahm::studies
