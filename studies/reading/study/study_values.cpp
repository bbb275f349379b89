#include "studies/reading/study/study_values.hpp"

#include <algorithm>

namespace frahm::studies {
namespace {

// For an element with a table its value, and the bends of all characteristics.
template <class Number, class Part>
void fill_bends(const StudyValues& values, std::span<const Number> parameters, Part part,
                mechanics::NetworkValues& out) {
  out.bends.resize(values.characteristic.size());
  std::vector<Number> numbers;
  for (std::size_t e = 0; e < values.characteristic.size(); ++e) {
    const StudyCharacteristic& of = values.characteristic[e];
    out.bends[e].resize(of.sides.size());
    if (!of.bends()) continue;
    numbers.clear();
    for (const StudyValue& value : values.points_of(e))
      numbers.push_back(value.expression.evaluate(parameters));
    if (of.kind == StudyCharacteristic::Kind::stops) {
      for (std::size_t b = 0; b < of.sides.size(); ++b)
        out.bends[e][b] = {part(numbers[b]), out.element[e], out.second[e]};
      continue;
    }
    const TableOfForces<Number> table(numbers, of.sides);
    out.element[e] = part(table.slope(table.central()));
    for (std::size_t b = 0; b < of.sides.size(); ++b) {
      const double place = part(table.bend_place(b)), change = part(table.bend_change(b));
      out.bends[e][b] = of.of_velocity ? mechanics::BendValue{place, 0.0, change}
                                       : mechanics::BendValue{place, change, 0.0};
    }
  }
}

// The numbers of smooth laws.
template <class Number, class Part>
void fill_smooth(const StudyValues& values, std::span<const Number> parameters, Part part,
                 mechanics::NetworkValues& out) {
  const auto at = [&](const StudyValue& value) { return part(value.expression.evaluate(parameters)); };
  out.smooth.assign(values.elements[0].size(), {});
  for (std::size_t e = 0; e < out.smooth.size(); ++e) {
    for (std::size_t i = 0; i < mechanics::smooth_numbers.size(); ++i)
      out.smooth[e].*mechanics::smooth_numbers[i] =
          at(values.elements[mechanics::first_smooth_number + i][e]);
    if (values.characteristic[e].kind != StudyCharacteristic::Kind::curve) continue;
    const std::span<const StudyValue> points = values.points_of(e);
    for (std::size_t i = 0; i + 1 < points.size(); i += 2)
      out.smooth[e].curve.push_back({at(points[i]), at(points[i + 1])});
  }
}

// Applies `part` to each value (the value itself, or its derivative), in the layout of NetworkValues.
template <class Number, class Part>
void fill(const StudyValues& values, std::span<const Number> parameters, Part part,
          mechanics::NetworkValues& out) {
  const auto at = [&](const StudyValue& value) { return part(value.expression.evaluate(parameters)); };
  out.mass.resize(values.mass.size());
  out.element.resize(values.elements[0].size());
  out.second.resize(values.elements[1].size());
  out.damping.resize(values.damping.size());
  for (std::size_t i = 0; i < out.damping.size(); ++i) out.damping[i] = at(values.damping[i]);
  out.excitation.resize(values.amplitude.size());
  out.omega = at(values.omega);
  for (std::size_t i = 0; i < out.mass.size(); ++i) out.mass[i] = at(values.mass[i]);
  for (std::size_t e = 0; e < out.element.size(); ++e) {
    out.element[e] = at(values.value(e));
    out.second[e] = at(values.second(e));
  }
  for (std::size_t i = 0; i < out.excitation.size(); ++i) {
    out.excitation[i] = {at(values.amplitude[i]), at(values.phase[i]), at(values.rod[i])};
  }
  if (!values.points.empty()) fill_bends(values, parameters, part, out);
  if (values.has_smooth_laws()) fill_smooth(values, parameters, part, out);
}

}  // namespace

std::vector<const std::vector<StudyValue>*> StudyValues::lists_of_system() const {
  std::vector<const std::vector<StudyValue>*> lists{&mass, &damping, &points};
  for (const std::vector<StudyValue>& list : elements) lists.push_back(&list);
  return lists;
}

std::vector<const std::vector<StudyValue>*> StudyValues::lists() const {
  std::vector<const std::vector<StudyValue>*> lists = lists_of_system();
  lists.insert(lists.end(), {&amplitude, &phase, &rod});
  return lists;
}

bool StudyValues::has_smooth_laws() const {
  const auto is_curve = [](const StudyCharacteristic& of) {
    return of.kind == StudyCharacteristic::Kind::curve;
  };
  const auto is_given = [](const auto& list) { return std::ranges::any_of(list, &StudyValue::is_given); };
  return std::ranges::any_of(std::span(elements).subspan(mechanics::first_smooth_number), is_given) ||
         std::ranges::any_of(characteristic, is_curve);
}

std::vector<std::size_t> StudyValues::read_by_system(const mechanics::Network& network) const {
  std::vector<std::size_t> reads;
  const auto add = [&](const StudyValue& value) {
    reads.insert(reads.end(), value.expression.reads().begin(), value.expression.reads().end());
  };
  for (const auto* list : lists_of_system()) std::ranges::for_each(*list, add);
  if (mechanics::frequency_dependent_element(network) != nullptr) add(omega);
  return reads;
}

std::vector<std::size_t> StudyValues::read_by_factors() const {
  std::vector<std::size_t> reads;
  for (const auto* directions : {&along, &signals}) {
    for (const StudyDirection& direction : *directions) {
      for (const StudyValue& factor : direction.factors)
        reads.insert(reads.end(), factor.expression.reads().begin(), factor.expression.reads().end());
    }
  }
  return reads;
}

void evaluate(const StudyValues& values, const Parameters& definitions, std::span<double> parameters,
              mechanics::NetworkValues& out) {
  definitions.complete(parameters);
  fill(
      values, std::span<const double>(parameters), [](double value) { return value; }, out);
}

void differentiate(const StudyValues& values, const Parameters& definitions,
                   std::span<const double> parameters, std::size_t by, mechanics::NetworkValues& out) {
  std::vector<Dual> duals(parameters.size());
  for (std::size_t i = 0; i < duals.size(); ++i) duals[i] = {parameters[i], i == by ? 1.0 : 0.0};
  definitions.complete(std::span<Dual>(duals));
  fill(
      values, std::span<const Dual>(duals), [](const Dual& value) { return value.derivative; }, out);
}

}  // namespace frahm::studies
