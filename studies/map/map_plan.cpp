#include "studies/map/map_plan.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "studies/map/entry_check.hpp"
#include "studies/map/known_points.hpp"
#include "studies/map/map_kernel.hpp"
#include "studies/map/motion_kernel.hpp"
#include "studies/map/motion_quantities.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/map/sample_names.hpp"
#include "studies/map/tile_entry.hpp"
#include "studies/provenance/fingerprint.hpp"

namespace frahm::studies {
namespace {

// Who computes or assembles a map keeps track of each tile, in about 24 bytes.
void check_tiles(const MapPlan& plan) {
  constexpr std::uint64_t most = std::uint64_t{1} << 24;
  if (plan.tiles <= most) return;
  throw StudyError(
      rules::too_large,
      "{}: the map of {} points has {} tiles, but at most {} can be tracked; divide it into several studies",
      plan.study.source.name, plan.grid.points(), plan.tiles, most);
}

void choose_quantities(MapPlan& plan) {
  if (plan.study.sweep()) {
    plan.quantities = output_quantities(plan.study);
    plan.variables = output_variables(plan.study, plan.quantities);
  } else {
    plan.motion_quantities = motion_quantities(plan.study);
    plan.variables = motion_variables(plan.study, plan.motion_quantities);
  }
}

engine::Kernel kernel_of(const MapPlan& plan, const engine::StopAsked& stop_asked, KnownPoints* earlier) {
  // Shared, as an engine::Kernel has to be copyable.
  const auto shared = [](auto kernel) -> engine::Kernel {
    return [kernel](std::uint64_t tile, engine::Bytes& out) { (*kernel)(tile, out); };
  };
  if (plan.study.transient()) return shared(std::make_shared<MotionKernel>(plan, stop_asked, earlier));
  return shared(std::make_shared<MapKernel>(plan.study, plan.grid, plan.quantities, earlier));
}

}  // namespace

MapPlan plan_map(Study study, std::vector<std::string> set) {
  if (!study.map())
    throw StudyError(rules::other_kind, "{}: a {} is one motion, not a map", study.source.name,
                     kind_name(study.kind()));
  refuse_overruled(study, set);
  MapPlan plan;
  plan.study = std::move(study);
  plan.set = std::move(set);
  plan.grid = grid_of(plan.study);
  plan.tiles = plan.grid.tiles();
  check_tiles(plan);
  choose_quantities(plan);
  check_sample_names(plan);
  std::vector<std::string> names;
  for (std::size_t q = 0; q < plan.own_variables(); ++q) names.push_back(plan.variables[q].name);
  plan.fingerprint = fingerprint(plan.study, {plan.grid.order, plan.grid.tile}, names);
  return plan;
}

engine::Job job_of(const MapPlan& plan, KnownPoints* earlier) {
  const auto points = [&plan](std::uint64_t tile) { return plan.grid.box(tile).points(); };
  return {.tiles = plan.tiles,
          .fingerprint = plan.log_header().fingerprint,
          .make_kernel =
              [&plan, earlier](const engine::StopAsked& stop_asked) {
                return kernel_of(plan, stop_asked, earlier);
              },
          .points = points,
          .failed =
              [&plan, points](std::uint64_t tile, std::span<const std::byte> entry) {
                return count_failed(entry, points(tile) * plan.variables.size());
              },
          .check = [&plan](std::uint64_t tile,
                           std::span<const std::byte> entry) { check_entry(plan, tile, entry); },
          .reused = [earlier] { return earlier ? earlier->taken() : std::uint64_t{0}; }};
}

}  // namespace frahm::studies
