#include "studies/provenance/fingerprint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/provenance/digest.hpp"
#include "studies/reading/keys/study_keys.hpp"

namespace frahm::studies {
namespace {

// Raised with every change of the solvers that changes a result by more than the last bits.
constexpr int solver_version = 11;

// The text that is hashed: a line for each item, every number in its shortest exact form.
class CanonicalText {
 public:
  template <typename... Args>
  void line(fmt::format_string<Args...> form, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Args>(args)...);
    text_ += '\n';
  }

  std::string hash() const { return digest(std::as_bytes(std::span(text_))); }

 private:
  std::string text_;
};

// Their order in a study changes nothing.
std::vector<std::size_t> in_order_of_names(const Parameters& parameters) {
  std::vector<std::size_t> order(parameters.list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return parameters.list[i].name; });
  return order;
}

void add_parameters(const Study& study, CanonicalText& text) {
  const auto names = study.parameters.names();
  for (const std::size_t i : in_order_of_names(study.parameters)) {
    const auto& definition = study.parameters.list[i].definition;
    if (has_axis(study, i)) {
      text.line("parameter {} axis", names[i]);
    } else if (const auto* number = std::get_if<double>(&definition)) {
      text.line("parameter {} number {}", names[i], *number);
    } else if (const auto* expression = std::get_if<Expression>(&definition)) {
      text.line("parameter {} expression {}", names[i], expression->canonical_text(names));
    } else {
      const TableOf& table = std::get<TableOf>(definition);
      text.line("parameter {} table of {} x {} y {}", names[i], names[table.of],
                fmt::join(table.table.x, " "), fmt::join(table.table.y, " "));
    }
  }
}

std::string node_text(const mechanics::Node& node) {
  return fmt::format("{}:{}", static_cast<int>(node.kind), node.index);
}

// Two nodes as ever: files of earlier versions know them so.
std::string direction_text(const mechanics::Element& element) {
  if (const auto& ends = element.along; mechanics::is_between_two_nodes(ends))
    return fmt::format("{} {}", node_text(ends[0].node), node_text(ends[1].node));
  std::string text = fmt::format("along rotational {} twists {}", element.rotational, element.twists_ground);
  for (const auto& [node, factor] : element.along) text += fmt::format(" {} {}", node_text(node), factor);
  return text;
}

void add_network(const Study& study, CanonicalText& text) {
  const mechanics::Network& network = study.network;
  const StudyValues& values = study.values;
  const auto names = study.parameters.names();
  const auto value = [&](const StudyValue& each) { return each.expression.canonical_text(names); };
  for (std::size_t i = 0; i < network.masses.size(); ++i) {
    text.line("{} {} {}", mechanics::rotates(network, i) ? "inertia" : "mass", network.masses[i],
              value(values.mass[i]));
  }
  text.line("prescribed {}", fmt::join(network.prescribed, " "));
  for (std::size_t i = 0; i < network.elements.size(); ++i) {
    const mechanics::Element& element = network.elements[i];
    text.line("element {} {} {} {}", element.name, static_cast<int>(element.type), direction_text(element),
              static_cast<int>(element.law));
    const auto keys = mechanics::kind_of(element).values();
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (const StudyValue& each = values.elements[k][i]; each.is_given())
        text.line("{} {}", keys[k]->key, value(each));
    if (element.parts != 1) text.line("parts {}", element.parts);
  }
  for (std::size_t i = 0; i < network.elements.size(); ++i) {
    const StudyCharacteristic& of = values.characteristic[i];
    if (of.kind == StudyCharacteristic::Kind::none) continue;
    text.line("characteristic {} {} sides {}", i, static_cast<int>(of.kind), fmt::join(of.sides, " "));
    for (const mechanics::BendPlace& bend : network.elements[i].bends) text.line("bend {}", bend.law->name);
    for (const StudyValue& each : values.points_of(i)) text.line("point {}", value(each));
  }
  text.line("frequency {}", value(values.omega));
  for (std::size_t i = 0; i < network.excitations.size(); ++i) {
    const mechanics::Excitation& excitation = network.excitations[i];
    text.line("excitation {} {} {} {} {} {} {} {}", static_cast<int>(excitation.kind), excitation.node,
              excitation.order, value(values.amplitude[i]), value(values.phase[i]), value(values.rod[i]),
              excitation.taylor_order, excitation.even_orders);
  }
  text.line("reference order {}", network.reference_order);
  for (const mechanics::Signal& signal : network.signals) {
    text.line("signal {} rotational {}", signal.name, signal.rotational);
    for (const mechanics::Share& share : signal.along)
      text.line("share {} {}", node_text(share.node), share.factor);
  }
  if (network.damping != mechanics::DampingModel::none)
    text.line("damping {}", static_cast<int>(network.damping));
  for (const StudyValue& each : values.damping) text.line("damping value {}", value(each));
  for (const mechanics::MatrixPart& part : network.matrices)
    text.line("matrices {} {} {} {} {}", part.name, fmt::join(part.nodes, " "), digest(part.mass),
              digest(part.stiffness), digest(part.damping));
}

