#include "solvers/smooth/smooth_solver.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "solvers/algebra/no_value.hpp"
#include "solvers/exact/exact_solver.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/orbits/period_multiple.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/smooth/coexistence.hpp"
#include "solvers/smooth/equivalent_response.hpp"
#include "solvers/smooth/observables.hpp"
#include "solvers/smooth/shooting.hpp"

namespace frahm::smooth {
namespace {

using mechanics::Element;
using mechanics::ForceLaw;
using mechanics::Network;
using periodic::History;

// None where it would not serve.
std::unique_ptr<periodic::ResponseSolver> solver_of_exact_law(Network network) {
  for (Element& element : network.elements) {
    if (!mechanics::is_near_exact(element.law)) return nullptr;
    element.law = ForceLaw::exact;
  }
  if (mechanics::Assembly(network).contacts() > periodic::kMostContacts) return nullptr;
  return periodic::make_exact_solver(network, {});
}

const Network& without_mixed_laws(const Network& network) {
  for (const Element& element : network.elements) {
    const bool rubs_exactly = mechanics::has_contact(element) && !mechanics::has_smooth_law(element);
    if (!rubs_exactly && element.bends.empty()) continue;
    throw mechanics::MechanicsError(
        "element '" + element.name +
        "' follows an exact law and others a smooth one: all must follow the same kind");
  }
  return network;
}

class SmoothSolver final : public periodic::ResponseSolver {
 public:
  SmoothSolver(const Network& network, const std::vector<Quantity>& quantities,
               const periodic::OrbitsWanted& wanted)
      : assembly_(without_mixed_laws(network)),
        exact_(solver_of_exact_law(network)),
        equation_(assembly_),
        integrator_(equation_),
        shooting_(equation_, integrator_),
        coexistence_(equation_, integrator_, wanted),
        observables_(assembly_, equation_, quantities) {}

  void set_values(const mechanics::NetworkValues& values) override {
    if (exact_) exact_->set_values(values);
    values_ = values;
    assembly_.set_values(values, system_);
    assembly_.set_forcing(values, system_);
    equation_.set(system_, values);
    undamped_modes_ = periodic::undamped_modes(system_);
    observables_.set_system(system_);
  }

  void set_forcing(const mechanics::NetworkValues& values) override {
    if (assembly_.matrices_depend_on_frequency()) return set_values(values);
    if (exact_) exact_->set_forcing(values);
    values_ = values;
    assembly_.set_forcing(values, system_);
    equation_.set(system_, values);
  }

  void forget() override {
    if (exact_) exact_->forget();
    coexistence_.forget();
  }
  void begin_row() override {
    if (exact_) exact_->begin_row();
    coexistence_.forget();
  }
  const periodic::ResponseSummary& solve() override;
  void tell(int which) override;
  int multiple() const override { return orbit_.multiple; }
  std::vector<std::complex<double>> multipliers() override {
    return orbit_.is_found() ? orbit_.multipliers() : std::vector<std::complex<double>>{};
  }

  void quantities(std::span<double> out) override {
    if (orbit_.is_found())
      observables_.evaluate(orbit_, reported_system(), out);
    else
      observables_.fill_missing(orbit_.status, orbit_.unsettled, out);
  }

  const char* gradient(std::span<const mechanics::NetworkValues>, std::span<double> out) override {
    std::fill(out.begin(), out.end(), kNone);
    return why_no_derivative(0);
  }
  const char* why_no_derivative(std::size_t) const override {
    return "a response under a smooth law is integrated and has no exact derivative";
  }

  const char* observe(std::span<const double>, std::span<const periodic::Observed>,
                      std::span<const mechanics::NetworkValues>, periodic::ObservedMotion& out) override {
    out = {};
    return why_no_derivative(0);
  }
  History history(std::span<const double> phases, periodic::SliderForces sliders) override;
  std::vector<periodic::Stretch> stretches() const override { return {}; }  // nothing ever sticks

 private:
  const mechanics::LinearSystem& reported_system() const { return orbit_.multiple > 1 ? longer_ : system_; }
  void search();
  void search_one();
  bool guess_from_exact_law();
  void guess_equivalent_response();
  bool closes_from_guess();
  void march();
  bool follow(int periods, Eigen::VectorXd& z);
  void scale_around(const Eigen::VectorXd& z);
  void state_at(double phase, Eigen::VectorXd& z) const;

