#pragma once

#include <string>
#include <string_view>

// A figure for papers ends with a comment that has a hash of all above it, by which a later one may replace
// it: one that nobody has changed since.
namespace frahm::studies {

// The text of a figure with its mark.  extension: ".svg" or ".pdf", whose comments these are.
std::string with_figure_mark(std::string figure, std::string_view extension);

// Whether a text is a figure with the right mark.
bool has_figure_mark(std::string_view figure, std::string_view extension);

}  // namespace frahm::studies
