#include "solvers/smooth/observables.hpp"

#include <cmath>
#include <limits>

#include "solvers/quantities/fundamental_response.hpp"
#include "solvers/mechanics/modes.hpp"

namespace frahm::smooth {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

mechanics::Incidence of_mass(const mechanics::Assembly& assembly, std::size_t mass) {
  const auto& network = assembly.network();
  return {Eigen::VectorXd::Unit(static_cast<Eigen::Index>(network.masses.size()),
                                static_cast<Eigen::Index>(mass)),
          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.prescribed.size()))};
}

// What a smooth law, or a point without a response, has in place of a quantity.
double missing(Measure measure) {
  switch (measure) {
    case Measure::regime:
      return static_cast<double>(periodic::Regime::not_computed);
    case Measure::stops:
    case Measure::reversals:
    case Measure::newton_iterations:
    case Measure::events:
      return -1.0;
    default:
      return kNone;
  }
}

}  // namespace

Observables::Observables(const mechanics::Assembly& assembly, Equation& equation,
                         std::vector<Quantity> quantities)
    : assembly_(assembly),
      equation_(equation),
      forms_(assembly, equation),
      quantities_(std::move(quantities)) {
  for (const Quantity& quantity : quantities_) {
    switch (quantity.measure) {
      case Measure::mean:
      case Measure::rms:
      case Measure::phase:
      case Measure::harmonic:
      case Measure::magnification:
      case Measure::transmissibility:
      case Measure::force_transmissibility:
      case Measure::element_phase:
      case Measure::energy:
      case Measure::energy_share:
      case Measure::energy_input:
      case Measure::energy_balance:
        needs_integrals_ = true;
        break;
      case Measure::natural_frequency:
      case Measure::modal_damping:
        needs_modes_ = true;
        break;
      default:
        break;
    }
  }
}

void Observables::set_system(const mechanics::LinearSystem& system) {
  if (needs_modes_) periodic::modes_of(system, natural_frequency_, modal_damping_);
}

void Observables::fill_missing(Status status, std::span<double> out) const {
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    const Measure measure = quantities_[i].measure;
    out[i] = measure == Measure::status ? static_cast<double>(status) : missing(measure);
  }
}

void Observables::evaluate(const Orbit& orbit, const mechanics::LinearSystem& system, std::span<double> out) {
  orbit_ = &orbit;
  system_ = &system;
  look_along(orbit);
  if (needs_integrals_) integrate(orbit);
  for (std::size_t i = 0; i < quantities_.size(); ++i) out[i] = value_of(quantities_[i]);
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

// Where the form's slope is zero within a step at whose ends it has different signs: the secant method kept
// within the bracket (Illinois).
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

// Stationary points, solved; and the section, where the orbit could have one too.
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

// What puts energy in: outside forces on masses, and what drives each prescribed node.
std::vector<std::pair<Form, Form>> Observables::powers() const {
  std::vector<std::pair<Form, Form>> result;
  const auto& network = assembly_.network();
  for (std::size_t i = 0; i < network.masses.size(); ++i) {
    result.emplace_back(forms_.applied_force(i), forms_.velocity(of_mass(assembly_, i)));
  }
  for (std::size_t s = 0; s < network.prescribed.size(); ++s) {
    Form velocity = forms_.zero();
    velocity.u = equation_.motion_velocity().row(static_cast<Eigen::Index>(s)).transpose();
    const mechanics::Node node{mechanics::NodeKind::prescribed, s};
    result.emplace_back(forms_.node_force(node, system_->coefficients), velocity);
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
  integrals_.gram.setZero(both, both);
  integrals_.rubbed.setZero(equation_.terms());
  integrals_.input = integrals_.input_size = 0.0;
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
      integrals_.gram.noalias() += weight * y * y.transpose();
      integrals_.rubbed.array() += weight * instant_.friction.array() * equation_.speeds(t, state_).array();
      double power = 0.0;
      for (const auto& [force, velocity] : inputs) power += force.value(instant_) * velocity.value(instant_);
      integrals_.input += weight * power;
      integrals_.input_size += weight * std::abs(power);
    }
  }
}

// Integral over a period of the product of two forms without friction in them.
double Observables::product(const Form& f, const Form& g) const {
  Eigen::VectorXd a(f.z.size() + f.u.size()), b(a.size());
  a << f.z, f.u;
  b << g.z, g.u;
  return a.dot(integrals_.gram * b);
}

// X_n of a form, x_n(t) = Re X_n e^{i n omega t} its component at the reference order n.
std::complex<double> Observables::reference_component(const Form& form) const {
  if (orbit_->half_period && system_->reference_order % 2 == 0) return 0.0;
  const Eigen::Index place = periodic::reference_place(*system_);
  const auto component = [&](Eigen::Index oscillator) {
    Form unit = forms_.zero();
    unit.u[oscillator] = 1.0;
    return 2.0 / equation_.period() * product(form, unit);
  };
  return {component(1 + 2 * place), -component(2 + 2 * place)};
}

// x_n = |X_n| cos(n omega t - phase); NaN where there is none.
double Observables::phase_of(const Form& form, double magnitude) const {
  const std::complex<double> component = reference_component(form);
  return std::abs(component) <= 1e-12 * magnitude ? kNone : -std::arg(component);
}

