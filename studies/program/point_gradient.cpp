#include "studies/program/point_gradient.hpp"

#include <algorithm>

namespace frahm::studies {
namespace {

// The number parameters that masses, elements, excitation and frequency depend on, ascending; not those of
// factors, which are part of the topology.
std::vector<std::size_t> inputs_of_network(const Study& study) {
  std::vector<std::size_t> reads = study.values.omega.expression.reads();
  for (const std::vector<StudyValue>* list : study.values.lists()) {
    for (const StudyValue& value : *list) {
      const auto& own = value.expression.reads();
      reads.insert(reads.end(), own.begin(), own.end());
    }
  }
  std::sort(reads.begin(), reads.end());
  reads.erase(std::unique(reads.begin(), reads.end()), reads.end());
  std::vector<std::size_t> inputs = study.parameters.inputs_of(reads);
  const auto of_factors = study.parameters.inputs_of(study.values.read_by_factors());
  std::erase_if(inputs, [&](std::size_t i) { return std::ranges::binary_search(of_factors, i); });
  return inputs;
}

mechanics::NetworkValues values_at(const Study& study, std::vector<double> parameters) {
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

periodic::CheckedParameter by_parameter(const Study& study, const std::vector<double>& parameters,
                                        std::size_t parameter) {
  periodic::CheckedParameter checked{.value = parameters[parameter], .direction = {}};
  differentiate(study.values, study.parameters, parameters, parameter, checked.direction);
  checked.values_at = [&study, parameters, parameter](double value) {
    std::vector<double> changed = parameters;
    changed[parameter] = value;
    return values_at(study, std::move(changed));
  };
  return checked;
}

periodic::CheckedParameter by_frequency(const mechanics::NetworkValues& values) {
  periodic::CheckedParameter checked{.value = values.omega, .direction = {}};
  checked.direction.omega = 1.0;
  checked.direction.mass.resize(values.mass.size());
  checked.direction.element.resize(values.element.size());
  checked.direction.second.resize(values.second.size());
  checked.direction.damping.resize(values.damping.size());
  checked.direction.excitation.resize(values.excitation.size());
  checked.values_at = [values](double omega) {
    mechanics::NetworkValues changed = values;
    changed.omega = omega;
    return changed;
  };
  return checked;
}

std::string unit_of(const Study& study, const Parameter& parameter) {
  if (study.dimensionless || !parameter.quantity) return "1";
  return std::string(si_unit(*parameter.quantity));
}

}  // namespace

PointGradient gradient_at(const Study& study, std::span<const double> parameters, periodic::CheckedBy by) {
  const std::vector<double> at(parameters.begin(), parameters.end());
  const mechanics::NetworkValues values = values_at(study, at);
  PointGradient result;
  std::vector<periodic::Quantity> quantities;
  for (const periodic::Quantity& quantity : periodic::all_quantities(study.network)) {
    if (!periodic::is_differentiable(quantity.measure)) continue;
    quantities.push_back(quantity);
    result.quantities.push_back(periodic::describe(quantity, study.network, study.dimensionless));
  }
  std::vector<periodic::CheckedParameter> checked;
  for (const std::size_t i : inputs_of_network(study)) {
    const Parameter& parameter = study.parameters.list[i];
    checked.push_back(by_parameter(study, at, i));
    result.by.push_back({parameter.name, unit_of(study, parameter), {}});
  }
  if (study.values.omega.expression.is_constant()) {
    checked.push_back(by_frequency(values));
    result.by.push_back({"excitation.frequency", study.dimensionless ? "1" : "rad s-1", {}});
  }
  periodic::GradientCheck check = periodic::check_gradient(study.network, quantities, values, checked, by);
  result.reason = check.reason;
  if (!result.reason.empty()) result.by.clear();
  for (std::size_t i = 0; i < result.by.size(); ++i) result.by[i].derivatives = std::move(check.columns[i]);
  return result;
}

}  // namespace frahm::studies
