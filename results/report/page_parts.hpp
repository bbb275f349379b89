#pragma once

#include <string_view>

// What bundle.mjs makes of page/, as text in the program; all empty where it was built without Node.js.
namespace frahm::results {

extern const std::string_view page_before_title, page_before_data, page_after_data;
extern const std::string_view figures_script;

}  // namespace frahm::results