// The properties that distinguish decays or transients of the same network.
void add_motion(const Study& study, CanonicalText& text) {
  const auto names = study.parameters.names();
  const auto add = [&](const char* what, const std::optional<StudyValue>& value) {
    if (value) text.line("{} {}", what, value->expression.canonical_text(names));
  };
  if (study.decay()) add("reference frequency", study.decay()->reference_frequency);
  if (study.transient()) {
    add("sweep to", study.transient()->sweep_to);
    add("sweep rate", study.transient()->sweep_rate);
    if (study.map()) add("duration", study.transient()->duration);
    // The stairs of a run-up are refined until its samples stand.
    if (study.map() && study.transient()->sweep_to) text.line("samples {}", study.transient()->samples);
  }
  for (const InitialValues& initial : study.initial()) {
    text.line("initial {} {} {}", initial.mass, initial.displacement.expression.canonical_text(names),
              initial.velocity.expression.canonical_text(names));
  }
}

// The samples of records, wherever they come from.
void add_driving_records(const Study& study, CanonicalText& text) {
  if (!study.transient() && !(study.tune() && study.tune()->peaks)) return;
  for (const DrivingRecord& driving :
       study.transient() ? study.transient()->records : study.tune()->peaks->driving) {
    for (const transient::Record& record : driving.records)
      text.line("record {} of {} on axis {} time {} values {}{}", driving.excitation,
                static_cast<int>(record.of), driving.on_axis, digest(record.time), digest(record.values),
                record.jumps() ? " linear" : "");
  }
}

void add_comparison(const Study& study, CanonicalText& text) {
  if (!study.sweep() || !study.sweep()->comparison) return;
  const Comparison& comparison = *study.sweep()->comparison;
  text.line("compare law {} slope {} taylor order {}", static_cast<int>(comparison.law),
            comparison.slope.expression.canonical_text(study.parameters.names()), comparison.taylor_order);
  if (comparison.show) text.line("compare show {}", static_cast<int>(*comparison.show));
  for (const periodic::Quantity& quantity : comparison.quantities)
    text.line("compare {}", periodic::describe(quantity, study.network, study.dimensionless).name);
}

// The properties that distinguish tunings of the same network: all that the optimum depends on.
void add_tuning(const Study& study, CanonicalText& text) {
  if (!study.tune()) return;
  const TuneChoice& tune = *study.tune();
  const auto names = study.parameters.names();
  const auto band = [](const tuning::Band& range) { return fmt::format("{} {}", range.from, range.to); };
  text.line("objective {} of {}", static_cast<int>(tune.objective), tune.quantity_name);
  if (const auto& peaks = tune.peaks)
    text.line("peaks {} share {} for {}", static_cast<int>(peaks->goal.objective), peaks->goal.share,
              peaks->duration);
  if (tune.band) text.line("band {} {}", names[tune.band->parameter], band(tune.band->range));
  constexpr int by_default = -1;
  text.line("solver {} start {} global {} tolerance {}", tuning::name(tune.solver),
            tune.start_is_given || tune.peaks ? static_cast<int>(tune.start) : by_default,
            tune.start == tuning::Start::global ? tuning::name(tune.global_solver) : "", tune.tolerance);
  if (tune.weight) text.line("weight {}", tune.weight->expression.canonical_text(names));
  if (tune.objective == tuning::Objective::variance)
    text.line("noise {} {} {}", static_cast<int>(tune.noise.kind), tune.noise.node, tune.noise.intensity);
  if (tune.dominate_constant) text.line("dominates its constant");
  for (const DesignChoice& design : tune.designs)
    text.line("design {} {} {} knots {} slope {} jumps {}", names[design.parameter], design.lower,
              design.upper, fmt::join(design.knots, " "), design.max_slope, design.may_leap);
  for (const LimitChoice& limit : tune.limits)
    text.line("limit {} {} {} over {}", limit.name, limit.lower, limit.upper,
              limit.band ? band(*limit.band) : "all");
  if (tune.trade_off)
    text.line("trade off {} {}", tune.trade_off->name, fmt::join(tune.trade_off->limits, " "));
  for (const ScenarioChoice& scenario : tune.scenarios) {
    for (const Assignment& at : scenario.set) text.line("scenario {} {}", names[at.parameter], at.value);
    text.line("scenario ends");
  }
}

