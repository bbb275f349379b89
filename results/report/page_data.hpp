#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "results/map_reader.hpp"

namespace frahm::results {

// A group that the page shows but the file does not contain.
struct PageGroup {
  std::string name;
  std::vector<Column> columns;
  std::vector<Text> texts = {};
};

// The contents of a result's page.
struct PageContent {
  std::string file;                          // file name shown on the page
  std::vector<std::string> parameters = {};  // coordinates of the map that are the study's own parameters
  std::vector<std::string> variables = {};   // of the map; of the others the page has the names only
  std::vector<PageGroup> groups = {};        // besides those of the file
  std::optional<std::size_t> samples = {};   // the axis of the map along which parameters scatter
  bool all_digits = false;                   // of the map's numbers; otherwise six
};

// The result as JSON, the data of its page (page/record.js reads it): attributes of the root; axes with their
// coordinates; variables to six digits, or all; every group's numbers and texts; the provenance. The
// JSON contains no "<", so that no text of the study can end the script element around it. Throws
// std::invalid_argument for a variable that the map does not have, StoreError.
std::string page_data(const MapReader& result, const PageContent& content);

}  // namespace frahm::results
