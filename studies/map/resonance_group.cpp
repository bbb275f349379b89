#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "solvers/response/resonance_peak.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/provenance/assembly_stage.hpp"
#include "studies/provenance/result_variables.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {
namespace {

constexpr double rounding = 1e-12;      // a smaller part of the motion counts as zero
constexpr double least_motion = 1e-30;  // [m, or without dimension] rounding leaves a stuck mass 1e-47

// Response curves of some masses and signals along the frequency axis, the other parameters fixed: amplitudes
// at the reference order over the axis's parameter.
class ResponseCurves {
 public:
  ResponseCurves(const Study& study, std::size_t parameter)
      : study_(study), parameter_(parameter), response_(study.network, harmonics(study)) {}

  void begin(std::vector<double> parameters) {
    parameters_ = std::move(parameters);
    known_.clear();
    response_.forget();
  }

  // NaN where the point has no response.
  double amplitude(std::size_t curve, double at) {
    const auto [known, is_new] = known_.try_emplace(at);
    if (is_new) known->second = solve(at);
    return known->second[curve];
  }

  double angular_frequency(double at) {
    set(at);
    return values_.omega;
  }

 private:
  // For each mass the amplitude sought and the size of its motion.
  static std::vector<periodic::Quantity> harmonics(const Study& study) {
    std::vector<periodic::Quantity> quantities;
    for (const std::size_t mass : study.sweep()->resonances) {
      quantities.push_back({periodic::Measure::harmonic, mass});
      quantities.push_back({periodic::Measure::peak, mass});
    }
    return quantities;
  }

  void set(double at) {
    parameters_[parameter_] = at;
    evaluate(study_.values, study_.parameters, parameters_, values_);
  }

  std::vector<double> solve(double at) {
    std::vector<double> amplitudes(study_.sweep()->resonances.size(), kNone);
    set(at);
    try {
      response_.set_values(values_);
    } catch (const mechanics::MechanicsError&) {
      return amplitudes;  // in the map such a point fails with its reason
    }
    if (response_.solve().status == periodic::Status::unbounded) {
      std::fill(amplitudes.begin(), amplitudes.end(), kInfinity);
      return amplitudes;
    }
    std::vector<double> found(2 * amplitudes.size());
    response_.quantities(found);
    for (std::size_t i = 0; i < amplitudes.size(); ++i) {
      const double amplitude = found[2 * i], motion = found[2 * i + 1];
      amplitudes[i] = amplitude <= rounding * motion || motion < least_motion ? 0.0 : amplitude;
    }
    return amplitudes;
  }

  const Study& study_;
  std::size_t parameter_;
  periodic::PeriodicResponse response_;
  std::vector<double> parameters_;
  mechanics::NetworkValues values_;
  std::map<double, std::vector<double>> known_;  // by the value of the parameter
};

// The coordinates of the rows, and the resonance of each mass.
std::vector<results::Variable> row_variables(const Study& study, std::size_t frequency_dimension) {
  std::vector<results::Variable> variables;
  const auto add = [&](const Named& named, const std::string& unit) {
    variables.push_back(variable(named, study.dimensionless ? "1" : unit));
  };
  for (std::size_t d = 0; d < study.map()->dimensions.size(); ++d) {
    if (d == frequency_dimension) continue;
    for (const std::size_t a : study.map()->dimensions[d].axes) {
      const ParameterAxis& axis = study.map()->axes[a];
      variables.push_back(parameter_variable(study, axis.parameter, study.dimensionless ? "1" : axis.unit));
    }
  }
  const std::string of_frequency = frequency_unit_in_file(study).text;
  for (const std::size_t mass : study.sweep()->resonances) {
    const std::string& name = mechanics::coordinate_name(study.network, mass);
    add({"*_resonance_frequency", name}, of_frequency);
    add({"*_resonance_amplitude", name}, std::string(mechanics::coordinate_unit(study.network, mass, "m")));
    add({"*_half_power_low", name}, of_frequency);
    add({"*_half_power_high", name}, of_frequency);
    add({"*_half_power_damping", name}, "1");
  }
  return variables;
}

// The index of a curve along each dimension, 0 along the frequency; the last dimension runs fastest.
std::vector<std::size_t> index_of(const Study& study, std::size_t frequency_dimension, std::uint64_t curve) {
  std::vector<std::size_t> index(study.map()->dimensions.size(), 0);
  for (std::size_t d = index.size(); d-- > 0;) {
    if (d == frequency_dimension) continue;
    index[d] = curve % study.map()->dimensions[d].size;
    curve /= study.map()->dimensions[d].size;
  }
  return index;
}

// The row of one curve; `curves` is the workspace.
std::vector<double> solve_row(const Study& study, std::size_t frequency_dimension, std::uint64_t number,
                              ResponseCurves& curves) {
  const ParameterAxis& axis = study.map()->axes[study.map()->dimensions[frequency_dimension].axes.front()];
  const std::vector<std::size_t> index = index_of(study, frequency_dimension, number);
  std::vector<double> parameters = study.parameters.nominal(), row;
  for (std::size_t d = 0; d < index.size(); ++d) {
    if (d == frequency_dimension) continue;
    set_along(*study.sweep(), d, index[d], parameters);
    for (const std::size_t a : study.map()->dimensions[d].axes)
      row.push_back(study.map()->axes[a].values[index[d]]);
  }
  curves.begin(std::move(parameters));
  const double unit = frequency_unit_in_file(study).si_factor;
  for (std::size_t curve = 0; curve < study.sweep()->resonances.size(); ++curve) {
    const auto peak =
        periodic::find_resonance_peak([&](double at) { return curves.amplitude(curve, at); }, axis.si_values);
    const double resonance = curves.angular_frequency(peak.at) / unit;
    double low = curves.angular_frequency(peak.half_power_low) / unit,
           high = curves.angular_frequency(peak.half_power_high) / unit;
    if (low > high) std::swap(low, high);
    row.insert(row.end(), {resonance, peak.value, low, high, (high - low) / (2.0 * resonance)});
  }
  return row;
}

}  // namespace

void write_resonances(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer) {
  const Study& study = plan.study;
  if (study.sweep()->resonances.empty()) return;
  const std::size_t along = *study.sweep()->frequency_dimension;
  const std::size_t parameter = study.map()->axes[study.map()->dimensions[along].axes.front()].parameter;
  const std::uint64_t frequencies = study.map()->dimensions[along].size;
  const std::size_t table = writer.create_ragged(
      {.group = "resonance", .row = "curve", .row_variables = row_variables(study, along)});
  const auto make_work = [&]() -> engine::PieceWork {
    // Shared, as a PieceWork has to be copyable.
    auto curves = std::make_shared<ResponseCurves>(study, parameter);
    return [curves, &study, &writer, along, table](std::uint64_t number) {
      return [row = solve_row(study, along, number, *curves), &writer, table] {
        writer.append_ragged(table, row);
      };
    };
  };
  carry_out({.name = "resonances",
             .pieces = plan.grid.points() / frequencies,
             .points = plan.grid.points(),
             .points_of = [frequencies](std::uint64_t) { return frequencies; },
             .make_work = make_work},
            options);
}

}  // namespace frahm::studies
