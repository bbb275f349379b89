#include "solvers/smooth/observables.hpp"

#include <cmath>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/quantities/quantity_values.hpp"

namespace frahm::smooth {

Observables::Observables(const mechanics::Assembly& assembly, Equation& equation,
                         const std::vector<Quantity>& quantities)
    : assembly_(assembly),
      equation_(equation),
      forms_(assembly, equation),
      request_(periodic::values_of(quantities, assembly)),
      signals_(mechanics::incidences_beyond_masses(assembly.network())) {}

void Observables::set_system(const mechanics::LinearSystem& system) {
  if (request_.needs.modes) periodic::modes_of(system, measured_.natural_frequency, measured_.modal_damping);
}

void Observables::fill_missing(Status status, int unsettled, std::span<double> out) const {
  periodic::tell_missing(request_, status, unsettled, out);
}

void Observables::evaluate(const Orbit& orbit, const mechanics::LinearSystem& system, std::span<double> out) {
  look_along(orbit);
  measure(orbit, system);
  periodic::tell_values(request_, measured_, out);
}

// There are no contact histories, no events and no error bound to fill in.
void Observables::measure(const Orbit& orbit, const mechanics::LinearSystem& system) {
  measured_.assembly = &assembly_;
  measured_.system = &system;
  measured_.traces = &request_.traces;
  measured_.period = equation_.period();
  measured_.half_period = orbit.half_period;
  measured_.status = orbit.status;
  measured_.residual = orbit.residual;
  measured_.multiple = orbit.multiple;
  measured_.coexisting = orbit.coexisting;
  measured_.unsettled = orbit.unsettled;
  if (request_.needs.stability) measured_.floquet_radius = orbit.floquet_radius();
  measured_.newton_iterations = orbit.newton_iterations;
  measured_.static_norm = equation_.static_norm();
  measured_.motion = equation_.motion();
  measured_.motion_velocity = equation_.motion_velocity();
  if (request_.needs.integrals) integrate(orbit);
  if (request_.needs.energies) {
    measured_.structural_loss = periodic::value::structural_loss(measured_);
    periodic::value::add_up_losses(measured_);
  }
  measured_.extremes.clear();
  for (const periodic::Trace& trace : request_.traces)
    measured_.extremes.push_back(extremes_of(periodic::form_of(trace, forms_, system), orbit));
}

void Observables::look_along(const Orbit& orbit) {
  const Trajectory& trajectory = orbit.passage.trajectory;
  const auto& steps = trajectory.steps();
  joints_.resize(steps.size() + 1);
  trajectory.state(0, steps.front().start, state_);
  equation_.look(steps.front().start, state_, joints_.front());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    trajectory.state(i, steps[i].end, state_);
    equation_.look(steps[i].end, state_, joints_[i + 1]);
  }
}

// The time at which the form's slope is zero within a step at whose ends it has different signs: the secant
// method, confined to the bracket (Illinois).
double Observables::stationary_time(const Form& form, const Orbit& orbit, std::size_t step) {
  const Trajectory& trajectory = orbit.passage.trajectory;
  double a = trajectory.steps()[step].start, b = trajectory.steps()[step].end;
  double at_a = form.slope(joints_[step]), at_b = form.slope(joints_[step + 1]);
  constexpr int kMostSecants = 60;
  for (int i = 0; i < kMostSecants && at_b != 0.0; ++i) {
    const double t = b - at_b * (b - a) / (at_b - at_a);
    if (t == b || t == a) break;
    trajectory.state(step, t, state_);
    equation_.look(t, state_, instant_);
    const double at_t = form.slope(instant_);
    if ((at_t > 0.0) != (at_b > 0.0)) {
      a = b;
      at_a = at_b;
    } else {
      at_a *= 0.5;
    }
    b = t;
    at_b = at_t;
  }
  return b;
}

