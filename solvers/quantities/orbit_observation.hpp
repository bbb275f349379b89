#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "solvers/mechanics/system_derivative.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/quantities/orbit_sensitivity.hpp"
#include "solvers/quantities/step_samples.hpp"

namespace frahm::periodic {

// A periodic orbit as sensors show it at any times, with its exact derivatives.
template <int N, int H>
class OrbitObservation {
 public:
  // `flow` and what `observed` refers to must outlive it.
  OrbitObservation(const Flow<N, H>& flow, std::span<const Observed> observed)
      : flow_(flow), steps_(flow), sensitivity_(flow), observed_(observed), samples_(observed) {}

  // times: [s], 0 where the excitation's phase is.  directions: derivatives of `values`, of which `system`
  // was made; none: values only.  Returns "" or why there are no derivatives, and then `out` has none.
  const char* observe(const Orbit<N, H>& orbit, const mechanics::Assembly& assembly,
                      const mechanics::LinearSystem& system, const mechanics::NetworkValues& values,
                      std::span<const mechanics::NetworkValues> directions, std::span<const double> times,
                      ObservedMotion& out) {
    lay_out(orbit);
    place(orbit, system.omega, times);
    const auto rows = static_cast<Eigen::Index>(times.size());
    const auto columns = static_cast<Eigen::Index>(observed_.size());
    out.values.resize(rows, columns);
    out.by.clear();
    for_each_sample([](std::size_t) {},
                    [&](const Sample& sample, const Polynomial& power) {
                      samples_.values(power, sample.sign, out.values.row(sample.row));
                    });
    if (directions.empty()) return "";
    const char* reason = why_no_orbit_derivative(orbit);
    if (*reason == '\0') reason = sensitivity_.prepare(orbit, steps_);
    for (std::size_t d = 0; d < directions.size() && *reason == '\0'; ++d) {
      mechanics::differentiate(assembly, values, directions[d], system, system_by_);
      by_.set(flow_.equations(), system, system_by_);
      reason = sensitivity_.differentiate(by_);
      out.by.emplace_back(rows, columns);
      if (*reason == '\0') fill(out.by.back());
    }
    if (*reason != '\0') out.by.clear();
    return reason;
  }

 private:
  struct Sample {
    std::size_t step = 0;
    Eigen::Index row = 0;
    double fraction = 0.0;  // of the step
    double sign = 1.0;      // of the orbit there
    double time = 0.0;      // [steps]
  };

  void lay_out(const Orbit<N, H>& orbit) {
    steps_.lay_out(orbit);
    for (PassageStep<N, H>& step : steps_.steps()) steps_.expand(step);
  }

  // Locates each time on the orbit, step by step.
  void place(const Orbit<N, H>& orbit, double omega, std::span<const double> times) {
    const double rate = flow_.fundamental_rate();
    const auto steps = steps_.steps();
    places_.clear();
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto [from_section, sign] = place_on_orbit(omega * times[i], orbit.section, orbit.half_period);
      const double at = from_section / rate;
      const auto after = [](double value, const PassageStep<N, H>& step) { return value < step.start; };
      const auto next = std::upper_bound(steps.begin() + 1, steps.end(), at, after);
      const auto step = static_cast<std::size_t>(next - steps.begin()) - 1;
      places_.push_back({step, static_cast<Eigen::Index>(i),
                         std::clamp(at - steps[step].start, 0.0, steps[step].length), sign,
                         omega * times[i] / rate});
    }
    std::stable_sort(places_.begin(), places_.end(),
                     [](const Sample& a, const Sample& b) { return a.step < b.step; });
  }

  // take(sample, powers of its fraction); a step is entered, enter(step), before its first sample.
  template <class Enter, class Take>
  void for_each_sample(const Enter& enter, const Take& take) {
    std::size_t in_hand = steps_.steps().size();
    for (const Sample& sample : places_) {
      if (sample.step != in_hand) {
        samples_.set_step(flow_, steps_.steps()[sample.step]);
        enter(sample.step);
      }
      in_hand = sample.step;
      take(sample, powers(sample.fraction));
    }
  }

  // Derivatives along the current direction.
  void fill(Eigen::MatrixXd& rows) {
    for_each_sample([&](std::size_t step) { samples_.set_direction(flow_, sensitivity_.passage(), step); },
                    [&](const Sample& sample, const Polynomial& power) {
                      samples_.derivatives(power, sample.time, sample.sign, rows.row(sample.row));
                    });
  }

  const Flow<N, H>& flow_;
  OrbitSteps<N, H> steps_;
  OrbitSensitivity<N, H> sensitivity_;
  std::span<const Observed> observed_;
  StepSamples<N, H> samples_;
  std::vector<Sample> places_;
  mechanics::LinearSystem system_by_;
  StepDerivative<N, H> by_;
};

}  // namespace frahm::periodic
