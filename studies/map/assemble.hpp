#pragma once

#include <cstdint>

#include "engine/output_lock.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/provenance/assembly_options.hpp"

namespace frahm::studies {

struct Assembly {
  bool finished = false;  // false: stopped; the output is unchanged, and the other members mean nothing
  std::uint64_t tiles = 0, missing_tiles = 0;
  std::string missing_tasks = {};  // missing_tasks_text()
  std::uint64_t failed_points = 0;
};

// Makes the result file of a plan from the finished tiles in the logs, whoever wrote them, and then removes
// these logs. A team of threads makes its chunks; they are written one at a time in their order, so that the
// file does not depend on the team. It appears complete or not at all. Memory is bounded: some chunks of each
// thread, and 16 bytes a tile.
// held: the lock of the output.  Throws engine::ResumeRefused for logs of another study, engine::IoError for
// tiles that are missing or damaged, results::StoreError.
Assembly assemble(const MapPlan& plan, const RunFacts& run, const AssemblyOptions& options,
                  const engine::OutputLock& held);

}  // namespace frahm::studies