// Integrals of c v^2, phi v and, of the damper in a Maxwell element, s^2/c.
double Observables::element_energy(std::size_t element) const {
  const mechanics::ElementCoefficients& law = system_->coefficients[element];
  double energy = 0.0;
  if (law.damping != 0.0) {
    const Form velocity = forms_.velocity(assembly_.incidences()[element]);
    energy += law.damping * product(velocity, velocity);
  }
  if (law.internal >= 0) {
    const Form force = forms_.element_force(element, law);
    energy += product(force, force) / law.internal_damping;
  }
  const auto& rubbing = equation_.elements();
  const auto term = std::find(rubbing.begin(), rubbing.end(), element);
  if (term != rubbing.end()) energy += integrals_.rubbed[term - rubbing.begin()];
  return energy;
}

double Observables::dissipated() const {
  double sum = 0.0;
  for (std::size_t e = 0; e < assembly_.network().elements.size(); ++e) sum += element_energy(e);
  return sum;
}

double Observables::energy_balance() const {
  const double lost = dissipated(), size = std::max(integrals_.input_size, lost);
  // Where nothing moves both are rounding of the forcing's energy.
  const double rounding = 1e-11 * equation_.static_norm() * equation_.static_norm();
  return size > rounding ? std::abs(integrals_.input - lost) / size : 0.0;
}

// What a quantity's extremes, or its phase, are those of.
Form Observables::form_of(const Quantity& quantity) const {
  switch (quantity.measure) {
    case Measure::velocity_peak:
      return forms_.velocity(of_mass(assembly_, quantity.index));
    case Measure::acceleration_peak:
      return forms_.acceleration(of_mass(assembly_, quantity.index));
    case Measure::stroke:
    case Measure::element_phase:
      return forms_.displacement(assembly_.incidences()[quantity.index]);
    case Measure::force_peak:
      return forms_.element_force(quantity.index, system_->coefficients[quantity.index]);
    case Measure::transmitted_force: {
      mechanics::Node node;
      if (quantity.index > 0) node = {mechanics::NodeKind::prescribed, quantity.index - 1};
      return forms_.node_force(node, system_->coefficients);
    }
    default:
      return forms_.displacement(of_mass(assembly_, quantity.index));
  }
}

double Observables::value_of(const Quantity& quantity) {
  switch (quantity.measure) {
    case Measure::amplitude: {
      const Extremes extremes = extremes_of(form_of(quantity), *orbit_);
      return 0.5 * (extremes.most - extremes.least);
    }
    case Measure::peak_phase:
      return extremes_of(form_of(quantity), *orbit_).most_phase;
    case Measure::peak:
    case Measure::velocity_peak:
    case Measure::acceleration_peak:
    case Measure::stroke:
    case Measure::force_peak:
    case Measure::transmitted_force:
      return extremes_of(form_of(quantity), *orbit_).peak(quantity.side);
    case Measure::phase:
    case Measure::element_phase: {
      const Form form = form_of(quantity);
      return phase_of(form, extremes_of(form, *orbit_).magnitude());
    }
    default:
      return value_of_point(quantity);
  }
}

double Observables::value_of_point(const Quantity& quantity) const {
  switch (quantity.measure) {
    case Measure::mean: {
      Form constant = forms_.zero();
      constant.u[0] = 1.0;
      return orbit_->half_period ? 0.0 : product(form_of(quantity), constant) / equation_.period();
    }
    case Measure::rms:
      return std::sqrt(product(form_of(quantity), form_of(quantity)) / equation_.period());
    case Measure::harmonic:
      return std::abs(reference_component(form_of(quantity)));
    case Measure::magnification:
      return periodic::ratio(
          std::abs(reference_component(form_of(quantity))),
          periodic::static_displacement(*system_)[static_cast<Eigen::Index>(quantity.index)]);
    case Measure::transmissibility:
      return periodic::ratio(std::abs(reference_component(form_of(quantity))),
                             periodic::support_amplitude(*system_));
    case Measure::force_transmissibility: {
      Eigen::VectorXcd X(system_->masses());
      for (Eigen::Index i = 0; i < X.size(); ++i) {
        X[i] = reference_component(forms_.displacement(of_mass(assembly_, static_cast<std::size_t>(i))));
      }
      return periodic::force_transmissibility(*system_, X);
    }
    case Measure::energy:
      return element_energy(quantity.index);
    case Measure::energy_share: {
      const double all = dissipated();
      return all > 0.0 ? element_energy(quantity.index) / all : 0.0;
    }
    case Measure::status:
      return static_cast<double>(orbit_->status);
    case Measure::floquet_radius:
      return orbit_->floquet_radius();
    case Measure::energy_input:
      return integrals_.input;
    case Measure::energy_balance:
      return energy_balance();
    case Measure::residual:
      return orbit_->residual;
    case Measure::newton_iterations:
      return orbit_->newton_iterations;
    case Measure::natural_frequency:
      return natural_frequency_[quantity.index];
    case Measure::modal_damping:
      return modal_damping_[quantity.index];
    default:
      return missing(quantity.measure);
  }
}

}  // namespace frahm::smooth
