#pragma once

#include <complex>
#include <span>
#include <vector>

#include "solvers/quantities/extreme_values.hpp"
#include "solvers/quantities/quantity.hpp"
#include "solvers/smooth/forms.hpp"
#include "solvers/smooth/shooting.hpp"

// From an orbit of a smooth law to the quantities asked for, by the integrator's dense output.
namespace frahm::smooth {

using periodic::Extremes;
using periodic::Measure;
using periodic::Quantity;

// Integrals over the whole period.
struct Integrals {
  Eigen::MatrixXd gram;                  // of y y^T, y = (z, u)  [units of y^2 x s]
  Eigen::VectorXd rubbed;                // of phi_j v_j, each friction term's loss [J]
  double input = 0.0, input_size = 0.0;  // work of the excitation, integral of |its power| [J]
};

class Observables {
 public:
  // Both must outlive the observables.
  Observables(const mechanics::Assembly& assembly, Equation& equation, std::vector<Quantity> quantities);

  // When element values have changed.
  void set_system(const mechanics::LinearSystem& system);

  // out[i] is quantity i. Stops, reversals and events are -1, stuck fractions and error bounds NaN and
  // regimes not_computed: a smooth law creeps where the exact one sticks.
  void evaluate(const Orbit& orbit, const mechanics::LinearSystem& system, std::span<double> out);
  // For a point without a response.
  void fill_missing(Status status, std::span<double> out) const;

 private:
  Form form_of(const Quantity& quantity) const;
  void look_along(const Orbit& orbit);
  Extremes extremes_of(const Form& form, const Orbit& orbit);
  double stationary_time(const Form& form, const Orbit& orbit, std::size_t step);
  void integrate(const Orbit& orbit);
  std::vector<std::pair<Form, Form>> powers() const;
  double product(const Form& f, const Form& g) const;
  std::complex<double> reference_component(const Form& form) const;
  double phase_of(const Form& form, double magnitude) const;
  double element_energy(std::size_t element) const;
  double dissipated() const;
  double value_of(const Quantity& quantity);
  double value_of_point(const Quantity& quantity) const;
  double energy_balance() const;

  const mechanics::Assembly& assembly_;
  Equation& equation_;
  Forms forms_;
  std::vector<Quantity> quantities_;
  bool needs_integrals_ = false, needs_modes_ = false;
  std::vector<double> natural_frequency_, modal_damping_;

  // Of the orbit in hand.
  const Orbit* orbit_ = nullptr;
  const mechanics::LinearSystem* system_ = nullptr;
  std::vector<Instant> joints_;  // the instants between which the steps lie
  Integrals integrals_;
  Instant instant_;  // workspace
  Eigen::VectorXd state_;
};

}  // namespace frahm::smooth
