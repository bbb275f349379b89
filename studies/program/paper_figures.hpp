#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

namespace frahm::studies {

// Writes every figure of a page as SVG, its numbers as CSV, and as PDF where rsvg-convert or inkscape is
// installed, into a folder (made if it is not there), and prints their names to `out`.  data: of
// results::page_data.  Node.js draws them. Earlier figures that nobody has changed are replaced, and tables
// with the same columns. Throws StudyError if Node.js is not installed, and engine::IoError: before anything
// is written where another file is in a place, after all others are written where a figure could not be
// drawn.
void write_paper_figures(const std::string& data, const std::filesystem::path& folder, std::ostream& out);

}  // namespace frahm::studies
