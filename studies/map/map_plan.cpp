#include "studies/map/map_plan.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "studies/map/fingerprint.hpp"
#include "studies/map/map_kernel.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/map/tile_record.hpp"
#include "studies/reading/assignment.hpp"

namespace frahm::studies {
namespace {

// A value on the command line that the grid overrules would be silently without effect.
void refuse_axes(const StudyFile& study, const std::vector<std::string>& set) {
  for (const std::string& text : set) {
    for (const Assignment& assignment : parse_assignments(study, "--set", text)) {
      for (const ParameterAxis& axis : study.axes) {
        if (axis.parameter != assignment.parameter) continue;
        throw StudyError(fmt::format("--set \"{}\": \"{}\" runs along an axis of the map; change the axis",
                                     text, study.parameters.list[axis.parameter].name));
      }
    }
  }
}

}  // namespace

MapPlan plan_map(StudyFile study, std::vector<std::string> set) {
  if (study.kind != StudyKind::sweep)
    throw StudyError(
        fmt::format("{}: a {} is one motion, not a map", study.source.name, kind_name(study.kind)));
  refuse_axes(study, set);
  MapPlan plan{.study = std::move(study), .set = std::move(set)};
  plan.grid = grid_of(plan.study);
  plan.quantities = output_quantities(plan.study);
  plan.variables = output_variables(plan.study, plan.quantities);
  plan.fingerprint = fingerprint(plan.study, plan.grid, plan.quantities);
  return plan;
}

MapPlan plan_motion(StudyFile study, std::vector<std::string> set) {
  MapPlan plan{.study = std::move(study), .set = std::move(set)};
  plan.fingerprint = fingerprint(plan.study, plan.grid, plan.quantities);
  return plan;
}

engine::Job job_of(const MapPlan& plan) {
  const auto points = [&plan](std::uint64_t tile) { return plan.grid.box(tile).points(); };
  return {.tiles = plan.grid.tiles(),
          .fingerprint = plan.fingerprint,
          .make_kernel = [&plan]() -> engine::Kernel {
            // Shared, as an engine::Kernel has to be copyable.
            auto kernel = std::make_shared<MapKernel>(plan.study, plan.grid, plan.quantities);
            return [kernel](std::uint64_t tile, engine::Bytes& out) { (*kernel)(tile, out); };
          },
          .points = points,
          .failed =
              [&plan, points](std::uint64_t tile, std::span<const std::byte> record) {
                return count_failed(record, points(tile) * plan.variables.size());
              }};
}

}  // namespace frahm::studies