// The content of a tuning's file next to its optimum, and the number of starts.
void add_assessment(const Study& study, CanonicalText& text) {
  if (!study.tune()) return;
  const auto names = study.parameters.names();
  text.line("starts {}", study.tune()->starts);
  for (const DesignChoice& design : study.tune()->designs) {
    if (design.rule) text.line("rule {}", design.rule->expression.canonical_text(names));
  }
  // Limits in SI, or as the expression gives them: the column's unit is that of its record alone.
  for (const ColumnChoice& column : study.tune()->columns)
    text.line("column {} {} {} {}", column.name, column.value.expression.canonical_text(names),
              column.lower * column.si_factor, column.upper * column.si_factor);
  for (const ScenarioChoice& scenario : study.tune()->scenarios) text.line("named {}", scenario.name);
}

void add_records(const Study& study, CanonicalText& text) {
  const auto names = study.parameters.names();
  const auto add = [&](const char* what, const std::optional<StudyValue>& value) {
    if (value) text.line("{} {}", what, value->expression.canonical_text(names));
  };
  for (const RecordChoice& record : study.identify()->records) {
    text.line("record {} motion {}{}", record.name, static_cast<int>(record.motion),
              record.interpolation == transient::Interpolation::linear ? " linear" : "");
    for (const Assignment& at : record.set) text.line("set {} {}", names[at.parameter], at.value);
    add("added mass", record.added_mass);
    add("static displacement", record.static_displacement);
    for (const DataColumn& column : record.columns)
      text.line("column {} {}", column.role, fmt::join(column.values, " "));
    text.line("labels {}", fmt::join(record.labels, "\n"));
  }
}

// The properties that distinguish identifications of the same network: data, method and parameters.
void add_identification(const Study& study, CanonicalText& text) {
  if (!study.identify()) return;
  const IdentifyChoice& choice = *study.identify();
  const auto names = study.parameters.names();
  text.line("method {} start {} curve {} cycles {} offset {}", static_cast<int>(choice.method),
            static_cast<int>(choice.start), static_cast<int>(choice.curve), choice.cycles.value_or(0),
            choice.sensor_offset);
  const auto add = [&](const char* what, const std::optional<StudyValue>& value) {
    if (value) text.line("{} {}", what, value->expression.canonical_text(names));
  };
  add("mass", choice.mass);
  add("stiffness", choice.stiffness);
  add("reference frequency", choice.reference_frequency);
  for (const IdentifiedParameter& fitted : choice.parameters)
    text.line("fitted {} {} {} each record {} estimate {}", names[fitted.parameter], fitted.lower,
              fitted.upper, fitted.each_record, fitted.estimate);
  for (std::size_t i = 0; i < choice.fixed.size(); ++i)
    text.line("fixed {} {} {} degrees of freedom {}", names[choice.fixed[i].parameter], choice.fixed[i].value,
              fmt::join(choice.fixed_covariance[i], " "), choice.fixed[i].degrees_of_freedom);
  add_records(study, text);
}

// The points of a sweep depend on all frequencies of their row.
void add_swept_frequencies(const SweepChoice& sweep, const Parameters& parameters, CanonicalText& text) {
  if (!sweep.sweeps_frequency()) return;
  for (const std::size_t a : sweep.dimensions[*sweep.frequency_dimension].axes) {
    const ParameterAxis& axis = sweep.axes[a];
    text.line("swept {} {}", parameters.list[axis.parameter].name, fmt::join(axis.si_values, " "));
  }
}

