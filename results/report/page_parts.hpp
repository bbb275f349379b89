#pragma once

#include <string_view>

// The text that bundle.mjs makes of page/, as part of the program; all empty if built without Node.js.
namespace frahm::results {

extern const std::string_view page_before_title, page_before_data, page_after_data;
extern const std::string_view figures_script;

}  // namespace frahm::results
