#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

namespace frahm::studies {

// Writes every figure of a page as SVG, its numbers as CSV, and as PDF where rsvg-convert or inkscape is
// installed, into a folder (made if it is not there), and prints their names to `out`.  data: of
// results::page_data.  Node.js draws them. Throws StudyError if it is not installed, and engine::IoError,
// also if a figure could not be drawn (after all others are written).
void write_paper_figures(const std::string& data, const std::filesystem::path& folder, std::ostream& out);

}  // namespace frahm::studies
