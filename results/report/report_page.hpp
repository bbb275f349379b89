#pragma once

#include <string>

namespace frahm::results {

// Whether the page's parts were bundled when this program was built (Node.js and npm were there).
bool has_report_page();

// The page of a result: one HTML file that needs nothing else.  title: of the window, any text.  data: of
// page_data.  Throws std::logic_error without the page's parts.
std::string report_page(const std::string& title, const std::string& data);

// A script for Node.js: it reads the same data from standard input, writes every figure of the page as SVG
// and its numbers as CSV into the folder given as argument, and prints their names.  Throws as above.
std::string figure_script();

}  // namespace frahm::results
