#include "studies/program/point_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "solvers/orbits/orbit.hpp"
#include "studies/map/comparison.hpp"
#include "studies/map/row_solver.hpp"
#include "studies/map/way_of_slow_sweep.hpp"

namespace frahm::studies {
namespace {

using periodic::QuantityKind;

std::vector<PointReport::Parameter> numbers_of(const Study& study, const std::vector<double>& parameters) {
  std::vector<PointReport::Parameter> numbers;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = study.parameters.list[i];
    if (parameter.is_number()) numbers.push_back({parameter.name, spoken_value(study, i, parameters[i])});
  }
  return numbers;
}

std::vector<std::string> friction_elements(const mechanics::Network& network) {
  std::vector<std::string> names;
  for (const mechanics::Element& element : network.elements) {
    if (mechanics::has_own_contact(element)) names.push_back(element.name);
  }
  return names;
}

periodic::PeriodicResponse response_of(const Study& study, const std::vector<periodic::Quantity>& quantities,
                                       periodic::Path path) {
  try {
    return {study.network, quantities, path, study.orbits_wanted()};
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

// Each quantity with its value at a point that could not be set up.
void describe_all(const Study& study, const std::vector<periodic::Quantity>& quantities,
                  PointReport& report) {
  for (const periodic::Quantity& quantity : quantities) {
    report.quantities.push_back({periodic::describe(quantity, study.network, study.dimensionless),
                                 periodic::missing_value(quantity.measure, periodic::Status::failed)});
  }
}

// The values of the points on the way to a point, that point last (way_of_slow_sweep).
std::vector<mechanics::NetworkValues> values_on_way(const Study& study, std::span<const double> parameters) {
  std::vector<mechanics::NetworkValues> way;
  for (std::vector<double>& point : way_of_slow_sweep(study, study.orbits_wanted(), parameters))
    evaluate(study.values, study.parameters, point, way.emplace_back());
  return way;
}

// Sliders that never slip may have other offsets, with other motions.
std::string continuum_text(std::span<const PointReport::QuantityValue> quantities,
                           std::span<const double> values, bool half_period) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (quantities[i].description.name != "continuum" || !(values[i] > 0.0)) continue;
    return fmt::format(
        "{:.0f} slider{} of jenkins or iwan elements never slip{} and may have other offsets; the motion "
        "shown is the one {}",
        values[i], values[i] > 1.0 ? "s" : "", values[i] > 1.0 ? "" : "s",
        half_period ? "with z(T/2) = -z(0)" : "of least energy");
  }
  return "";
}

// False where the values of the last point cannot be set; the report has the reason.
bool solve(periodic::PeriodicResponse& response, std::span<const mechanics::NetworkValues> way,
           PointReport& report) {
  const std::size_t quantities = report.quantities.size();
  std::vector<periodic::ResponseSummary> summaries(way.size());
  std::vector<double> row(way.size() * quantities);
  response.solve_row(way, summaries, row);
  const periodic::ResponseSummary& summary = summaries.back();
  const auto found = std::span(row).last(quantities);
  report.reason = summary.reason;
  if (summary.status == periodic::Status::not_computed) {
    report.residual = kNone;
    return false;
  }
  report.way = summary.way;
  report.residual = summary.residual;
  report.newton_iterations = summary.newton_iterations;
  report.passages = summary.passages;
  report.continuum = continuum_text(report.quantities, found, summary.half_period);
  for (std::size_t i = 0; i < found.size(); ++i) report.quantities[i].value = found[i];
  return true;
}

// An orbit of its own, for the motion.
periodic::ResponseSummary solve_alone(periodic::PeriodicResponse& response,
                                      std::span<const mechanics::NetworkValues> way) {
  response.forget();
  periodic::ResponseSummary summary;
  for (const mechanics::NetworkValues& values : way) {
    summary = {};
    try {
      response.set_values(values);
      summary = response.solve();
    } catch (const mechanics::MechanicsError&) {
      continue;
    }
  }
  return summary;
}

void add_motion(periodic::PeriodicResponse& response, std::size_t history_samples, PointReport& report) {
  report.stretches = response.stretches();
  if (history_samples > 0) report.history = response.history(periodic::phases_of_a_period(history_samples));
}

// Adds the study's comparison at the point. parameters: complete.
void add_comparison(const Study& study, std::span<const double> parameters,
                    const std::vector<periodic::Quantity>& quantities, PointReport& report) {
  if (!study.sweep() || !study.sweep()->comparison) return;
  const auto value_of = [&](const periodic::Quantity& quantity) {
    const auto place = std::find(quantities.begin(), quantities.end(), quantity) - quantities.begin();
    return report.quantities[static_cast<std::size_t>(place)].value;
  };
  std::vector<double> own, sizes;
  for (const periodic::Quantity& compared : study.sweep()->comparison->quantities) {
    own.push_back(value_of(compared));
    const auto size = size_of_compared(compared);
    sizes.push_back(size ? value_of(*size) : 0.0);
  }
  RowSolver other(study, compared_network(study), compared_values(study), compared_quantities(study),
                  compared_orbits(study));
  std::vector<std::vector<double>> way = way_of_slow_sweep(study, compared_orbits(study), parameters);
  other.begin_row();
  for (std::vector<double>& point : way) other.add_point(point);
  other.solve();
  const std::vector<periodic::QuantityDescription> variables = compared_variables(study);
  std::vector<double> values(variables.size());
  const std::string& reason = other.reason(way.size() - 1);
  compare(own, sizes, other.quantities(way.size() - 1), values);
  for (std::size_t i = 0; i < values.size(); ++i) report.quantities.push_back({variables[i], values[i]});
  if (report.reason.empty() && !reason.empty()) report.reason = fmt::format("compared: {}", reason);
}

std::string status_of(const PointReport& report) {
  for (const auto& [description, value] : report.quantities) {
    if (description.name == "status") return flag_meaning(description, value);
  }
  return "";
}

bool is_found(const PointReport& report) {
  return report.status == "ok" || report.status == "grazing" || report.status == "several";
}

double value_of(const PointReport& report, const char* name) {
  for (const auto& [description, value] : report.quantities) {
    if (description.name == name) return value;
  }
  return kNone;
}

// Why the certificate (orbits/certificate.hpp) bounds no error here; "" where it does.
std::string why_no_bound(const mechanics::Network& network, const PointReport& report) {
  constexpr double undamped = 1.0 - 1e-9;  // the largest multiplier: below, rounding does not make it
  if (!is_found(report) || !std::isnan(value_of(report, "error_bound"))) return "";
  if (mechanics::has_smooth_law(network)) return "a smooth law is integrated within tolerances";
  if (value_of(report, "floquet_radius") >= undamped) return "nothing damps the motion, so no error fades";
  if (mechanics::may_have_several_responses(network)) return "a law is not monotone, so errors may grow";
  return "an event nearly happens: within rounding the orbit may have other events";
}

}  // namespace