std::string physics_hash(const Study& study, std::span<const std::string> quantities) {
  CanonicalText text;
  text.line("solver {}", solver_version);
  const auto words = study_key("output", "precision").words;  // in the order of Precision
  if (study.map())
    text.line("precision {}", words[static_cast<std::size_t>(study.map()->output.precision)].word);
  if (study.sweep() && study.sweep()->general_path) text.line("path general");
  const bool searches = study.sweep() ? mechanics::may_have_several_responses(study.network)
                                      : study.tune() && tuning::may_take_several_orbits(study.network);
  if (searches) {
    const periodic::OrbitsWanted wanted = study.orbits_wanted();
    text.line("orbits {} {} {}", wanted.starts, wanted.most_multiple, static_cast<int>(wanted.show));
    if (study.sweep()) add_swept_frequencies(*study.sweep(), study.parameters, text);
  }
  text.line("kind {}", kind_name(study.kind()));
  text.line("units {}", study.dimensionless ? "dimensionless" : "SI");
  add_parameters(study, text);
  add_network(study, text);
  add_motion(study, text);
  add_driving_records(study, text);
  add_tuning(study, text);
  add_identification(study, text);
  add_comparison(study, text);
  for (const std::string& quantity : quantities) text.line("quantity {}", quantity);
  return text.hash();
}

void add_axes(const Study& study, const MapChoice& map, CanonicalText& text) {
  const auto names = study.parameters.names();
  for (const GridDimension& dimension : map.dimensions) {
    text.line("dimension {} {}", dimension.name, dimension.size);
    if (dimension.axes.empty()) text.line("records {}", fmt::join(map.records->names, "\n"));
    for (const std::size_t a : dimension.axes) {
      const ParameterAxis& axis = map.axes[a];
      text.line("axis {} {}", study.parameters.list[axis.parameter].name, fmt::join(axis.si_values, " "));
    }
  }
  if (map.samples) text.line("samples {} {}", map.samples->dimension, fmt::join(map.samples->quantiles, " "));
  for (const KeptPoint& point : map.output.histories) {
    if (map.records) text.line("orbit under {}", point.record);
    for (const Assignment& at : point.at) text.line("orbit {} {}", names[at.parameter], at.value);
    text.line("orbit ends");
  }
  for (const DerivedCoordinate& coordinate : map.coordinates)
    text.line("coordinate {} {}", coordinate.name, coordinate.value.expression.canonical_text(names));
}

void add_sweep(const Study& study, const SweepChoice& sweep, CanonicalText& text) {
  if (sweep.borders) text.line("borders");
  if (const auto& branches = sweep.branches) {
    text.line("branches {}", study.parameters.list[sweep.axes[branches->axis].parameter].name);
    for (const auto& row : branches->at) {
      for (const Assignment& at : row)
        text.line("branches at {} {}", study.parameters.list[at.parameter].name, at.value);
      text.line("branches row ends");
    }
  }
  text.line("resonances {}", fmt::join(sweep.resonances, " "));
}

std::string grid_hash(const Study& study, Tiling tiling) {
  CanonicalText text;
  if (study.map()) add_axes(study, *study.map(), text);
  if (study.sweep()) add_sweep(study, *study.sweep(), text);
  if (const MotionChoice* motion = study.motion()) {
    text.line("samples {}", motion->samples);
    if (motion->duration)
      text.line("duration {}", motion->duration->expression.canonical_text(study.parameters.names()));
  }
  add_assessment(study, text);
  text.line("order {}", fmt::join(tiling.order, " "));
  text.line("tile {}", fmt::join(tiling.tile, " "));
  return text.hash();
}

}  // namespace

engine::Fingerprint fingerprint(const Study& study, Tiling tiling, std::span<const std::string> quantities) {
  return {.physics = physics_hash(study, quantities), .grid = grid_hash(study, tiling)};
}

engine::Fingerprint grown_fingerprint(const engine::Fingerprint& study, const std::string& identity) {
  CanonicalText text;
  text.line("grid {} grown from {}", study.grid, identity);
  return {.physics = study.physics, .grid = text.hash()};
}

engine::Fingerprint branch_fingerprint(const engine::Fingerprint& study, const std::string& course) {
  CanonicalText text;
  text.line("branch {}", course);
  return {.physics = study.physics, .grid = text.hash()};
}

std::string identity_of(std::span<const results::Text> provenance) {
  CanonicalText text;
  for (const auto& [name, value] : provenance) text.line("{} {} {}", name, value.size(), value);
  return text.hash();
}

}  // namespace frahm::studies
