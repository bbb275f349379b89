#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solvers/quantities/request.hpp"
#include "solvers/smooth/forms.hpp"
#include "solvers/smooth/shooting.hpp"

// Computes the requested quantities of an orbit of a smooth law, by the integrator's dense output.
namespace frahm::smooth {

using periodic::Extremes;
using periodic::Quantity;

class Observables {
 public:
  // Both must outlive the observables.
  Observables(const mechanics::Assembly& assembly, Equation& equation,
              const std::vector<Quantity>& quantities);

  // When element values have changed.
  void set_system(const mechanics::LinearSystem& system);

  // out[i] is quantity i. Stops, reversals and events are -1, stuck fractions and error bounds NaN and
  // regimes not_computed: a smooth law creeps where the exact one sticks.
  void evaluate(const Orbit& orbit, const mechanics::LinearSystem& system, std::span<double> out);
  // For a point without a response.
  void fill_missing(Status status, int unsettled, std::span<double> out) const;

 private:
  void measure(const Orbit& orbit, const mechanics::LinearSystem& system);
  void look_along(const Orbit& orbit);
  Extremes extremes_of(const Form& form, const Orbit& orbit);
  double stationary_time(const Form& form, const Orbit& orbit, std::size_t step);
  void integrate(const Orbit& orbit);
  std::vector<std::pair<Form, Form>> powers() const;

  const mechanics::Assembly& assembly_;
  Equation& equation_;
  Forms forms_;
  periodic::Request request_;
  std::vector<mechanics::Incidence> signals_;
  periodic::Measured measured_;

  std::vector<Instant> joints_;  // of the current orbit: the instants between which the steps lie
  Instant instant_;              // workspace
  Eigen::VectorXd state_;
};

}  // namespace frahm::smooth
