#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/map_reader.hpp"
#include "results/report/page_data.hpp"

namespace frahm::studies {

// What of a result its page shows: the quantities of a map asked for, else those of the study's [report],
// else what an atlas shows; and what the study itself tells (its cranks, the period of its excitation). Where
// the stored study cannot be read again that is left out, with a word on standard error.  file: of `result`;
// all_digits: of the map's numbers, else six.
// Throws StudyError for a quantity that the map does not have, and for more numbers than a page can hold.
results::PageContent page_content(const results::MapReader& result, const std::filesystem::path& file,
                                  const std::vector<std::string>& quantities, bool all_digits);

}  // namespace frahm::studies
