#include "studies/reading/map/grid_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/mechanics/crank.hpp"
#include "studies/reading/map/corners.hpp"
#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/study/study_units.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/direction_reading.hpp"
#include "studies/reading/system/element_problem.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_points_tried = 100'000;  // for one value: some milliseconds

// Something to check: a value of the network, a derived coordinate, a derived parameter, or the values of an
// element next to each other.
struct Checked {
  const StudyValue* value = nullptr;     // or
  const Parameter* parameter = nullptr;  // with its index
  std::vector<std::size_t> reads;        // parameters
  std::string_view origin{};             // who sets them
  std::optional<std::size_t> element{};  // whose values
};

// The parameters that the values of an element read which are checked together.
std::vector<std::size_t> reads_of_element(const StudyValues& values, std::size_t e) {
  std::vector<std::size_t> reads;
  const auto add = [&](const StudyValue& value) {
    reads.insert(reads.end(), value.expression.reads().begin(), value.expression.reads().end());
  };
  add(values.value(e));
  add(values.second(e));
  for (const StudyValue& value : values.points_of(e)) add(value);
  return reads;
}

std::vector<Checked> all_checked(const Study& study) {
  std::vector<Checked> all;
  for (const std::size_t i : study.parameters.derived)
    all.push_back({nullptr, &study.parameters.list[i], {i}});
  const auto add = [&](const StudyValue& value) {
    all.push_back({&value, nullptr, value.expression.reads()});
  };
  const StudyValues& values = study.values;
  add(values.omega);
  for (const auto* list : values.lists()) {
    for (const StudyValue& value : *list) add(value);
  }
  for (const StudyValue* value : study.values_of_its_kind()) add(*value);
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    const StudyCharacteristic::Kind kind = values.characteristic[e].kind;
    const bool has_table =
        kind == StudyCharacteristic::Kind::table || kind == StudyCharacteristic::Kind::curve;
    if (has_table || study.network.elements[e].has_static_force)
      all.push_back({.reads = reads_of_element(values, e), .element = e});
  }
  return all;
}

bool depends_on_samples(const Study& study, std::span<const std::size_t> reads) {
  const auto moving = dimensions_moving(study, reads);
  return std::ranges::find(moving, study.map()->samples->dimension) != moving.end();
}

// The number of the sample, from 0, whose parameters these are; nothing if they are of none.
std::optional<std::size_t> sample_at(const Study& study, std::span<const double> parameters) {
  if (!study.map() || !study.map()->samples) return std::nullopt;
  const std::vector<ParameterAxis>& axes = study.map()->axes;
  const SampleChoice& samples = *study.map()->samples;
  for (std::size_t i = 0; i < study.map()->dimensions[samples.dimension].size; ++i) {
    if (std::ranges::all_of(samples.axes, [&](std::size_t a) {
          return axes[a].si_values[i] == parameters[axes[a].parameter];
        }))
      return i;
  }
  return std::nullopt;
}

// " at omega = 400 rpm, I = 6.36 kg": the numbers on which it depends.
std::string place_name(const Study& study, const Checked& checked, std::span<const double> parameters) {
  std::string text;
  for (const std::size_t i : study.parameters.inputs_of(checked.reads)) {
    text += fmt::format("{} {} = {}", text.empty() ? " at" : ",", study.parameters.list[i].name,
                        spoken_text(study, i, parameters[i]));
  }
  if (const auto sample = sample_at(study, parameters); sample && depends_on_samples(study, checked.reads))
    text += fmt::format(", sample {}", *sample);
  if (!checked.origin.empty()) text += fmt::format(" ({})", checked.origin);
  return text;
}

[[noreturn]] void fail(Rule rule, const Study& study, const Checked& checked,
                       std::span<const double> parameters, const std::string& problem,
                       const std::string& must) {
  const Position position = checked.value ? checked.value->position : checked.parameter->position;
  const std::string where =
      checked.value ? checked.value->where : fmt::format("parameter \"{}\"", checked.parameter->name);
  const std::string place = place_name(study, checked, parameters);
  const auto is_it = [&](const StudyValue& each) { return &each == checked.value; };
  const bool is_of_table = std::ranges::any_of(study.values.points, is_it);
  throw study.source.error_at(place.empty() && !is_of_table ? rule : rules::beyond_schema(rule), position,
                              "{}: {}{}; {}", where, problem, place, must);
}

