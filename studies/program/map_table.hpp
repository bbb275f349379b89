#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>

#include "studies/map/map_plan.hpp"

namespace frahm::studies {

// What a run took.
struct Effort {
  std::uint64_t points = 0;  // computed by it
  std::uint64_t reused = 0;  // taken over by it from an earlier result
  double seconds = 0.0;      // wall time of the whole program
  double cpu_seconds = 0.0;  // of all threads
  int threads = 0;           // of all ranks
  int ranks = 1;
};

// The short table that ends a run: worst peak of the first mass along the slowest axis, shares of the
// regimes, statuses, effort, and for the first failed points the command that reproduces each. study: as the
// user named it. Returns the exit code: 3 if points failed, else 0.
int print_map_table(const MapPlan& plan, const std::filesystem::path& study,
                    const std::filesystem::path& file, const std::optional<Effort>& effort,
                    std::ostream& out);

}  // namespace frahm::studies
