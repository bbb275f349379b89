#include <fmt/format.h>

#include <complex>
#include <optional>

#include "studies/program/point_command.hpp"
#include "studies/program/point_report.hpp"
#include "studies/python/binding.hpp"
#include "studies/python/response_rows.hpp"
#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/assignment.hpp"
#include "studies/reading/study/study_units.hpp"

// Periodic responses in memory: of one point in full, and of rows of points.
namespace frahm::python {
namespace {

using studies::PointGradient;
using studies::PointReport;
using studies::Study;

py::object value_of(const PointReport::QuantityValue& quantity) {
  const auto& [description, value] = quantity;
  switch (description.kind) {
    case periodic::QuantityKind::flag:
      return py::str(studies::flag_meaning(description, value));
    case periodic::QuantityKind::count:
      return studies::has_value(quantity) ? py::object(py::int_(static_cast<int>(value))) : py::none();
    case periodic::QuantityKind::real:
      break;
  }
  return py::float_(value);
}

py::list quantity_values(const PointReport& report) {
  py::list list;
  for (const PointReport::QuantityValue& quantity : report.quantities) {
    const auto& described = quantity.description;
    list.append(py::make_tuple(described.name, value_of(quantity), described.unit, described.long_name));
  }
  return list;
}

py::list stretches_of(const PointReport& report) {
  py::list list;
  for (const periodic::Stretch& stretch : report.stretches) {
    py::dict contacts;
    for (std::size_t i = 0; i < report.friction_elements.size(); ++i)
      contacts[py::str(report.friction_elements[i])] = stretch.contacts[i];
    list.append(py::make_tuple(stretch.start, stretch.length, contacts));
  }
  return list;
}

py::object history_of(const PointReport& report) {
  if (!report.history) return py::none();
  py::dict columns, units;
  columns["time"] = array_of<double>(report.history->time);
  for (std::size_t i = 0; i < report.history->names.size(); ++i) {
    columns[py::str(report.history->names[i])] = array_of<double>(report.history->columns[i]);
    units[py::str(report.history->names[i])] = report.history->units[i];
  }
  return py::make_tuple(columns, units);
}

// The unit in which a bare number of a parameter is read [SI per it].
double factor_of(const Study& study, const std::string& name) {
  const auto index = study.parameters.find(name);
  return index ? studies::usual_unit(study, *index).si_factor : 1.0;
}

// Exact derivatives: of each quantity, by each parameter in its usual unit; and why one has none.
py::tuple gradient_of(const Study& study, const PointGradient& gradient) {
  py::dict derivatives, why_none;
  for (std::size_t q = 0; q < gradient.quantities.size(); ++q) {
    py::dict by;
    for (const PointGradient::By& parameter : gradient.by) {
      const periodic::DerivativeCheck& check = parameter.derivatives[q];
      by[py::str(parameter.parameter)] = check.exact * factor_of(study, parameter.parameter);
      if (!check.why_none.empty()) why_none[py::str(gradient.quantities[q].name)] = check.why_none;
    }
    derivatives[py::str(gradient.quantities[q].name)] = by;
  }
  return py::make_tuple(derivatives, why_none, gradient.reason);
}

py::dict parameter_values(const PointReport& report) {
  py::dict parameters;
  for (const auto& [name, spoken] : report.parameters)
    parameters[py::str(name)] = py::make_tuple(spoken.value, spoken.unit);
  return parameters;
}

py::list found_numbers(const std::vector<studies::FoundResponse::Number>& numbers) {
  py::list list;
  for (const auto& each : numbers) list.append(py::make_tuple(each.name, each.value, each.unit));
  return list;
}

py::object responses_of(const PointReport& report) {
  if (!report.responses) return py::none();
  py::list list;
  for (const studies::FoundResponse& each : *report.responses) {
    py::list multipliers;
    for (const std::complex<double>& value : each.multipliers)
      multipliers.append(
          py::reinterpret_steal<py::object>(PyComplex_FromDoubles(value.real(), value.imag())));
    list.append(py::make_tuple(each.is_shown, each.period_multiple,
                               each.mirror_of ? py::object(py::int_(*each.mirror_of)) : py::none(),
                               found_numbers(each.peaks), multipliers, found_numbers(each.state)));
  }
  return list;
}

struct FoundPoint {
  PointReport report;
  std::optional<PointGradient> gradient;
};

// at: name=value each.  samples: of the history, both ends of the period included; 0: none.
FoundPoint found_point(const Study& study, std::vector<double> parameters, const std::string& path,
                       std::size_t samples, bool gradient, bool responses) {
  FoundPoint found{
      studies::tell_point(study, parameters, studies::path_of(study, path), samples, false, responses), {}};
  if (!gradient) return found;
  const bool has_values = found.report.status != "failed" && found.report.status != "not_computed";
  study.parameters.complete<double>(parameters);
  found.gradient = has_values ? studies::gradient_at(study, parameters, periodic::CheckedBy::nothing)
                              : PointGradient{"there is no response", {}, {}};
  return found;
}

py::dict point(const LoadedStudy& loaded, const std::vector<std::string>& at, const std::string& path,
               std::size_t samples, bool gradient, bool responses) {
  Study study = loaded.study;
  studies::require_responses(study);
  std::vector<double> parameters = studies::parameters_at(study, at, "point()");
  studies::set_crank_orders_at(study, parameters);
  const FoundPoint found = [&] {
    const py::gil_scoped_release free;
    return found_point(study, std::move(parameters), path, samples, gradient, responses);
  }();
  const PointReport& report = found.report;
  py::dict result;
  result["status"] = report.status;
  result["reason"] = report.reason;
  result["residual"] = report.residual;
  result["why_no_error_bound"] = report.why_no_bound;
  result["continuum"] = report.continuum;
  result["responses"] = responses_of(report);
  result["newton_iterations"] = report.newton_iterations;
  result["found_by"] = studies::way_name(report.way);
  result["parameters"] = parameter_values(report);
  result["quantities"] = quantity_values(report);
  result["stretches"] = stretches_of(report);
  result["history"] = history_of(report);
  result["gradient"] = found.gradient ? py::object(gradient_of(study, *found.gradient)) : py::none();
  return result;
}

// Axes as Python gives them: a name, and values in the parameter's usual unit.
using GivenAxes = std::vector<std::pair<std::string, std::vector<double>>>;

studies::RowGrid grid_of(const Study& study, const std::vector<std::string>& at, const GivenAxes& axes) {
  studies::RowGrid grid{studies::parameters_at(study, at, "response()"), {}};
  for (const auto& [name, values] : axes) {
    if (values.empty()) throw studies::StudyError(studies::rules::empty, "{}: no values are given", name);
    const std::string first = fmt::format("{}={:.17g}", name, values.front());
    const studies::Assignment begin = studies::parse_assignments(study, "response()", first).front();
    studies::RowAxis& axis = grid.axes.emplace_back(studies::RowAxis{begin.parameter, {}});
    const double factor = studies::usual_unit(study, begin.parameter).si_factor;
    for (const double value : values) axis.si_values.push_back(value * factor);
  }
  return grid;
}

// A text with a unit ("10 Hz") in the unit in which a bare number of the parameter is read.
double in_usual_unit(const LoadedStudy& loaded, const std::string& name, const std::string& text) {
  const std::string assignment = fmt::format("{}={}", name, text);
  const studies::Assignment value =
      studies::parse_assignments(loaded.study, "response()", assignment).front();
  return value.value / studies::usual_unit(loaded.study, value.parameter).si_factor;
}

py::object array_of_variable(const periodic::QuantityDescription& variable,
                             const std::vector<double>& values) {
  if (variable.kind == periodic::QuantityKind::real) return array_of<double>(values);
  return array_of<std::int32_t>(values);
}

bool interrupted() {
  const py::gil_scoped_acquire held;
  return PyErr_CheckSignals() != 0;
}

// The variables: name, values in row-major order, unit, meaning, names of a flag's values. Then the units of
// the axes, and the reasons of points without a response by their index.
py::tuple rows(const LoadedStudy& loaded, const std::vector<std::string>& at, const GivenAxes& axes,
               const std::vector<std::string>& names, int threads) {
  Study study = loaded.study;
  studies::require_responses(study);
  studies::RowGrid grid = grid_of(study, at, axes);
  studies::set_crank_orders_at(study, grid.parameters);
  const auto quantities = studies::quantities_called(study, names);
  py::list units;
  for (const studies::RowAxis& axis : grid.axes)
    units.append(studies::spoken_value(study, axis.parameter, 0.0).unit);
  const studies::RowResponses found = [&] {
    const py::gil_scoped_release free;
    return studies::solve_rows(study, quantities, std::move(grid), threads, interrupted);
  }();
  if (PyErr_Occurred()) throw py::error_already_set();
  py::list variables;
  for (std::size_t q = 0; q < found.variables.size(); ++q) {
    const periodic::QuantityDescription& variable = found.variables[q];
    variables.append(py::make_tuple(variable.name, array_of_variable(variable, found.values[q]),
                                    variable.unit, variable.long_name, variable.flags));
  }
  py::dict reasons;
  for (std::size_t i = 0; i < found.reasons.size(); ++i)
    if (!found.reasons[i].empty()) reasons[py::int_(i)] = found.reasons[i];
  return py::make_tuple(variables, units, reasons);
}

}  // namespace

void add_responses(py::class_<LoadedStudy>& study) {
  study
      .def("point", point, py::arg("at"), py::arg("path"), py::arg("samples"), py::arg("gradient"),
           py::arg("responses"))
      .def("in_usual_unit", in_usual_unit, py::arg("name"), py::arg("text"))
      .def("rows", rows, py::arg("at"), py::arg("axes"), py::arg("names"), py::arg("threads"));
}

}  // namespace frahm::python
