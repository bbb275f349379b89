#include "solvers/smooth/smooth_solver.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "solvers/algebra/no_value.hpp"
#include "solvers/exact/exact_solver.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/smooth/observables.hpp"
#include "solvers/smooth/shooting.hpp"

namespace frahm::smooth {
namespace {

using mechanics::Element;
using mechanics::FrictionLaw;
using mechanics::Network;
using periodic::History;

bool rubs(const Element& element, FrictionLaw law) {
  return mechanics::has_contact(element) && element.law == law;
}

Network under_exact_law(Network network) {
  for (Element& element : network.elements) element.law = FrictionLaw::exact;
  return network;
}

const Network& without_mixed_laws(const Network& network) {
  for (const Element& element : network.elements) {
    if (!rubs(element, FrictionLaw::exact)) continue;
    throw mechanics::MechanicsError("element '" + element.name +
                                    "' follows the exact law and others the arctan law: one law for all");
  }
  return network;
}

class SmoothSolver final : public periodic::ResponseSolver {
 public:
  SmoothSolver(const Network& network, const std::vector<Quantity>& quantities)
      : assembly_(without_mixed_laws(network)),
        exact_(periodic::make_exact_solver(under_exact_law(network), {})),
        equation_(assembly_),
        integrator_(equation_),
        shooting_(equation_, integrator_),
        observables_(assembly_, equation_, quantities) {}

  void set_values(const mechanics::NetworkValues& values) override {
    exact_->set_values(values);
    assembly_.set_values(values, system_);
    assembly_.set_forcing(values, system_);
    equation_.set(system_, values);
    undamped_modes_ = periodic::undamped_modes(system_);
    observables_.set_system(system_);
  }

  void set_forcing(const mechanics::NetworkValues& values) override {
    if (assembly_.matrices_depend_on_frequency()) return set_values(values);
    exact_->set_forcing(values);
    assembly_.set_forcing(values, system_);
    equation_.set(system_, values);
  }

  void forget() override { exact_->forget(); }
  void begin_row() override { exact_->begin_row(); }
  const periodic::ResponseSummary& solve() override;

  void quantities(std::span<double> out) override {
    if (orbit_.status == Status::ok)
      observables_.evaluate(orbit_, system_, out);
    else
      observables_.fill_missing(orbit_.status, out);
  }

  const char* gradient(std::span<const mechanics::NetworkValues>, std::span<double> out) override {
    std::fill(out.begin(), out.end(), kNone);
    return why_no_derivative(0);
  }
  const char* why_no_derivative(std::size_t) const override {
    return "a response under the arctan law is integrated, and has no exact derivative";
  }

  const char* observe(std::span<const double>, std::span<const periodic::Observed>,
                      std::span<const mechanics::NetworkValues>, periodic::ObservedMotion& out) override {
    out = {};
    return why_no_derivative(0);
  }
  History history(std::span<const double> phases) override;
  std::vector<periodic::Stretch> stretches() const override { return {}; }  // nothing ever sticks

 private:
  void search();
  bool guess_from_exact_law();
  void guess_without_friction();
  Eigen::VectorXd scale(double displacement, double velocity) const;
  void state_at(double phase, Eigen::VectorXd& z) const;