  mechanics::Assembly assembly_;
  mechanics::NetworkValues values_;          // of the system
  mechanics::LinearSystem system_, longer_;  // longer: over the multiple of the period that the orbit takes
  std::vector<periodic::UndampedMode> undamped_modes_;
  std::unique_ptr<periodic::ResponseSolver> exact_;  // may be none
  Equation equation_;
  Integrator integrator_;
  Shooting shooting_;
  Coexistence coexistence_;
  Observables observables_;
  Orbit orbit_;
  Eigen::VectorXd scale_;
  periodic::ResponseSummary summary_;
};

const periodic::ResponseSummary& SmoothSolver::solve() {
  orbit_.residual = kNone;
  orbit_.newton_iterations = orbit_.passages = 0;
  orbit_.half_period = system_.odd_response;
  orbit_.multiple = orbit_.coexisting = 1;
  orbit_.unsettled = 0;
  if (system_.monotone && periodic::is_unbounded(system_, undamped_modes_)) {
    orbit_.status = Status::unbounded;
    orbit_.reason = periodic::kUnbounded;
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
              .multiple = orbit_.multiple,
              .coexisting = orbit_.coexisting,
              .half_period = orbit_.half_period};
  return summary_;
}

void SmoothSolver::tell(int which) {
  if (system_.monotone || !orbit_.is_found()) return;
  equation_.set(system_, values_);  // after an orbit of several periods
  coexistence_.tell(static_cast<std::size_t>(which), orbit_);
  if (orbit_.multiple > 1) longer_ = periodic::over_multiple(system_, orbit_.multiple);
}

void SmoothSolver::search() {
  const periodic::LimitedSearch limit(integrator_.work());
  equation_.set(system_, values_);  // after an orbit of several periods
  if (system_.monotone) return search_one();
  coexistence_.find(system_, values_, orbit_);
  if (orbit_.multiple > 1) longer_ = periodic::over_multiple(system_, orbit_.multiple);
}

void SmoothSolver::search_one() {
  if (guess_from_exact_law() && closes_from_guess()) return;
  guess_equivalent_response();
  if (!closes_from_guess()) march();
}

// Whether an orbit was found, though the integrator may be too coarse for it.
bool SmoothSolver::closes_from_guess() {
  shooting_.find(scale_, orbit_);
  return orbit_.status == Status::ok || orbit_.residual <= ShootingOptions{}.good_enough;
}

// From rest the motion of a monotone system comes to its orbit, wherever there is one; Newton's method takes
// over as soon as it is near.
void SmoothSolver::march() {
  constexpr int kFirst = 8, kLonger = 3, kMost = 17496;  // periods
  Shooting closing(equation_, integrator_, {.most_passages = 12, .applies_map = false});
  Eigen::VectorXd z = Eigen::VectorXd::Zero(equation_.size());
  orbit_.section = 0.0;
  int periods = 0, newton_iterations = orbit_.newton_iterations, passages = orbit_.passages;
  for (int until = kFirst; until <= kMost && follow(until - periods, z); until *= kLonger) {
    passages += until - periods;
    periods = until;
    orbit_.z = z;
    closing.find(scale_, orbit_);
    newton_iterations += orbit_.newton_iterations;
    passages += orbit_.passages;
    if (orbit_.residual <= ShootingOptions{}.good_enough) break;
  }
  orbit_.newton_iterations = newton_iterations;
  orbit_.passages = passages;
  if (integrator_.work().is_over()) {
    orbit_.reason = periodic::kSearchIsLong;
  } else if (!(orbit_.residual <= ShootingOptions{}.good_enough)) {
    orbit_.reason = "the motion from rest has not settled after " + std::to_string(periods) +
                    " periods; its last passage: " + orbit_.reason;
  }
}

// Moves z on from phase 0 over so many periods. False where it does not get there.
bool SmoothSolver::follow(int periods, Eigen::VectorXd& z) {
  constexpr int kAtOnce = 8;
  for (int left = periods; left > 0; left -= kAtOnce) {
    scale_around(z);
    if (!integrator_.follow(z, 0.0, std::min(left, kAtOnce) * equation_.period(), scale_)) return false;
  }
  scale_around(z);
  return true;
}

void SmoothSolver::scale_around(const Eigen::VectorXd& z) {
  const Eigen::Index n = equation_.masses();
  scale_ = equation_.scale(z.head(n).cwiseAbs().maxCoeff(), z.segment(n, n).cwiseAbs().maxCoeff());
}

// The exact orbit at the instant at which all contacts slide fastest, each relative to its own maximum: there
// the smooth orbit is nearest, and its motion least sensitive. False if the exact law has no orbit.
bool SmoothSolver::guess_from_exact_law() {
  if (!exact_) return false;
  const Status status = exact_->solve().status;
  if (status != Status::ok && status != Status::grazing) return false;
  constexpr Eigen::Index kSamples = 64;
  const History history =
      exact_->history(periodic::phases_of_a_period(kSamples + 1), periodic::SliderForces::summed);
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
    speeds.col(i) = equation_.arguments(history.time[sample], states.col(i)).cwiseAbs();
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
  scale_ =
      equation_.scale(states.topRows(n).cwiseAbs().maxCoeff(), states.middleRows(n, n).cwiseAbs().maxCoeff());
  return true;
}

void SmoothSolver::guess_equivalent_response() {
  orbit_.section = 0.0;
  orbit_.z =
      equivalent_start(equation_, Equivalents::from_rest).value_or(Eigen::VectorXd::Zero(equation_.size()));
  scale_around(orbit_.z);
}

// The orbit at omega t = phase.
void SmoothSolver::state_at(double phase, Eigen::VectorXd& z) const {
  const periodic::PlaceOnOrbit place =
      periodic::place_on_orbit(phase, reported_system().omega * orbit_.section, orbit_.half_period);
  const double t = orbit_.section + place.from_section / reported_system().omega;
  const Trajectory& trajectory = orbit_.passage.trajectory;
  trajectory.state(trajectory.step_at(t), t, z);
  z *= place.sign;
}

History SmoothSolver::history(std::span<const double> phases, periodic::SliderForces) {
  const Network& network = assembly_.network();
  const Forms forms(assembly_, equation_);
  History result = History::of(network);
  std::vector<Form> element_forces;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    element_forces.push_back(forms.element_force(e, system_.coefficients[e]));
  }
  std::vector<Form> of_signals;
  for (const mechanics::Incidence& at : mechanics::incidences_beyond_masses(network))
    of_signals.insert(of_signals.end(), {forms.displacement(at), forms.velocity(at), forms.acceleration(at)});
  Instant instant;
  Eigen::VectorXd z;
  for (const double phase : phases) {
    state_at(phase, z);
    equation_.look(phase / reported_system().omega, z, instant);
    result.time.push_back(phase / reported_system().omega);
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

std::unique_ptr<periodic::ResponseSolver> make_solver(const Network& network,
                                                      const std::vector<Quantity>& quantities,
                                                      const periodic::OrbitsWanted& wanted) {
  return std::make_unique<SmoothSolver>(network, quantities, wanted);
}

}  // namespace frahm::smooth
