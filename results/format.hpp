#pragma once

// The root attributes that identify a result file. See FORMAT.md.
namespace frahm::results {

inline constexpr const char* format_attribute = "format";
inline constexpr const char* format_name = "frahm";
inline constexpr const char* version_attribute = "format_version";
inline constexpr int format_version = 1;

}  // namespace frahm::results
