#include "studies/reading/system/element_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/system/unfit_elements.hpp"

namespace frahm::studies {
namespace {

using Problem = std::optional<ElementProblem>;

constexpr double rounding = 1e-12;  // of the largest force of a table

std::string with_unit(const Study& study, const StudyValue& value, double number) {
  const bool pure = study.dimensionless || value.quantity == Quantity::number;
  return fmt::format("{:.6g}{}{}", number, pure ? "" : " ", pure ? "" : written_si_unit(value.quantity));
}

Problem problem_of_static_force(const Study& study, std::size_t e, std::span<const double> parameters) {
  const StudyValue &sliding = study.values.value(e), &at_rest = study.values.second(e);
  const double F = sliding.expression.evaluate(parameters), F_s = at_rest.expression.evaluate(parameters);
  if (!(F > 0.0))
    return ElementProblem{rules::beyond_schema(rules::out_of_range), &sliding,
                          fmt::format("is {}", with_unit(study, sliding, F)),
                          "must be > 0 if there is a static_force"};
  if (!(F_s < F)) return {};
  return ElementProblem{rules::beyond_schema(rules::out_of_range), &at_rest,
                        fmt::format("is {}, below the force of {} while it slides",
                                    with_unit(study, at_rest, F_s), with_unit(study, sliding, F)),
                        "must be at least as large"};
}

// Its points rise, and each stays on its side of the origin.
Problem problem_of_places(const Study& study, std::span<const StudyValue> values,
                          const TableOfForces<double>& table, std::span<const double> sides) {
  for (std::size_t i = 1; i < table.points(); ++i) {
    if (table.place(i) > table.place(i - 1)) continue;
    const StudyValue& value = values[2 * i];
    return ElementProblem{rules::wrong_order, &value,
                          fmt::format("is {} after {}", with_unit(study, value, table.place(i)),
                                      with_unit(study, value, table.place(i - 1))),
                          "the points of a table must rise"};
  }
  for (std::size_t b = 0; b < sides.size(); ++b) {
    if ((table.place(b + 1) > 0.0) == (sides[b] > 0.0)) continue;
    const StudyValue& value = values[2 * (b + 1)];
    return ElementProblem{rules::wrong_dependence, &value,
                          fmt::format("is {}, on the other side of 0 than elsewhere in the study",
                                      with_unit(study, value, table.place(b + 1))),
                          "a point of a table must stay on its side"};
  }
  return {};
}

// The slopes of a damper's table: at rest it must not drive, and where there must be one response the force
// must not fall.
Problem problem_of_damping(const Study& study, const StudyValue& value, const TableOfForces<double>& table) {
  const std::size_t i = table.central();
  double at_rest = table.slope(i);
  if (i > 0 && table.place(i) == 0.0) at_rest = std::min(at_rest, table.slope(i - 1));  // on either side
  if (at_rest < 0.0)
    return ElementProblem{rules::beyond_schema(rules::out_of_range), &value,
                          fmt::format("falls at velocity 0, by {:.6g} a unit", -at_rest),
                          "at rest a damper must not drive the motion"};
  const std::string one = needs_one_response(study);
  if (one.empty()) return {};
  for (std::size_t piece = 0; piece + 1 < table.points(); ++piece) {
    if (table.slope(piece) < 0.0)
      return ElementProblem{rules::several_responses, &value,
                            fmt::format("falls between its points {} and {}", piece + 1, piece + 2),
                            fmt::format("then several responses may exist, but {} needs a single one", one)};
  }
  return {};
}

Problem problem_of_table(const Study& study, std::size_t e, std::span<const double> parameters) {
  const StudyCharacteristic& of = study.values.characteristic[e];
  const std::span<const StudyValue> values = study.values.points_of(e);
  std::vector<double> numbers;
  for (const StudyValue& value : values) numbers.push_back(value.expression.evaluate(parameters));
  const TableOfForces<double> table(numbers, of.sides);
  if (Problem problem = problem_of_places(study, values, table, of.sides)) return problem;
  double largest = 0.0;
  for (std::size_t i = 0; i < table.points(); ++i) largest = std::max(largest, std::abs(table.force(i)));
  const StudyValue& value = study.values.value(e);
  if (const double N = table.force_at_origin(); std::abs(N) > rounding * largest)
    return ElementProblem{rules::beyond_schema(rules::out_of_range), &value,
                          fmt::format("gives the force {} at 0", with_unit(study, values[1], N)),
                          of.of_velocity ? "a damper at rest has no force: add the point [0, 0] to the table"
                                         : "it must pass through [0, 0]; subtract a preload from every "
                                           "force, and apply it as an [[excitation.force]] of order 0"};
  return of.of_velocity ? problem_of_damping(study, value, table) : Problem{};
}

// A curve of friction starts at the origin, its speeds rise, and where there must be one response its forces
// do not fall.
Problem problem_of_curve(const Study& study, std::size_t e, std::span<const double> parameters) {
  const std::span<const StudyValue> values = study.values.points_of(e);
  const auto number = [&](std::size_t i) { return values[i].expression.evaluate(parameters); };
  for (std::size_t i = 0; i < 2; ++i) {
    if (number(i) != 0.0)
      return ElementProblem{rules::beyond_schema(rules::out_of_range), &values[i],
                            fmt::format("is {}", with_unit(study, values[i], number(i))),
                            "must be 0: a curve of friction starts at [0, 0], and is odd"};
  }
  for (std::size_t i = 2; i < values.size(); i += 2) {
    if (number(i) > number(i - 2)) continue;
    return ElementProblem{rules::wrong_order, &values[i],
                          fmt::format("is {} after {}", with_unit(study, values[i], number(i)),
                                      with_unit(study, values[i], number(i - 2))),
                          "the points of a table must rise"};
  }
  const std::string one = needs_one_response(study);
  for (std::size_t i = 3; !one.empty() && i < values.size(); i += 2) {
    if (number(i) < number(i - 2))
      return ElementProblem{
          rules::several_responses, &values[i],
          fmt::format("is {} after {}", with_unit(study, values[i], number(i)),
                      with_unit(study, values[i], number(i - 2))),
          fmt::format("where friction falls several responses may exist, but {} needs a single one", one)};
  }
  return {};
}

}  // namespace

std::optional<ElementProblem> element_problem(const Study& study, std::size_t e,
                                              std::span<const double> parameters) {
  if (study.network.elements[e].has_static_force) return problem_of_static_force(study, e, parameters);
  if (study.values.characteristic[e].kind == StudyCharacteristic::Kind::table)
    return problem_of_table(study, e, parameters);
  if (study.values.characteristic[e].kind == StudyCharacteristic::Kind::curve)
    return problem_of_curve(study, e, parameters);
  return {};
}

}  // namespace frahm::studies
