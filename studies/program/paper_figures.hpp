#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

namespace frahm::studies {

// Writes every figure of a page as SVG, its numbers as CSV, and as PDF where rsvg-convert or inkscape is
// installed, into a folder (made if it is not there), and prints their names to `out`.  data: of
// results::page_data.  Node.js draws them. Throws StudyError where it is not installed, engine::IoError,
// also, once the others are there, where a figure could not be drawn.
void write_paper_figures(const std::string& data, const std::filesystem::path& folder, std::ostream& out);

}  // namespace frahm::studies