PointReport tell_point(const Study& study, std::vector<double> parameters, periodic::Path path,
                       std::size_t history_samples, bool gradient, bool responses) {
  PointReport report;
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  report.parameters = numbers_of(study, parameters);
  report.friction_elements = friction_elements(study.network);
  const std::vector<periodic::Quantity> quantities = periodic::all_quantities(study.network);
  describe_all(study, quantities, report);

  periodic::PeriodicResponse response = response_of(study, quantities, path);
  const std::vector<mechanics::NetworkValues> way = values_on_way(study, parameters);
  const bool is_set = solve(response, way, report);
  report.status = status_of(report);
  if (!is_set) {  // as in a map, such a point has failed
    if (gradient) report.gradient = PointGradient{"there is no response", {}, {}};
    return report;
  }
  report.modes = modes_at_point(study, values);
  add_comparison(study, parameters, quantities, report);
  report.why_no_bound = why_no_bound(study.network, report);
  if (responses) report.responses.emplace();
  if (is_found(report)) {
    const periodic::ResponseSummary summary = solve_alone(response, way);
    if (periodic::has_response(summary.status)) {
      add_motion(response, history_samples, report);
      if (responses) report.responses = found_responses(study, quantities, response, summary.coexisting);
    }
  }
  if (gradient) report.gradient = gradient_at(study, parameters);
  return report;
}

const char* way_name(periodic::Way way) {
  return way == periodic::Way::event_phases ? "event phases" : "shooting";
}

std::string flag_meaning(const periodic::QuantityDescription& description, double value) {
  for (const auto& [meaning, number] : description.flags) {
    if (number == value) return meaning;
  }
  return "";
}

bool has_value(const PointReport::QuantityValue& quantity) {
  return quantity.description.kind == QuantityKind::flag ||
         !periodic::is_missing(quantity.description.kind, quantity.value);
}

}  // namespace frahm::studies
