#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/map_writer.hpp"
#include "studies/provenance/provenance.hpp"

namespace frahm::studies {

// The end of every result, of any kind of study: writes what it says of its study, /provenance and /page, and
// finishes the file. layout: with which the writer was made. failed, missing: of provenance(). Throws as
// results::MapWriter does.
void finish_result(results::MapWriter& writer, const StudyPlan& plan, const results::MapLayout& layout,
                   const RunFacts& run, const std::vector<std::string>& failed = {},
                   std::uint64_t missing = 0);

}  // namespace frahm::studies
