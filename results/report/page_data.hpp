#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "results/map_reader.hpp"

namespace frahm::results {

// The group that a run writes for the page (FORMAT.md), and the texts in it that are about a map. The page
// has the groups in it, such as /page/crank, by their own names.
inline constexpr const char* page_group = "page";
inline constexpr const char* parameters_text = "parameters";
inline constexpr const char* samples_text = "samples";

// The names in a text of /page; none if the file, of an earlier version, has no such text. Throws StoreError.
std::optional<std::vector<std::string>> page_list(const MapReader& result, const std::string& text);

// The contents of a result's page.
struct PageContent {
  std::string file;                         // file name shown on the page
  std::vector<std::string> variables = {};  // of the map; of the others the page has the names only
  bool all_digits = false;                  // of the map's numbers; otherwise six
};

// The result as JSON, the data of its page (page/record.js reads it): attributes of the root; axes with their
// coordinates; variables to six digits, or all; every group's numbers and texts; the provenance. The
// JSON contains no "<", so that no text of the study can end the script element around it. Throws
// std::invalid_argument for a variable that the map does not have, StoreError.
std::string page_data(const MapReader& result, const PageContent& content);

}  // namespace frahm::results
