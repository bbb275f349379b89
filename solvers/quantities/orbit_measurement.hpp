#pragma once

#include <vector>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/quantities/bend_losses.hpp"
#include "solvers/quantities/integrals.hpp"
#include "solvers/quantities/joint_products.hpp"
#include "solvers/quantities/quantity_table.hpp"
#include "solvers/quantities/quantity_values.hpp"

namespace frahm::periodic {

// Measures what both quantities and derivatives of an exact orbit need, in SI units.
template <int N, int H>
class OrbitMeasurement {
 public:
  using S = Sizes<N, H>;

  // Both must outlive the measurement.
  OrbitMeasurement(const mechanics::Assembly& assembly, const Flow<N, H>& flow)
      : assembly_(assembly),
        flow_(flow),
        forms_(assembly, flow),
        signals_(mechanics::incidences_beyond_masses(assembly.network())) {}

  // steps: of the orbit, laid out.
  void measure(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system, OrbitSteps<N, H>& steps,
               const Needs& needs, Measured& measured);

 private:
  using Powers = std::vector<typename Integrals<N, H>::Power>;

  void integrate(const Orbit<N, H>& orbit, OrbitSteps<N, H>& steps, bool with_input, Measured& measured);
  void list_powers(const Mode<N, H>& mode, const mechanics::LinearSystem& system, Powers& powers) const;
  void follow_contacts(const Orbit<N, H>& orbit, Measured& measured);
  double relative_displacement(Eigen::Index contact, const typename S::State& z, double phase,
                               const mechanics::LinearSystem& system) const;

