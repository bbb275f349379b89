#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <span>
#include <vector>

#include "solvers/quantities/contact_history.hpp"
#include "solvers/quantities/extremes.hpp"
#include "solvers/quantities/fundamental_response.hpp"
#include "solvers/quantities/integrals.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/quantities/quantity.hpp"
#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/quantities/trace.hpp"

// From an orbit to the quantities asked for, and to no others.
namespace frahm::periodic {

template <int N, int H>
class Observables {
 public:
  using S = Sizes<N, H>;
  using Form = LinearForm<N, H>;

  // `assembly` and `flow` must outlive the observables.
  Observables(const mechanics::Assembly& assembly, const Flow<N, H>& flow, std::vector<Quantity> quantities);

  bool needs_stability() const { return needs_stability_; }
  std::size_t size() const { return quantities_.size(); }

  // Frequencies and damping of the linear modes, when the matrices have changed.
  void set_system(const mechanics::LinearSystem& system);

  // out[i] is quantity i.
  void evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system, std::span<double> out);
  // For a point without a response.
  void fill_missing(Status status, std::span<double> out) const;

 private:
  void plan(const Quantity& quantity);
  void integrate(const Orbit<N, H>& orbit);
  void balance_energy();
  std::complex<double> reference_component(const Form& form) const;
  double phase_of(const Form& form, double magnitude) const;
  double harmonic_of(std::size_t mass) const {
    return std::abs(reference_component(forms_.displacement(mass_incidences_[mass])));
  }
  ContactHistory history_of(std::size_t contact) const;
  double element_energy(std::size_t element) const;
  double value_of(std::size_t place) const;
  double value_of_mass(std::size_t place) const;
  double value_of_element(std::size_t place) const;
  double value_of_point(const Quantity& quantity) const;

  const mechanics::Assembly& assembly_;
  const Flow<N, H>& flow_;
  Forms<N, H> forms_;
  std::vector<mechanics::Incidence> mass_incidences_;  // the displacement of each mass by itself
  std::vector<Quantity> quantities_;
  std::vector<std::size_t> trace_index_;  // of each quantity
  std::vector<Trace> traces_;
  std::vector<Extremes> extremes_;  // of each trace
  bool needs_integrals_ = false, needs_histories_ = false, needs_stability_ = false, needs_modes_ = false;
  std::vector<double> natural_frequency_, modal_damping_;

  // Of the orbit in hand.
  OrbitSteps<N, H> steps_;
  Integrals<N, H> integrals_;
  std::vector<ContactHistory> histories_;
  const Orbit<N, H>* orbit_ = nullptr;
  const mechanics::LinearSystem* system_ = nullptr;
  double dissipated_ = 0.0;
};

}  // namespace frahm::periodic

#include "solvers/quantities/observables.ipp"
