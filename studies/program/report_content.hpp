#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/map_reader.hpp"
#include "results/report/page_data.hpp"

namespace frahm::studies {

// The content of a result's page: the requested quantities of a map, otherwise those that its run chose
// (/page, results/FORMAT.md). A file of an earlier version has no /page: a note on standard error says so.
// file: of `result`; all_digits: of the map's numbers, otherwise six. Throws StudyError for a quantity that
// the map does not have, and for more numbers than a page can hold.
results::PageContent page_content(const results::MapReader& result, const std::filesystem::path& file,
                                  const std::vector<std::string>& quantities, bool all_digits);

}  // namespace frahm::studies
