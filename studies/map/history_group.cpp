#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/motion/motion_columns.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/provenance/assembly_stage.hpp"

namespace frahm::studies {
namespace {

// One listed point and its motion, without samples where it failed.
struct KeptHistory {
  std::vector<double> parameters;  // SI
  std::size_t record = 0;
  transient::ForcedMotion motion;
};

// A history without samples.
transient::Samples no_samples(const mechanics::Network& network) {
  transient::Samples samples;
  const std::size_t coordinates = mechanics::coordinate_count(network);
  samples.displacement.resize(coordinates);
  samples.velocity.resize(coordinates);
  samples.acceleration.resize(coordinates);
  samples.dissipated.resize(network.elements.size() + (mechanics::has_structural_damping(network) ? 1 : 0));
  return samples;
}

KeptHistory keep_history(const Study& study, const KeptPoint& point, const AssemblyOptions& how) {
  KeptHistory kept{.parameters = study.parameters.nominal(), .record = point.record, .motion = {}};
  for (const Assignment& assignment : point.at) kept.parameters[assignment.parameter] = assignment.value;
  study.parameters.complete(std::span<double>(kept.parameters));
  try {
    transient::ForcedOptions options = forced_options(study, kept.parameters);
    options.watch = [&how] {
      if (how.stop_asked && how.stop_asked()) throw AssemblyStopped{};
    };
    kept.motion = motion_at(study, kept.parameters, kept.record, options);
    if (kept.motion.failure.empty()) return kept;
  } catch (const mechanics::MechanicsError&) {  // the point fails as it does in the map
  } catch (const StudyError&) {
  }
  kept.motion = {};
  kept.motion.history = no_samples(study.network);
  return kept;
}

// Time, then what the record of a single motion has along it.
std::vector<results::Column> history_columns(const Study& study, const transient::ForcedMotion& motion) {
  MotionColumns columns(study);
  columns.add_samples(motion.history);
  if (study.transient()->sweep_to) columns.add_frequencies("frequency", "time", motion.frequency);
  return columns.take();
}

}  // namespace

void write_histories(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer) {
  const Study& study = plan.study;
  const auto& points = study.map()->output.histories;
  if (points.empty()) return;
  results::RaggedLayout layout{.group = "histories",
                               .row = "history",
                               .row_variables = row_variables(study),
                               .sample = "sample",
                               .sample_variables = {}};
  transient::ForcedMotion nothing;
  nothing.history = no_samples(study.network);
  for (results::Column& column : history_columns(study, nothing))
    layout.sample_variables.push_back(std::move(column.variable));
  const std::size_t table = writer.create_ragged(layout);
  const auto append = [&](const KeptHistory& kept) {
    std::vector<std::vector<double>> samples;
    for (results::Column& column : history_columns(study, kept.motion))
      samples.push_back(std::move(column.values));
    writer.append_ragged(table, row_values(study, kept.parameters, kept.record), samples);
  };
  const engine::PieceWork keep = [&](std::uint64_t number) {
    return [kept = keep_history(study, points[number], options), &append] { append(kept); };
  };
  carry_out({.name = "histories",
             .pieces = points.size(),
             .points = points.size(),
             .points_of = [](std::uint64_t) { return 1; },
             .make_work = [&keep] { return keep; }},
            options);
}

}  // namespace frahm::studies
