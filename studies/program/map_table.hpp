#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>

#include "studies/map/map_plan.hpp"
#include "studies/program/logged_run.hpp"

namespace frahm::studies {

// The short table that ends a run: worst value of the headline along the slowest axis, shares of the
// regimes, statuses, effort, and for the first failed points the command that reproduces each. study: as the
// user named it. Returns the exit code: 3 if points failed, otherwise 0.
int print_map_table(const MapPlan& plan, const std::filesystem::path& study,
                    const std::filesystem::path& file, const std::optional<Effort>& effort,
                    std::ostream& out);

}  // namespace frahm::studies
