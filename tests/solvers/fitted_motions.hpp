#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "solvers/identification/grey_box.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Simulated measurements and what is fitted to them, for tests.
namespace frahm::identification {

// A number of the model, by name.
struct Place {
  std::string name;
  std::function<double&(Model&)> of;
};

inline Place element(std::string name, std::size_t index) {
  return {std::move(name), [index](Model& m) -> double& { return m.values.element[index]; }};
}
inline Place initial_displacement(std::size_t mass) {
  return {"x0", [mass](Model& m) -> double& { return m.initial.displacement[mass]; }};
}
inline Place initial_velocity(std::size_t mass) {
  return {"v0", [mass](Model& m) -> double& { return m.initial.velocity[mass]; }};
}

// The places take the numbers that are fitted, then those that are fixed; the rest is as in `model`, or as in
// models[record].
inline ModelAt model_with(std::vector<Model> models, const std::vector<Place>& places) {
  return [models, places](std::size_t record, std::span<const double> at, Model& model,
                          std::vector<Model>* derivatives) {
    const Model& base = models[models.size() == 1 ? 0 : record];
    model = base;
    for (std::size_t i = 0; i < places.size(); ++i) places[i].of(model) = at[i];
    if (derivatives == nullptr) return;
    const std::vector<double> none(base.values.mass.size(), 0.0);
    derivatives->assign(places.size(), {periodic::zero_direction(base.values), {none, none}});
    for (std::size_t i = 0; i < places.size(); ++i) places[i].of((*derivatives)[i]) = 1.0;
  };
}

// Displacements of all masses as sensors would give them, of a free decay or of a motion forced from phase 0.
inline TimeRecord displacements(const std::string& name, MotionKind motion, const mechanics::Network& network,
                                const Model& model, double duration, int samples) {
  transient::Samples history;
  if (motion == MotionKind::free) {
    mechanics::Network unexcited = network;
    mechanics::NetworkValues values = model.values;
    unexcited.excitations.clear();
    values.excitation.clear();
    history =
        transient::free_decay(unexcited, values, model.initial, {.duration = duration, .samples = samples})
            .history;
  } else {
    history = transient::forced_motion(network, [&](double) { return model.values; }, model.initial,
                                       {.from = model.values.omega, .duration = duration, .samples = samples})
                  .history;
  }
  TimeRecord record{name, motion, history.time, {}, {}};
  for (std::size_t i = 0; i < network.masses.size(); ++i)
    record.channels.push_back(
        {network.masses[i] + "_displacement", i, Signal::displacement, history.displacement[i]});
  return record;
}

// Adds normal noise of standard deviation sigma.
inline void add_noise(TimeRecord& record, double sigma, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, sigma);
  for (Channel& channel : record.channels) {
    for (double& value : channel.values) value += noise(random);
  }
}

// The places' numbers in `truth` as parameters without bounds, started off by the given factors.
inline std::vector<FittedParameter> started_off(Model truth, const std::vector<Place>& places,
                                                const std::vector<double>& factors) {
  std::vector<FittedParameter> parameters;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < factors.size(); ++i)
    parameters.push_back(
        {places[i].name, "1", factors[i] * places[i].of(truth), -kInfinity, kInfinity, false});
  return parameters;
}

// Fits what is at the places to records made with `truth`, from starts off by `factors`.
inline Identification fit(const mechanics::Network& network, const Model& truth,
                          const std::vector<Place>& places, const std::vector<double>& factors,
                          std::vector<TimeRecord> records) {
  GreyBoxTask task{.network = network,
                   .model_at = model_with({truth}, places),
                   .parameters = started_off(truth, places, factors),
                   .records = std::move(records)};
  return grey_box(task);
}

}  // namespace frahm::identification