void check_derived(const Study& study, const Checked& checked, std::span<const double> parameters) {
  const double value = parameters[checked.reads.front()];
  if (std::isfinite(value)) return;
  if (const auto* table = std::get_if<TableOf>(&checked.parameter->definition)) {
    const auto written = [&](double si) { return spoken_text(study, table->of, si); };
    fail(rules::beyond_schema(rules::out_of_range), study, checked, parameters,
         fmt::format("the table \"{}\" has no value", table->file),
         fmt::format("it covers {} from {} to {}, here {}", study.parameters.list[table->of].name,
                     written(table->table.x.front()), written(table->table.x.back()),
                     written(parameters[table->of])));
  }
  fail(rules::beyond_schema(rules::out_of_range), study, checked, parameters, "has no value",
       "must be a finite number");
}

void check_value(const Study& study, const Checked& checked, std::span<const double> parameters) {
  const double value = checked.value->expression.evaluate(parameters);
  const bool pure = study.dimensionless || checked.value->quantity == Quantity::number;
  const auto is = [&] {
    return fmt::format("is {:.6g}{}{}", value, pure ? "" : " ",
                       pure ? "" : written_si_unit(checked.value->quantity));
  };
  if (!std::isfinite(value))
    fail(rules::beyond_schema(rules::out_of_range), study, checked, parameters, "has no value",
         "must be a finite number");
  if (checked.value->range == Range::not_negative && value < 0.0) {
    fail(rules::out_of_range, study, checked, parameters, is(), "must be >= 0");
  }
  if (checked.value->range != Range::positive || value > 0.0) return;
  // The only one is sweep_rate.
  const bool is_rate = checked.value->quantity == Quantity::angular_acceleration;
  fail(rules::out_of_range, study, checked, parameters, is(),
       is_rate ? "must be > 0; the direction follows from sweep_to" : "must be > 0");
}

void check_element(const Study& study, Checked checked, std::span<const double> parameters) {
  const auto problem = element_problem(study, *checked.element, parameters);
  if (!problem) return;
  checked.value = problem->value;
  fail(problem->rule, study, checked, parameters, problem->found, problem->must);
}

void check(const Study& study, const Checked& checked, std::span<double> parameters) {
  study.parameters.complete(parameters);
  if (checked.element) {
    check_element(study, checked, parameters);
  } else if (checked.value) {
    check_value(study, checked, parameters);
  } else {
    check_derived(study, checked, parameters);
  }
}

// Walks over the product of the dimensions along which `reads` change, all points, or of those that are too
// many only the corners: of samples, which have none, every one.
// visit(): at each point, with `parameters` set there but not completed.
template <class Visit>
void walk(const Study& study, std::span<const std::size_t> reads, std::vector<double>& parameters,
          const Visit& visit) {
  const auto moving = dimensions_moving(study, reads);
  std::size_t points = 1;
  for (const std::size_t d : moving) {
    if (points <= most_points_tried) points *= study.map()->dimensions[d].size;
  }
  const bool corners = points > most_points_tried;
  std::vector<std::size_t> index(moving.size(), 0);
  std::size_t turned = 0;
  do {
    for (std::size_t i = 0; i < moving.size(); ++i) set_along(*study.map(), moving[i], index[i], parameters);
    visit();
    // The next index, like the digits of a counter.
    for (turned = 0; turned < moving.size(); ++turned) {
      const auto& samples = study.map()->samples;
      const bool jumps = corners && !(samples && samples->dimension == moving[turned]);
      const std::size_t last = study.map()->dimensions[moving[turned]].size - 1;
      if (index[turned] < last) {
        index[turned] = jumps ? last : index[turned] + 1;
        break;
      }
      index[turned] = 0;
    }
  } while (turned < moving.size());
}

// The parameters (SI) of the points whose histories a map records.
std::vector<std::vector<double>> kept_points(const Study& study) {
  std::vector<std::vector<double>> points;
  if (!study.map()) return points;
  for (const KeptPoint& point : study.map()->output.histories) {
    points.push_back(study.parameters.nominal());
    for (const Assignment& assignment : point.at) points.back()[assignment.parameter] = assignment.value;
  }
  return points;
}

