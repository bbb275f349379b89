#pragma once

#include <span>
#include <vector>

#include "solvers/mechanics/modes.hpp"
#include "solvers/quantities/energy_screen.hpp"
#include "solvers/quantities/extremes.hpp"
#include "solvers/quantities/orbit_measurement.hpp"
#include "solvers/quantities/quantity_values.hpp"
#include "solvers/quantities/request.hpp"

// Computes the requested quantities of an exact orbit, and no others.
namespace frahm::periodic {

template <int N, int H>
class Observables {
 public:
  // `assembly` and `flow` must outlive the observables.
  Observables(const mechanics::Assembly& assembly, const Flow<N, H>& flow,
              const std::vector<Quantity>& quantities)
      : flow_(flow),
        forms_(assembly, flow),
        steps_(flow),
        measurement_(assembly, flow),
        screen_(assembly, flow),
        request_(values_of(quantities, assembly)) {}

  bool needs_stability() const { return request_.needs.stability; }

  // Frequencies and damping of the linear modes, when the matrices have changed.
  void set_system(const mechanics::LinearSystem& system) {
    if (request_.needs.modes) modes_of(system, measured_.natural_frequency, measured_.modal_damping);
  }

  // Whether the work put in in a period is dissipated in it. evaluate() uses the same measurements.
  bool is_balanced(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system);
  // For the orbit that was not balanced.
  double energy_balance() const { return value::energy_balance(measured_, {}); }

  // The next call measures another orbit.
  void forget() { is_measured_ = is_laid_out_ = false; }

  // out[i] is quantity i.
  void evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system, std::span<double> out);
  // For a point without a response; unsettled: starts of the search that came to none.
  void fill_missing(Status status, int unsettled, std::span<double> out) const {
    tell_missing(request_, status, unsettled, out);
  }

 private:
  void measure(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system, const Needs& needs) {
    if (!is_laid_out_) steps_.lay_out(orbit);
    measurement_.measure(orbit, system, steps_, needs, measured_);
  }

  const Flow<N, H>& flow_;
  Forms<N, H> forms_;
  OrbitSteps<N, H> steps_;
  TracedOrbit<N, H> traced_;
  OrbitMeasurement<N, H> measurement_;
  EnergyScreen<N, H> screen_;
  Request request_;
  Measured measured_;
  bool is_measured_ = false, is_laid_out_ = false;
};

// Energies that are asked for are measured once; otherwise the screen tells nearly all.
template <int N, int H>
bool Observables<N, H>::is_balanced(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system) {
  steps_.lay_out(orbit);
  is_laid_out_ = true;
  is_measured_ = false;
  if (!request_.needs.energies && screen_.is_balanced(orbit, system, steps_)) return true;
  Needs needs = request_.needs;
  needs |= {.integrals = true, .energies = true, .input = true};
  measure(orbit, system, needs);
  is_measured_ = true;
  return value::is_balanced(measured_);
}

template <int N, int H>
void Observables<N, H>::evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                                 std::span<double> out) {
  if (!is_measured_) measure(orbit, system, request_.needs);
  measured_.traces = &request_.traces;
  measured_.extremes.resize(request_.traces.size());
  for (std::size_t i = 0; i < request_.traces.size(); ++i) {
    traced_.look(steps_, flow_, [this, i](const Mode<N, H>& mode) {
      return form_of(request_.traces[i], forms_, *measured_.system, mode);
    });
    const Extremes found = traced_.extremes(orbit.section);
    measured_.extremes[i] = orbit.half_period ? mirrored(found) : found;
  }
  tell_values(request_, measured_, out);
}

extern template class Observables<1, 1>;
extern template class Observables<2, 1>;
extern template class Observables<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
