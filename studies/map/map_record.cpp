#include "studies/map/map_record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>

#include "studies/map/build_facts.hpp"
#include "studies/map/finished_file.hpp"

namespace frahm::studies {
namespace {

std::string unit_or_one(const std::string& unit) {
  return unit.empty() ? "1" : unit;
}

results::Coordinate coordinate_of(const Study& study, const ParameterAxis& axis) {
  const Parameter& parameter = study.parameters.list[axis.parameter];
  return {.name = parameter.name,
          .unit = unit_or_one(axis.unit),
          .long_name =
              parameter.used_as.empty() ? fmt::format("parameter {}", parameter.name) : parameter.used_as,
          .values = axis.values};
}

std::vector<results::Axis> axes_of(const Study& study) {
  std::vector<results::Axis> axes;
  for (const GridDimension& dimension : study.sweep()->dimensions) {
    results::Axis axis{.name = dimension.name, .size = dimension.size};
    for (const std::size_t a : dimension.axes)
      axis.coordinates.push_back(coordinate_of(study, study.sweep()->axes[a]));
    axes.push_back(std::move(axis));
  }
  for (const DerivedCoordinate& derived : study.sweep()->coordinates) {
    axes[derived.dimension].coordinates.push_back(
        {.name = derived.name,
         .unit = unit_or_one(derived.unit),
         .long_name = derived.long_name.empty() ? derived.name : derived.long_name,
         .values = coordinate_values(study, derived)});
  }
  return axes;
}

results::Variable variable_of(const Study& study, const periodic::QuantityDescription& description) {
  results::Variable variable{
      .name = description.name, .unit = description.unit, .long_name = description.long_name};
  if (description.kind == periodic::QuantityKind::count) variable.type = results::Type::int32;
  if (description.kind == periodic::QuantityKind::real && study.sweep()->output.single_precision) {
    variable.type = results::Type::float32;
  }
  if (description.kind == periodic::QuantityKind::flag) {
    variable.type = results::Type::flag;
    variable.unit.clear();
    for (const auto& [meaning, value] : description.flags) variable.flags.push_back({meaning, value});
  }
  return variable;
}

}  // namespace

std::string utc_now() {
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", now);
}

results::MapLayout file_layout(const StudyPlan& plan, const RunRecord& run) {
  const Study& study = plan.study;
  results::MapLayout layout{.title = study.title,
                            .source = fmt::format("frahm {}", build_facts().version),
                            .history = fmt::format("{} {}", run.started, run.command)};
  if (layout.title.empty()) layout.title = std::filesystem::path(study.source.name).stem().string();
  return layout;
}

results::MapLayout map_layout(const MapPlan& plan, const RunRecord& run) {
  results::MapLayout layout = file_layout(plan, run);
  layout.axes = axes_of(plan.study);
  layout.chunk = plan.grid.chunk;
  for (const auto& variable : plan.variables) layout.variables.push_back(variable_of(plan.study, variable));
  return layout;
}

std::vector<results::Text> provenance(const StudyPlan& plan, const RunRecord& run,
                                      const std::vector<std::string>& failed, std::uint64_t missing) {
  const BuildFacts facts = build_facts();
  std::vector<results::Text> texts{
      {"study", plan.study.source.text},
      {"study_file", std::filesystem::path(plan.study.source.name).filename().string()},
      {"overrides", fmt::format("{}", fmt::join(plan.set, ", "))},
      {"fingerprint_physics", plan.fingerprint.physics},
      {"fingerprint_grid", plan.fingerprint.grid},
      {"program", "frahm " + facts.version},
      {"commit", facts.commit},
      {"compiler", facts.compiler},
      {"flags", facts.flags},
      {"libraries", fmt::format("{}", fmt::join(facts.libraries, ", "))},
      {"threads", fmt::format("{}", run.threads)},
      {"ranks", fmt::format("{}", run.ranks)},
      {"started", run.started},
      {"finished", utc_now()}};
  if (plan.grown_from) {
    texts.emplace_back("grown_from", plan.grown_from->file);
    texts.emplace_back(grown_from_identity, plan.grown_from->identity);
  }
  if (missing > 0) texts.emplace_back(missing_tiles_text, fmt::format("{}", missing));
  if (!failed.empty()) texts.emplace_back("failed_points", fmt::format("{}", fmt::join(failed, "\n")));
  return texts;
}

}  // namespace frahm::studies