// The parameters that an excitation's crank and rod read.
std::vector<std::size_t> reads_of_crank(const Study& study, std::size_t excitation) {
  std::vector<std::size_t> reads = study.values.amplitude[excitation].expression.reads();
  const auto& of_rod = study.values.rod[excitation].expression.reads();
  reads.insert(reads.end(), of_rod.begin(), of_rod.end());
  return reads;
}

// crank/rod of an excitation at a point (SI values of all parameters, completed).
double crank_ratio(const Study& study, std::size_t excitation, std::span<const double> parameters) {
  const StudyValue &crank = study.values.amplitude[excitation], &rod = study.values.rod[excitation];
  const double ratio = crank.expression.evaluate(parameters) / rod.expression.evaluate(parameters);
  if (ratio <= mechanics::kLargestCrankRatio) return ratio;
  fail(rules::beyond_schema(rules::out_of_range), study, {&crank, nullptr, reads_of_crank(study, excitation)},
       parameters, fmt::format("is {:.6g} times the rod", ratio),
       fmt::format("must be at most {} times the rod; otherwise its Fourier series is too long",
                   mechanics::kLargestCrankRatio));
}

bool is_crank(const Study& study, std::size_t excitation) {
  return study.network.excitations[excitation].kind == mechanics::ExcitationKind::crank;
}

// The largest crank/rod of an excitation on the grid and at the points whose histories are recorded.
double largest_crank_ratio(const Study& study, std::size_t excitation) {
  std::vector<double> parameters = study.parameters.nominal();
  double largest = 0.0;
  const auto visit = [&] {
    study.parameters.complete(std::span<double>(parameters));
    largest = std::max(largest, crank_ratio(study, excitation, parameters));
  };
  walk(study, reads_of_crank(study, excitation), parameters, visit);
  for (const std::vector<double>& point : kept_points(study)) {
    parameters = point;
    visit();
  }
  return largest;
}

void keep_orders(mechanics::Excitation& crank, double ratio) {
  // A bound of zero needs no even orders.
  if (crank.taylor_order == 0 && ratio > 0.0) crank.even_orders = mechanics::crank_orders_needed(ratio);
}

}  // namespace

void set_crank_orders(Study& study) {
  for (std::size_t i = 0; i < study.network.excitations.size(); ++i) {
    if (is_crank(study, i)) keep_orders(study.network.excitations[i], largest_crank_ratio(study, i));
  }
}

void add_crank_orders_at(Study& study, std::span<const double> parameters) {
  for (std::size_t i = 0; i < study.network.excitations.size(); ++i) {
    if (!is_crank(study, i)) continue;
    mechanics::Excitation& crank = study.network.excitations[i];
    const int before = crank.even_orders;
    keep_orders(crank, crank_ratio(study, i, parameters));
    crank.even_orders = std::max(crank.even_orders, before);
  }
}

void set_crank_orders_at(Study& study, std::span<double> parameters) {
  study.parameters.complete(parameters);
  for (std::size_t i = 0; i < study.network.excitations.size(); ++i) {
    if (is_crank(study, i)) keep_orders(study.network.excitations[i], crank_ratio(study, i, parameters));
  }
}

void check_point(const Study& study, std::span<double> parameters, std::string_view origin) {
  for (Checked& checked : all_checked(study)) {
    checked.origin = origin;
    check(study, checked, parameters);
  }
  for (const auto* directions : {&study.values.along, &study.values.signals}) {
    for (const StudyDirection& along : *directions) check_direction_at(study, along, parameters, origin);
  }
}

void check_grid(const Study& study) {
  const std::vector<double> nominal = study.parameters.nominal();
  for (const Checked& checked : all_checked(study)) {
    std::vector<double> parameters = nominal;
    walk(study, checked.reads, parameters, [&] { check(study, checked, parameters); });
  }
  for (std::vector<double> parameters : kept_points(study))
    check_point(study, parameters, study.sweep() ? "[output]: orbits" : "[output]: histories");
}

}  // namespace frahm::studies
