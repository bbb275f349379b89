#pragma once

#include <span>
#include <vector>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/quantities/extremes.hpp"
#include "solvers/quantities/instant_motion.hpp"
#include "solvers/quantities/orbit_measurement.hpp"
#include "solvers/quantities/request.hpp"
#include "solvers/quantities/sensitivity_sizes.hpp"
#include "solvers/quantities/signal_derivatives.hpp"

// Computes the exact derivatives of the requested quantities at an exact orbit.
namespace frahm::periodic {

template <int N, int H>
class Gradient {
 public:
  using S = Sizes<N, H>;

  // `assembly` and `flow` must outlive the gradient.
  Gradient(const mechanics::Assembly& assembly, const Flow<N, H>& flow,
           const std::vector<Quantity>& quantities)
      : assembly_(assembly),
        flow_(flow),
        forms_(assembly, flow),
        request_(derivatives_of(quantities, assembly)),
        signals_(mechanics::incidences_beyond_masses(assembly.network())),
        why_none_(quantities.size(), ""),
        steps_(flow),
        sensitivity_(flow),
        measurement_(assembly, flow) {}

  // values: those of which the system was made.  directions, out: as in PeriodicResponse::gradient. Returns
  // "", or why there is no gradient; `out` is then NaN.
  const char* evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                       const mechanics::NetworkValues& values,
                       std::span<const mechanics::NetworkValues> directions, std::span<double> out);
  const char* why_none(std::size_t quantity) const { return why_none_[quantity]; }

 private:
  void report(std::span<double> out);
  void measure(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system);
  void place_instants(const Orbit<N, H>& orbit, std::size_t trace);
  const char* differentiate(const Orbit<N, H>& orbit, const mechanics::NetworkValues& values,
                            const mechanics::NetworkValues& direction);
  void carry(const Orbit<N, H>& orbit);
  void integrate();
  void follow_contacts(const Orbit<N, H>& orbit);
  void differentiate_trace(std::size_t trace);
  CandidateDerivative of_candidate(std::size_t trace, std::size_t candidate);
  void look_at(const Instant<N, H>& x, const InstantDerivative<N, H>& d);
  void look_at_joints(const Instant<N, H>& x, const InstantDerivative<N, H>& d);
  void look_at_forces(const Instant<N, H>& x, const InstantDerivative<N, H>& d, std::size_t mode);

  const mechanics::Assembly& assembly_;
  const Flow<N, H>& flow_;
  Forms<N, H> forms_;
  Request request_;
  std::vector<mechanics::Incidence> signals_;
  std::vector<const char*> why_none_;  // of each quantity

  // The current orbit.
  Eigen::VectorXd carried_by_;
  OrbitSteps<N, H> steps_;
  OrbitSensitivity<N, H> sensitivity_;
  OrbitMeasurement<N, H> measurement_;
  TracedOrbit<N, H> traced_;
  Measured measured_;                                 // extremes: over the passage
  std::vector<std::vector<Instant<N, H>>> instants_;  // of each trace's candidates

  // The current direction.
  mechanics::LinearSystem system_by_;
  StepDerivative<N, H> by_;
  MeasuredDerivative measured_by_;
  InstantMotion motion_;  // at the current candidate
};

extern template class Gradient<1, 1>;
extern template class Gradient<2, 1>;
extern template class Gradient<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