  const mechanics::Assembly& assembly_;
  const Flow<N, H>& flow_;
  Forms<N, H> forms_;
  std::vector<mechanics::Incidence> signals_;
  std::vector<LinearForm<N, H>> signal_forms_;  // of the current forcing
  Integrals<N, H> integrals_;
  std::vector<ContactStretch> stretches_;
};

template <int N, int H>
void OrbitMeasurement<N, H>::measure(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                                     OrbitSteps<N, H>& steps, const Needs& needs, Measured& measured) {
  const StepEquations<N, H>& eq = flow_.equations();
  measured.assembly = &assembly_;
  measured.system = &system;
  measured.period = eq.period * eq.step;
  measured.half_period = orbit.half_period;
  measured.status = orbit.status;
  measured.residual = orbit.residual;
  measured.error_bound = orbit.error_bound;
  measured.floquet_radius = orbit.floquet_radius;
  measured.coexisting = orbit.coexisting;
  measured.multiple = orbit.multiple;
  measured.unsettled = orbit.unsettled;
  measured.drift = steps.frame().rate * (eq.period / orbit.multiple);
  measured.free_sliders = 0;
  for (const Eigen::Index j : list_of(orbit.stuck_throughout)) measured.free_sliders += eq.holds(j) ? 0 : 1;
  measured.newton_iterations = orbit.newton_iterations;
  measured.events = (orbit.half_period ? 2 : 1) * (orbit.passage.events - orbit.passage.bends);
  measured.static_norm = flow_.static_norm();
  measured.state_norm = eq.energy_norm(orbit.z);
  if (needs.integrals) integrate(orbit, steps, needs.input, measured);
  if (needs.histories || needs.energies) follow_contacts(orbit, measured);
  if (!needs.energies) return;
  value::add_up_friction(measured);
  measured.bend_loss = bend_losses(steps, flow_, forms_, orbit.half_period);
  measured.structural_loss = value::structural_loss(measured);
  value::add_up_losses(measured);
}

template <int N, int H>
void OrbitMeasurement<N, H>::integrate(const Orbit<N, H>& orbit, OrbitSteps<N, H>& steps, bool with_input,
                                       Measured& measured) {
  const StepEquations<N, H>& eq = flow_.equations();
  const mechanics::LinearSystem& system = *measured.system;
  signal_forms_.clear();
  for (const mechanics::Incidence& at : signals_) signal_forms_.push_back(forms_.displacement(at));
  integrals_.integrate(steps, flow_, orbit.half_period, signal_forms_,
                       [&](const Mode<N, H>& mode, Powers& powers) {
                         powers.clear();
                         if (with_input) list_powers(mode, system, powers);
                       });
  measured.gram = integrals_.gram();
  in_seconds(eq.masses(), eq.step, measured.gram);
  append_signals(integrals_.signals(), measured.gram);
  measured.input = integrals_.input();
  measured.input_size = integrals_.input_size();
  measured.motion = eq.motion;
  measured.motion_velocity = eq.motion_velocity;
  measured.motion_velocity /= eq.step;
  measured.joints = eq.joints.any() ? joint_rows(eq) : JointRows{};
}

// The inputs of energy: outside forces on masses, and the force that drives each prescribed node.
template <int N, int H>
void OrbitMeasurement<N, H>::list_powers(const Mode<N, H>& mode, const mechanics::LinearSystem& system,
                                         Powers& powers) const {
  const StepEquations<N, H>& eq = flow_.equations();
  for (Eigen::Index i = 0; i < eq.masses(); ++i) {
    if (eq.applied_force.row(i).isZero(0.0)) continue;
    powers.push_back({forms_.zero(), forms_.zero()});
    powers.back().force.u = eq.applied_force.row(i).transpose();
    powers.back().velocity.z[eq.masses() + i] = 1.0 / eq.step;
  }
  for (Eigen::Index j = 0; j < eq.joints.load.rows(); ++j) {
    if (eq.joints.load.row(j).isZero(0.0)) continue;
    powers.push_back({forms_.zero(), forms_.velocity_of_joint(j)});
    powers.back().force.u = eq.joints.load.row(j).transpose();
  }
  for (Eigen::Index s = 0; s < eq.motion.rows(); ++s) {
    const mechanics::Node node{mechanics::NodeKind::prescribed, static_cast<std::size_t>(s)};
    powers.push_back({forms_.node_force(node, system, mode), forms_.zero()});
    powers.back().velocity.u = eq.motion_velocity.row(s).transpose() / eq.step;
  }
}

template <int N, int H>
void OrbitMeasurement<N, H>::follow_contacts(const Orbit<N, H>& orbit, Measured& measured) {
  const auto& segments = orbit.passage.segments;
  const double rate = flow_.fundamental_rate();
  measured.histories.resize(assembly_.contacts());
  stretches_.resize(segments.size());
  for (std::size_t contact = 0; contact < measured.histories.size(); ++contact) {
    const auto j = static_cast<Eigen::Index>(contact);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const Segment<N, H>& segment = segments[i];
      const Mode<N, H>& mode = flow_.mode(segment.mode);
      stretches_[i] = {segment.length, flow_.rests(mode, j), mode.sign(j), 0.0};
      if (stretches_[i].sticks) continue;
      const auto& end_state = i + 1 == segments.size() ? orbit.passage.end : segments[i + 1].z;
      const double start = orbit.section + segment.start * rate, end = start + segment.length * rate;
      stretches_[i].slid = relative_displacement(j, end_state, end, *measured.system) -
                           relative_displacement(j, segment.z, start, *measured.system);
    }
    measured.histories[contact] = contact_history(stretches_, orbit.half_period);
  }
}

// w^T q + p^T y [m] at omega t = phase, with what a belt has moved since phase 0.
template <int N, int H>
double OrbitMeasurement<N, H>::relative_displacement(Eigen::Index contact, const typename S::State& z,
                                                     double phase,
                                                     const mechanics::LinearSystem& system) const {
  const StepEquations<N, H>& eq = flow_.equations();
  double u = system.W.col(contact).dot(z.head(eq.masses()));
  if (eq.support_velocity.row(contact).isZero(0.0)) return u;  // none of its supports moves
  typename S::Oscillators oscillators(eq.oscillators());
  eq.oscillators_at(phase, flow_.orders(), oscillators);
  for (Eigen::Index s = 0; s < eq.motion.rows(); ++s)
    u +=
        system.W_support(s, contact) * (eq.motion.row(s).dot(oscillators) +
                                        system.belt_velocity[s] * eq.step * phase / flow_.fundamental_rate());
  return u;
}

extern template class OrbitMeasurement<1, 1>;
extern template class OrbitMeasurement<2, 1>;
extern template class OrbitMeasurement<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