// The stationary points, solved; and the section, which could be one too.
Extremes Observables::extremes_of(const Form& form, const Orbit& orbit) {
  const Trajectory& trajectory = orbit.passage.trajectory;
  periodic::ExtremeCollector collector(0.0, equation_.omega());
  collector.consider(form.value(joints_.front()), orbit.section, true);
  double left = form.slope(joints_.front());
  for (std::size_t i = 0; i < trajectory.steps().size(); ++i) {
    const double right = form.slope(joints_[i + 1]);
    if ((left > 0.0 && right <= 0.0) || (left < 0.0 && right >= 0.0)) {
      const double t = stationary_time(form, orbit, i);
      trajectory.state(i, t, state_);
      equation_.look(t, state_, instant_);
      collector.consider(form.value(instant_), t, true);
    }
    left = right;
  }
  const Extremes found = collector.with_phases();
  return orbit.half_period ? periodic::mirrored(found) : found;
}

// The inputs of energy: outside forces on masses, and the force that drives each prescribed node.
std::vector<std::pair<Form, Form>> Observables::powers() const {
  std::vector<std::pair<Form, Form>> result;
  const auto& network = assembly_.network();
  for (std::size_t i = 0; i < network.masses.size(); ++i) {
    result.emplace_back(forms_.applied_force(i),
                        forms_.velocity(mechanics::coordinate_incidence(network, i)));
  }
  for (std::size_t s = 0; s < network.prescribed.size(); ++s) {
    Form velocity = forms_.zero();
    velocity.u = equation_.motion_velocity().row(static_cast<Eigen::Index>(s)).transpose();
    const mechanics::Node node{mechanics::NodeKind::prescribed, s};
    result.emplace_back(forms_.node_force(node, *measured_.system), velocity);
  }
  return result;
}

// Gauss-Legendre's four points a step (Abramowitz and Stegun, table 25.4), exact to degree 7; the motion is
// of degree 5 there.
void Observables::integrate(const Orbit& orbit) {
  constexpr double kAt[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
  constexpr double kWeight[] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                0.3478548451374538};
  const Trajectory& trajectory = orbit.passage.trajectory;
  const Eigen::Index size = equation_.size(), both = size + equation_.oscillators();
  const auto inputs = powers();
  const std::vector<std::size_t>& bent = equation_.elements();
  measured_.gram.setZero(both, both);
  std::vector<Form> signals;
  for (const mechanics::Incidence& at : signals_) signals.push_back(forms_.displacement(at));
  const Eigen::Index oscillators = equation_.oscillators();
  Eigen::MatrixXd products =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(signals.size()), oscillators + 1);
  measured_.friction_loss.assign(assembly_.network().elements.size(), 0.0);
  measured_.input = measured_.input_size = 0.0;
  Eigen::VectorXd y(both);
  const double times = orbit.half_period ? 2.0 : 1.0;
  for (std::size_t i = 0; i < trajectory.steps().size(); ++i) {
    const auto [start, end] = trajectory.steps()[i];
    for (int k = 0; k < 4; ++k) {
      const double t = 0.5 * (start + end) + 0.5 * (end - start) * kAt[k];
      const double weight = times * 0.5 * (end - start) * kWeight[k];
      trajectory.state(i, t, state_);
      equation_.look(t, state_, instant_);
      y << instant_.z, instant_.u;
      measured_.gram.noalias() += weight * y * y.transpose();
      for (Eigen::Index s = 0; s < products.rows(); ++s) {
        const double value = signals[static_cast<std::size_t>(s)].value(instant_);
        products.row(s).head(oscillators) += weight * value * instant_.u.transpose();
        products(s, oscillators) += weight * value * value;
      }
      const Eigen::VectorXd& x = equation_.arguments(t, state_);
      for (Eigen::Index j = 0; j < x.size(); ++j) {
        if (equation_.rubs(j))
          measured_.friction_loss[bent[static_cast<std::size_t>(j)]] += weight * instant_.bent[j] * x[j];
      }
      double power = 0.0;
      for (const auto& [force, velocity] : inputs) power += force.value(instant_) * velocity.value(instant_);
      measured_.input += weight * power;
      measured_.input_size += weight * std::abs(power);
    }
  }
  periodic::append_signals(products, measured_.gram);
}

}  // namespace frahm::smooth
