// Replaces the source that bundle.mjs makes, if there is no Node.js.
#include "results/report/page_parts.hpp"

namespace frahm::results {

const std::string_view page_before_title, page_before_data, page_after_data;
const std::string_view figures_script;

}  // namespace frahm::results
