#include "studies/reading/kinds/tune_over_records.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/design_reading.hpp"
#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/kinds/tune_samples.hpp"
#include "studies/reading/kinds/tune_start.hpp"
#include "studies/reading/map/record_axis.hpp"
#include "studies/reading/system/unfit_elements.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

// <mass or signal>_peak or <element>_stroke.
// Whether a joint has a share in a peak or stroke.
bool hangs_on_joint(const Study& study, const transient::MotionQuantity& quantity) {
  using mechanics::Coordinate, mechanics::Node;
  const auto is_joint = [](const Node& node) { return node.kind == mechanics::NodeKind::joint; };
  if (quantity.measure == transient::MotionMeasure::stroke)
    return std::ranges::any_of(study.network.elements[quantity.index].along, is_joint,
                               &mechanics::Share::node);
  const Coordinate its = mechanics::coordinate(study.network, quantity.index);
  if (its.kind == Coordinate::Kind::signal)
    return std::ranges::any_of(study.values.signals[its.index].nodes, is_joint);
  return its.kind == Coordinate::Kind::joint;
}

transient::MotionQuantity read_peak(const TuneReading& reading, const TomlSection& section) {
  const std::string name = section.text("quantity");
  std::vector<std::string> known;
  for (const auto& quantity : transient::all_motion_quantities(reading.study.network, false)) {
    const auto measure = quantity.measure;
    if (measure != transient::MotionMeasure::peak && measure != transient::MotionMeasure::stroke) continue;
    known.push_back(transient::describe(quantity, reading.study.network, reading.study.dimensionless).name);
    if (known.back() != name) continue;
    if (hangs_on_joint(reading.study, quantity))
      section.fail(rules::unfit_quantity, "quantity",
                   "\"{}\" is of a joint without mass; under records it must be of masses and supports",
                   name);
    return quantity;
  }
  section.fail(rules::unfit_quantity, "quantity",
               "\"{}\" is not a peak of a displacement; under records it must be <mass>_peak, <signal>_peak "
               "or <element>_stroke{}",
               name, suggestion(name, known));
}

// The share of the samples whose worst peaks count.
void read_quantile(const TomlSection& section, TuneChoice& choice) {
  if (!section.find("quantile")) return;
  tuning::PeakGoal& goal = choice.peaks->goal;
  goal.share = section.number("quantile");
  if (choice.drawn.empty())
    section.fail(rules::beyond_schema(rules::key_without_use), "quantile",
                 "needs samples: give an [[axis]] of them, as in samples = 100");
  if (goal.objective != tuning::RecordObjective::worst_peak)
    section.fail(rules::beyond_schema(rules::key_without_use), "quantile",
                 "belongs to the worst peaks of samples; write objective = \"worst_peak\"");
}

// The supports' motion and the frequency are no part of what may be tuned under records.
void check_excitation(const TuneReading& reading, const TomlSection& section) {
  const auto& excitations = reading.study.network.excitations;
  const bool repeats = std::ranges::any_of(excitations, [](const mechanics::Excitation& each) {
    return !mechanics::is_recorded(each.kind) &&
           !(each.kind == mechanics::ExcitationKind::force && each.order == 0);
  });
  if (repeats)
    section.fail(rules::unfit_for_method, "objective",
                 "with records ([[excitation.record]]) only constant forces may act; leave out the harmonic "
                 "excitation");
}

double read_duration(const TomlSection& section, const PeakChoice& peaks) {
  if (!section.find("duration")) return end_of_records(peaks.driving);
  return section.number("duration");
}

void read_records_of(const StudyContext& context, const TomlValue& root, const std::filesystem::path& folder,
                     DataFiles data, const TomlSection& section, const Study& study,
                     std::vector<DrivingRecord> corners, PeakChoice& peaks) {
  std::optional<WrittenRecordAxis> axis;
  if (section.find("records")) axis = read_records(context, section);
  peaks.driving = read_driving_records(context, root, folder, data, study.network, std::move(corners), axis,
                                       "\"records\" of [tune]");
  if (axis) peaks.records = axis->names();
  for (const TomlSection& each : record_sections(context.source, find_entry(root, "excitation")->value)) {
    if (peaks.records.empty()) peaks.records.push_back(each.text("file"));
  }
}

void check_designs(const TuneReading& reading, const TomlSection& section) {
  const Study& study = reading.study;
  const auto inputs = study.parameters.inputs_of(study.values.omega.expression.reads());
  for (const DesignChoice& design : reading.choice.designs) {
    if (std::ranges::find(inputs, design.parameter) != inputs.end())
      section.fail(rules::wrong_dependence, "objective",
                   "a motion under records has no frequency that could be tuned, but \"{}\" sets it",
                   study.parameters.list[design.parameter].name);
  }
}

void refuse_tables(const StudyContext& context, const TomlValue& root) {
  for (const char* table : {"constraint", "column", "orbits"}) {
    if (const TomlEntry* entry = find_entry(root, table))
      throw context.source.error_at(rules::beyond_schema(rules::other_kind), entry->position,
                                    "the section \"{}\" is not part of a tuning over records: it belongs to "
                                    "periodic responses over a band",
                                    table);
  }
}

}  // namespace

void read_tuning_over_records(const StudyContext& context, const TomlValue& root,
                              const std::filesystem::path& folder, DataFiles data,
                              std::vector<DrivingRecord> corners, Study& study) {
  refuse_smooth_laws(study, kind_noun(study.kind()));
  refuse_tables(context, root);
  const TomlSection section(context.source, find_entry(root, "tune")->value, "[tune]", "tune", "records");
  TuneReading reading{context, root, study};
  TuneChoice& choice = reading.choice;
  PeakChoice peaks;
  if (section.choice("objective", "", " under records") == "mean_peak")
    peaks.goal.objective = tuning::RecordObjective::mean_peak;
  check_excitation(reading, section);
  peaks.quantity = read_peak(reading, section);
  choice.quantity_name = section.text("quantity");
  read_records_of(context, root, folder, data, section, study, std::move(corners), peaks);
  peaks.duration = read_duration(section, peaks);
  choice.solver = tuning::solver_named(section.choice("solver", "slsqp"));
  read_start(section, choice);
  if (choice.start == tuning::Start::global || choice.start == tuning::Start::map)
    section.fail(rules::beyond_schema(rules::key_without_use), "start",
                 "under records the whole box cannot be searched; write a number of starts");
  choice.tolerance = section.number("tolerance");
  choice.peaks = std::move(peaks);
  read_designs(reading);
  check_designs(reading, section);
  read_scenarios(reading);
  read_samples(reading, folder, data);
  read_quantile(section, choice);
  study.choice = std::move(choice);
}

}  // namespace frahm::studies