  mechanics::Assembly assembly_;
  mechanics::LinearSystem system_;
  std::vector<periodic::UndampedMode> undamped_modes_;
  std::unique_ptr<periodic::ResponseSolver> exact_;
  Equation equation_;
  Integrator integrator_;
  Shooting shooting_;
  Observables observables_;
  Orbit orbit_;
  Eigen::VectorXd scale_;
  periodic::ResponseSummary summary_;
};

const periodic::ResponseSummary& SmoothSolver::solve() {
  orbit_.residual = kNone;
  orbit_.newton_iterations = orbit_.passages = 0;
  orbit_.half_period = system_.odd_response;
  if (periodic::is_unbounded(system_, undamped_modes_)) {  // arctan friction dissipates less than exact
    orbit_.status = Status::unbounded;
    orbit_.reason = "an undamped mode is driven at its resonance, and no friction holds it";
  } else {
    try {
      search();
    } catch (const std::exception& error) {
      orbit_.status = Status::failed;
      orbit_.reason = error.what();
    }
  }
  summary_ = {.status = orbit_.status,
              .reason = orbit_.reason,
              .residual = orbit_.residual,
              .newton_iterations = orbit_.newton_iterations,
              .passages = orbit_.passages,
              .half_period = orbit_.half_period};
  return summary_;
}

void SmoothSolver::search() {
  if (guess_from_exact_law()) {
    shooting_.find(scale_, orbit_);
    if (orbit_.status == Status::ok) return;
  }
  guess_without_friction();
  shooting_.find(scale_, orbit_);
}

// The exact orbit at the instant at which all contacts slide fastest, each relative to its own maximum: there
// the smooth orbit is nearest, and its motion least sensitive. False if the exact law has no orbit.
bool SmoothSolver::guess_from_exact_law() {
  const Status status = exact_->solve().status;
  if (status != Status::ok && status != Status::grazing) return false;
  constexpr Eigen::Index kSamples = 64;
  const History history = exact_->history(periodic::phases_of_a_period(kSamples + 1));
  const Eigen::Index n = equation_.masses();
  const auto& elements = assembly_.network().elements;
  Eigen::MatrixXd states(equation_.size(), kSamples), speeds(equation_.terms(), kSamples);
  for (Eigen::Index i = 0; i < kSamples; ++i) {
    const auto sample = static_cast<std::size_t>(i);
    for (Eigen::Index mass = 0; mass < n; ++mass) {
      states(mass, i) = history.columns[static_cast<std::size_t>(2 * mass)][sample];
      states(n + mass, i) = history.columns[static_cast<std::size_t>(2 * mass + 1)][sample];
    }
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const Eigen::Index internal = system_.coefficients[e].internal;
      if (internal >= 0)
        states(2 * n + internal, i) = history.columns[static_cast<std::size_t>(2 * n) + e][sample];
    }
    speeds.col(i) = equation_.speeds(history.time[sample], states.col(i)).cwiseAbs();
  }
  Eigen::VectorXd slowest = Eigen::VectorXd::Ones(kSamples);
  const double fastest = speeds.size() > 0 ? speeds.maxCoeff() : 0.0;
  for (Eigen::Index j = 0; j < speeds.rows(); ++j) {
    const double own = speeds.row(j).maxCoeff();
    if (equation_.limits()[j] == 0.0 || own <= 1e-9 * fastest) continue;
    slowest = slowest.cwiseMin(speeds.row(j).transpose() / own);
  }
  Eigen::Index best = 0;
  slowest.maxCoeff(&best);
  orbit_.z = states.col(best);
  orbit_.section = history.time[static_cast<std::size_t>(best)];
  scale_ = scale(states.topRows(n).cwiseAbs().maxCoeff(), states.middleRows(n, n).cwiseAbs().maxCoeff());
  return true;
}

void SmoothSolver::guess_without_friction() {
  orbit_.section = 0.0;
  orbit_.z = equation_.response_without_friction(0.0);
  const double limit = 1e6 * equation_.static_norm();
  if (!orbit_.z.allFinite() || equation_.energy_norm(orbit_.z) > limit) orbit_.z.setZero();
  const Eigen::Index n = equation_.masses();
  scale_ = scale(orbit_.z.head(n).cwiseAbs().maxCoeff(), orbit_.z.segment(n, n).cwiseAbs().maxCoeff());
}

// Scales of displacements, velocities and Maxwell forces for their errors: the largest values, and at least a
// thousandth of the static ones.
Eigen::VectorXd SmoothSolver::scale(double displacement, double velocity) const {
  const Eigen::Index n = equation_.masses();
  const double least = 1e-3 * equation_.static_displacement();
  double q = std::max({displacement, velocity / system_.omega, least});
  if (!(q > 0.0)) q = 1.0;
  Eigen::VectorXd result(equation_.size());
  result.head(n).setConstant(q);
  result.segment(n, n).setConstant(q * system_.omega);
  result.tail(result.size() - 2 * n) = q * system_.internal_stiffness;
  return result;
}

// The orbit at omega t = phase.
void SmoothSolver::state_at(double phase, Eigen::VectorXd& z) const {
  const periodic::PlaceOnOrbit place =
      periodic::place_on_orbit(phase, system_.omega * orbit_.section, orbit_.half_period);
  const double t = orbit_.section + place.from_section / system_.omega;
  const Trajectory& trajectory = orbit_.passage.trajectory;
  trajectory.state(trajectory.step_at(t), t, z);
  z *= place.sign;
}

History SmoothSolver::history(std::span<const double> phases) {
  const Network& network = assembly_.network();
  const Forms forms(assembly_, equation_);
  History result = History::of(network);
  std::vector<Form> element_forces;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    element_forces.push_back(forms.element_force(e, system_.coefficients[e]));
  }
  std::vector<Form> of_signals;
  for (const mechanics::Incidence& at : mechanics::signal_incidences(network))
    of_signals.insert(of_signals.end(), {forms.displacement(at), forms.velocity(at), forms.acceleration(at)});
  Instant instant;
  Eigen::VectorXd z;
  for (const double phase : phases) {
    state_at(phase, z);
    equation_.look(phase / system_.omega, z, instant);
    result.time.push_back(phase / system_.omega);
    std::size_t column = 0;
    for (Eigen::Index mass = 0; mass < equation_.masses(); ++mass) {
      result.columns[column++].push_back(z[mass]);
      result.columns[column++].push_back(z[equation_.masses() + mass]);
    }
    for (const Form& force : element_forces) result.columns[column++].push_back(force.value(instant));
    for (Eigen::Index mass = 0; mass < equation_.masses(); ++mass)
      result.columns[column++].push_back(instant.dz[equation_.masses() + mass]);
    for (const Form& form : of_signals) result.columns[column++].push_back(form.value(instant));
  }
  return result;
}

}  // namespace

bool is_smooth(const Network& network) {
  return std::any_of(network.elements.begin(), network.elements.end(),
                     [](const Element& element) { return rubs(element, FrictionLaw::arctan); });
}

std::unique_ptr<periodic::ResponseSolver> make_solver(const Network& network,
                                                      std::vector<Quantity> quantities) {
  return std::make_unique<SmoothSolver>(network, std::move(quantities));
}

}  // namespace frahm::smooth
