#pragma once

#include <complex>
#include <limits>
#include <span>
#include <vector>

#include "solvers/mechanics/system_derivative.hpp"
#include "solvers/quantities/contact_history.hpp"
#include "solvers/quantities/fundamental_response.hpp"
#include "solvers/quantities/integrals.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/quantities/trace_derivative.hpp"

// From an orbit to the exact derivatives of the quantities asked for.
namespace frahm::periodic {

template <int N, int H>
class Gradient {
 public:
  using S = Sizes<N, H>;
  using Form = LinearForm<N, H>;

  // `assembly` and `flow` must outlive the gradient.
  Gradient(const mechanics::Assembly& assembly, const Flow<N, H>& flow, std::vector<Quantity> quantities);

  // values: of which the system was made.  directions, out: as in PeriodicResponse::gradient. Returns "" or
  // why there is none, and then leaves `out` to NaN.
  const char* evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                       const mechanics::NetworkValues& values,
                       std::span<const mechanics::NetworkValues> directions, std::span<double> out);
  const char* why_none(std::size_t quantity) const { return why_none_[quantity]; }

 private:
  using Gram = typename Integrals<N, H>::Gram;

  const char* differentiate_all(std::span<const mechanics::NetworkValues> directions, std::span<double> out);
  const char* differentiate(const mechanics::NetworkValues& direction, std::span<double> out);
  void integrate();

  double derivative_of(std::size_t quantity);
  double derivative_of_element(std::size_t quantity);
  double derivative_of_point(std::size_t quantity);
  double none(std::size_t quantity, const char* reason);

  double at_candidate(std::size_t trace, const Candidate<N, H>& candidate) const;
  double extreme(std::size_t quantity, Side side);
  double peak_phase(std::size_t quantity);
  double candidate_phase(std::size_t trace, const Candidate<N, H>& candidate) const;

  double product(const Form& f, const Form& f_by, const Form& g) const;
  Form displacement_derivative(const mechanics::Incidence& at) const;
  Form velocity_derivative(const mechanics::Incidence& at, const Form& velocity) const;
  struct Component {
    std::complex<double> value, by;
  };
  Component reference_component(const mechanics::Incidence& at) const;
  bool has_component(std::size_t quantity, std::complex<double> component) const;
  double phase(std::size_t quantity, const mechanics::Incidence& at);
  double harmonic_ratio(std::size_t quantity);
  double force_transmissibility_by(std::size_t quantity);
  double root_mean_square(std::size_t quantity);
  struct Loss {
    double value = 0.0, by = 0.0;  // [J]
  };
  Loss element_loss(std::size_t element) const;
  Loss sliding_distance(std::size_t contact) const;  // [m]
  Loss all_losses() const;
  double stuck_fraction(std::size_t contact) const;

  const mechanics::Assembly& assembly_;
  const Flow<N, H>& flow_;
  Forms<N, H> forms_;
  std::vector<Quantity> quantities_;
  std::vector<std::size_t> trace_index_;  // of each quantity that has a trace
  std::vector<Trace> traces_;
  bool needs_integrals_ = false, needs_modes_ = false;
  std::vector<const char*> why_none_;  // of each quantity

  // Of the orbit in hand.
  const Orbit<N, H>* orbit_ = nullptr;
  const mechanics::LinearSystem* system_ = nullptr;
  const mechanics::NetworkValues* values_ = nullptr;
  OrbitSteps<N, H> steps_;
  OrbitSensitivity<N, H> sensitivity_;
  Integrals<N, H> integrals_;
  std::vector<std::vector<Candidate<N, H>>> candidates_;  // of each trace
  std::vector<Extremes> extremes_;                        // of each trace, over the passage

  // Of the direction in hand.
  mechanics::LinearSystem system_by_;
  StepDerivative<N, H> by_;
  Gram gram_by_;
  std::vector<double> natural_frequency_by_, modal_damping_by_;
};

}  // namespace frahm::periodic

#include "solvers/quantities/gradient.ipp"
#include "solvers/quantities/gradient_integrals.ipp"
