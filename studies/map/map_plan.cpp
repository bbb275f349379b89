#include "studies/map/map_plan.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "studies/map/known_points.hpp"
#include "studies/map/map_kernel.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/map/tile_record.hpp"
#include "studies/record/fingerprint.hpp"

namespace frahm::studies {
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
  plan.quantities = output_quantities(plan.study);
  plan.variables = output_variables(plan.study, plan.quantities);
  plan.fingerprint = fingerprint(plan.study, {plan.grid.order, plan.grid.tile}, plan.quantities);
  return plan;
}

engine::Job job_of(const MapPlan& plan, KnownPoints* earlier) {
  const auto points = [&plan](std::uint64_t tile) { return plan.grid.box(tile).points(); };
  return {.tiles = plan.tiles,
          .fingerprint = plan.log_header().fingerprint,
          .make_kernel = [&plan, earlier](const engine::StopAsked&) -> engine::Kernel {
            // Shared, as an engine::Kernel has to be copyable.
            auto kernel = std::make_shared<MapKernel>(plan.study, plan.grid, plan.quantities, earlier);
            return [kernel](std::uint64_t tile, engine::Bytes& out) { (*kernel)(tile, out); };
          },
          .points = points,
          .failed =
              [&plan, points](std::uint64_t tile, std::span<const std::byte> record) {
                return count_failed(record, points(tile) * plan.variables.size());
              },
          .reused = [earlier] { return earlier ? earlier->taken() : std::uint64_t{0}; }};
}

}  // namespace frahm::studies
