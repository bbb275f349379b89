#include "studies/tuning/tuning_task.hpp"

#include <limits>
#include <utility>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/tuning/stages/design_map.hpp"
#include "studies/tuning/tuned_design.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t nothing = std::numeric_limits<std::size_t>::max();  // is no parameter

std::vector<tuning::DesignParameter> design_parameters(const Study& study) {
  const std::vector<double> nominal = study.parameters.nominal();
  std::vector<tuning::DesignParameter> parameters;
  for (const DesignChoice& design : study.tune()->designs) {
    tuning::DesignParameter parameter{.name = study.parameters.list[design.parameter].name,
                                      .lower = design.lower,
                                      .upper = design.upper,
                                      .nominal = nominal[design.parameter],
                                      .schedule = std::nullopt};
    if (design.is_scheduled())
      parameter.schedule = tuning::Schedule{.knots = design.knots,
                                            .max_slope = design.max_slope,
                                            .may_leap = design.may_leap,
                                            .leap = std::nullopt};
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

// The network's values and their derivatives by each design parameter and the band's.
tuning::NetworkAt network_at(const Study& study) {
  const TuneChoice& tune = *study.tune();
  std::vector<std::size_t> places;  // indices of the entries of `at` among the parameters
  for (const DesignChoice& design : tune.designs) places.push_back(design.parameter);
  places.push_back(tune.band ? tune.band->parameter : nothing);
  std::vector<std::vector<double>> scenarios;
  for (std::size_t s = 0; s < scenario_names(study).size(); ++s)
    scenarios.push_back(parameters_in_scenario(study, s));
  return [&study, places = std::move(places), scenarios = std::move(scenarios)](
             std::size_t scenario, std::span<const double> at, mechanics::NetworkValues& values,
             std::vector<mechanics::NetworkValues>* derivatives) {
    std::vector<double> parameters = scenarios[scenario];
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] != nothing) parameters[places[i]] = at[i];
    }
    evaluate(study.values, study.parameters, parameters, values);
    if (!derivatives) return;
    derivatives->resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      differentiate(study.values, study.parameters, parameters, places[i], (*derivatives)[i]);
  };
}

// A weight does not depend on what scenarios set.
std::function<tuning::Weight(double)> weight_of(const Study& study) {
  if (!study.tune()->weight) return {};
  return [&study, parameters = study.parameters.nominal()](double band) {
    const std::size_t place = study.tune()->band->parameter;
    std::vector<Dual> duals;
    for (const double parameter : parameters) duals.push_back({parameter, 0.0});
    duals[place] = {band, 1.0};
    study.parameters.complete(std::span<Dual>(duals));
    const Dual weight = study.tune()->weight->expression.evaluate(std::span<const Dual>(duals));
    return tuning::Weight{weight.value, weight.derivative};
  };
}

// The mass or signal whose peak is tuned; a stroke becomes a signal's.
std::size_t tuned_coordinate(const transient::MotionQuantity& quantity, mechanics::Network& network) {
  if (quantity.measure != transient::MotionMeasure::stroke) return quantity.index;
  const mechanics::Element& element = network.elements[quantity.index];
  network.signals.push_back({element.name, element.along, element.rotational});
  return mechanics::coordinate_count(network) - 1;  // signals are the last
}

// A dummy single frequency if a variance has no band.
tuning::Band band_of(const Study& study) {
  if (study.tune()->band) return study.tune()->band->range;
  const std::vector<double> nominal = study.parameters.nominal();
  const double omega = study.values.omega.expression.evaluate(std::span<const double>(nominal));
  return {omega, omega};
}

}  // namespace

tuning::RecordTask record_task(const Study& study) {
  const TuneChoice& tune = *study.tune();
  tuning::RecordTask task;
  task.network = study.network;
  task.network_at = network_at(study);
  task.scenarios = scenario_names(study);
  task.parameters = design_parameters(study);
  for (std::size_t r = 0; r < tune.peaks->records.size(); ++r)
    task.records.push_back(driven_by(tune.peaks->driving, r));
  task.duration = tune.peaks->duration;
  task.coordinate = tuned_coordinate(tune.peaks->quantity, task.network);
  task.goal = tune.peaks->goal;
  task.solver = tune.solver;
  task.tolerance = tune.tolerance;
  return task;
}

tuning::Task tuning_task(const Study& study) {
  const TuneChoice& tune = *study.tune();
  tuning::Task task;
  task.network = study.network;
  task.network_at = network_at(study);
  task.scenarios = scenario_names(study);
  task.parameters = design_parameters(study);
  task.band = band_of(study);
  task.objective = tune.objective;
  task.quantity = tune.quantity;
  task.weight = weight_of(study);
  for (const LimitChoice& limit : tune.limits)
    task.limits.push_back({limit.name, limit.quantity, limit.lower, limit.upper, limit.band});
  if (tune.trade_off)
    task.trade_off = tuning::TradeOff{tune.trade_off->name, tune.trade_off->quantity, tune.trade_off->limits};
  task.noise = tune.noise;
  task.orbits = tune.orbits;
  task.dominate_constant = tune.dominate_constant;
  task.solver = tune.solver;
  task.global_solver = tune.global_solver;
  task.start = tune.start;
  task.starts = tune.starts;
  task.tolerance = tune.tolerance;
  if (!tune.start_is_given && tuning::may_be_mapped(task)) task.start = tuning::Start::map;
  return task;
}

}  // namespace frahm::studies
