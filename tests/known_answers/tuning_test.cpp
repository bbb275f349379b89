// Tuned designs against closed forms: the classical damper, with and without an inerter to the ground.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <random>

#include "solvers/tuning/optimum.hpp"
#include "tests/known_answers/nishihara_asami.hpp"

namespace tuning_test {
namespace {

using namespace frahm;
using tuning::Optimum;
using tuning::Task;

constexpr double tolerance = 1e-6;           // of f, zeta and the peak, as promised
constexpr double closed_form_error = 1e-12;  // of the reference itself

// |X| of the main mass by hand: (K + i w C - w^2 M) X = (1, 0).
double magnification(double mu, double beta, double f, double zeta, double w) {
  const double ma = mu + beta, k = ma * f * f, c = 2.0 * zeta * ma * f;
  const std::complex<double> s(0.0, w), link = k + s * c;
  const std::complex<double> a = 1.0 - w * w + link, d = -ma * w * w + link;
  return std::abs(d / (a * d - link * link));
}

double worst_magnification(double mu, double beta, double f, double zeta) {
  double worst = 0.0;
  for (int i = 0; i <= 200000; ++i)
    worst = std::max(worst, magnification(mu, beta, f, zeta, 0.3 + 1.7e0 * i / 200000));
  return worst;
}

// Main mass 1 on a spring of 1 under a force of 1; absorber mass mu with an inerter beta to the ground.
Task absorber(double mu, double beta) {
  Task task;
  mechanics::Network& network = task.network;
  using mechanics::ElementType;
  const mechanics::Node ground{}, main{mechanics::NodeKind::mass, 0}, tmd{mechanics::NodeKind::mass, 1};
  network.masses = {"main", "tmd"};
  network.elements = {{"main_spring", ElementType::spring, ground, main},
                      {"tmd_spring", ElementType::spring, main, tmd},
                      {"tmd_damper", ElementType::damper, main, tmd},
                      {"inerter", ElementType::inerter, ground, tmd}};
  network.excitations = {{mechanics::ExcitationKind::force, 0}};
  const double ma = mu + beta;
  task.network_at = [=](std::size_t, std::span<const double> at, mechanics::NetworkValues& values,
                        std::vector<mechanics::NetworkValues>* derivatives) {
    const double f = at[0], zeta = at[1];
    values = {.omega = at[2],
              .mass = {1.0, mu},
              .element = {1.0, ma * f * f, 2.0 * zeta * ma * f, beta},
              .excitation = {{1.0, 0.0, 0.0}}};
    if (!derivatives) return;
    mechanics::NetworkValues zero{
        .omega = 0.0, .mass = {0, 0}, .element = {0, 0, 0, 0}, .excitation = {{0.0, 0.0, 0.0}}};
    derivatives->assign(3, zero);
    (*derivatives)[0].element = {0.0, 2.0 * ma * f, 2.0 * zeta * ma, 0.0};
    (*derivatives)[1].element = {0.0, 0.0, 2.0 * ma * f, 0.0};
    (*derivatives)[2].omega = 1.0;
  };
  task.scenarios = {"study"};
  task.parameters = {{"f", 0.3, 1.5, 0.8, {}}, {"zeta", 1e-3, 1.0, 0.3, {}}};
  task.band = {0.3, 2.0};
  task.quantity = {periodic::Measure::peak, 0};
  return task;
}

Optimum tuned(const Task& task, std::size_t start = 0) {
  return tuning::tune(task, start, [] { return false; }).at(0);
}

const double mass_ratios[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5};

TEST_CASE("the closed form of Nishihara and Asami is a minimum of the worst magnification") {
  for (const double mu : mass_ratios) {
    const AbsorberOptimum form = nishihara_asami(mu);
    INFO("mu = " << mu);
    const double worst = worst_magnification(mu, 0.0, form.f, form.zeta);
    CHECK(worst == Approx(form.peak).epsilon(1e-8));  // sampled at 200,000 places
    for (const double step : {-1e-3, 1e-3}) {
      CHECK(worst_magnification(mu, 0.0, form.f * (1.0 + step), form.zeta) > worst);
      CHECK(worst_magnification(mu, 0.0, form.f, form.zeta * (1.0 + step)) >
            worst * (1.0 - closed_form_error));
    }
  }
}

TEST_CASE("the classical damper is tuned to the exact H-infinity optimum at six mass ratios from poor starts",
          "[slow]") {
  for (const double mu : mass_ratios) {
    const AbsorberOptimum form = nishihara_asami(mu);
    for (const std::size_t start : {0, 1, 2, 3}) {
      INFO("mu = " << mu << ", start " << start);
      const Optimum optimum = tuned(absorber(mu, 0.0), start);
      INFO(optimum.reason << ", gap " << optimum.certificate_gap << ", KKT " << optimum.kkt_residual << ", "
                          << optimum.rounds.size() << " rounds, " << optimum.iterations << " iterations, "
                          << optimum.orbits << " orbits");
      CHECK(optimum.outcome == tuning::Outcome::converged);
      CHECK(optimum.parameters[0].value[0] == Approx(form.f).epsilon(tolerance));
      CHECK(optimum.parameters[1].value[0] == Approx(form.zeta).epsilon(tolerance));
      CHECK(optimum.objective == Approx(form.peak).epsilon(tolerance));
    }
  }
}

// Mass ratios from 0.005 to 0.5, starts from f = 0.5 to 1.5 and zeta = 0.005 to 0.6, every other one with an
// inerter to the ground; from the start as given with either solver, and from a map.
void check_drawn_absorbers(int count) {
  std::mt19937 random(1909);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  for (int i = 0; i < count; ++i) {
    const double mu = between(0.005, 0.5), beta = i % 2 == 0 ? 0.0 : between(0.0, 0.3);
    Task task = absorber(mu, beta);
    task.parameters[0].nominal = between(0.5, 1.5);
    task.parameters[1].nominal = between(0.005, 0.6);
    task.solver = i % 3 == 0 ? tuning::SolverKind::ipopt : tuning::SolverKind::slsqp;
    if (i % 3 == 2) task.start = tuning::Start::map;
    const Optimum optimum = tuned(task);
    INFO("mu = " << mu << ", beta = " << beta << ", from f = " << task.parameters[0].nominal
                 << ", zeta = " << task.parameters[1].nominal << ": " << optimum.reason);
    CHECK(optimum.outcome == tuning::Outcome::converged);
    CHECK(optimum.certificate_gap >= 0.0);
    CHECK(optimum.objective == Approx(nishihara_asami(mu + beta).peak).epsilon(tolerance));
  }
}

TEST_CASE("absorbers drawn at random end at the closed form, from wherever they start") {
  check_drawn_absorbers(15);
}

// Ten seconds: test_known_answers "[thorough]".
TEST_CASE("So do 200", "[.thorough]") {
  check_drawn_absorbers(200);
}

TEST_CASE("an inerter from the absorber to the ground counts as absorber mass") {
  for (const double beta : {0.01, 0.1, 0.3}) {
    const double mu = 0.05;
    const AbsorberOptimum form = nishihara_asami(mu + beta);
    INFO("beta = " << beta);
    const Optimum optimum = tuned(absorber(mu, beta));
    CHECK(optimum.parameters[0].value[0] == Approx(form.f).epsilon(tolerance));
    CHECK(optimum.parameters[1].value[0] == Approx(form.zeta).epsilon(tolerance));
    CHECK(optimum.objective == Approx(form.peak).epsilon(tolerance));
  }
}

TEST_CASE("both peaks hold the optimum, and their shares make up the whole") {
  const Optimum optimum = tuned(absorber(0.05, 0.0));
  REQUIRE(optimum.peaks.size() == 2);
  CHECK(optimum.peaks[0].value == Approx(optimum.peaks[1].value).epsilon(tolerance));
  CHECK(optimum.peaks[0].multiplier + optimum.peaks[1].multiplier == Approx(1.0).epsilon(tolerance));
  // KKT: the shares balance the sensitivities of the peaks.
  for (std::size_t p = 0; p < 2; ++p) {
    const double balance = optimum.peaks[0].multiplier * optimum.peaks[0].sensitivity[p] +
                           optimum.peaks[1].multiplier * optimum.peaks[1].sensitivity[p];
    CHECK(std::abs(balance) < 1e-5 * optimum.objective);
  }
}

// The absorber next to a pendulum of mass 1e-4 and damping ratio zeta_p on the main mass, tuned to 0.9 where
// the absorber leaves a valley: a peak 2 zeta_p wide.
Task with_pendulum(double zeta_p) {
  Task task = absorber(0.05, 0.0);
  using mechanics::ElementType;
  const mechanics::Node main{mechanics::NodeKind::mass, 0}, pendulum{mechanics::NodeKind::mass, 2};
  task.network.masses.push_back("pendulum");
  task.network.elements.push_back({"pendulum_spring", ElementType::spring, main, pendulum});
  task.network.elements.push_back({"pendulum_damper", ElementType::damper, main, pendulum});
  const tuning::NetworkAt two_masses = task.network_at;
  task.network_at = [=](std::size_t scenario, std::span<const double> at, mechanics::NetworkValues& values,
                        std::vector<mechanics::NetworkValues>* derivatives) {
    constexpr double m = 1e-4, w = 0.97;
    two_masses(scenario, at, values, derivatives);
    values.mass.push_back(m);
    values.element.insert(values.element.end(), {m * w * w, 2.0 * zeta_p * m * w});
    if (!derivatives) return;
    for (mechanics::NetworkValues& d : *derivatives) {
      d.mass.push_back(0.0);
      d.element.insert(d.element.end(), {0.0, 0.0});
    }
  };
  task.quantity = {periodic::Measure::peak, 2};  // of the pendulum itself
  return task;
}

// |X| of the pendulum: its own transmissibility times the main mass's response with it on board.
double pendulum_response(double zeta_p, double f, double zeta, double w) {
  constexpr double m = 1e-4, own = 0.97, mu = 0.05;
  const std::complex<double> s(0.0, w);
  const std::complex<double> link = mu * f * f + 2.0 * zeta * mu * f * s,
                             p = m * own * own + 2.0 * zeta_p * m * own * s;
  const std::complex<double> absorber_mass = -mu * w * w, pendulum_mass = -m * w * w;
  // Each hung mass acts on the main one as the stiffness link * inertia / (link + inertia).
  const std::complex<double> main = 1.0 / (1.0 - w * w + link * absorber_mass / (link + absorber_mass) +
                                           p * pendulum_mass / (p + pendulum_mass));
  return std::abs(main * p / (p + pendulum_mass));
}

TEST_CASE("no peak hides: one a hundred-thousandth of the band wide is found, pressed down and certified") {
  for (const double zeta_p : {1e-3, 1e-5}) {
    INFO("damping ratio of the pendulum " << zeta_p);
    const Optimum optimum = tuned(with_pendulum(zeta_p));
    CHECK(optimum.outcome == tuning::Outcome::converged);
    const double f = optimum.parameters[0].value[0], zeta = optimum.parameters[1].value[0];
    double seen = 0.0;  // 20,000 even places, and as many about the pendulum's own frequency
    for (int i = 0; i <= 20000; ++i) {
      seen = std::max(seen, pendulum_response(zeta_p, f, zeta, 0.3 + 1.7 * i / 20000));
      seen = std::max(seen, pendulum_response(zeta_p, f, zeta, 0.97 * (1.0 + 0.01 * (i - 10000) / 10000)));
      seen = std::max(seen,
                      pendulum_response(zeta_p, f, zeta, 0.97 * (1.0 + 20.0 * zeta_p * (i - 10000) / 10000)));
    }
    CHECK(seen <= optimum.objective * (1.0 + 1e-9));
    CHECK(seen >= optimum.objective * (1.0 - 1e-2));  // the claim is no more than what is there
    CHECK(std::abs(optimum.certificate_gap) < 1e-5);
  }
}

TEST_CASE("limits that no design meets, and a resonance that nothing bounds, are said to be so", "[slow]") {
  Task narrow = absorber(0.05, 0.0);
  narrow.limits.push_back({"stroke", {periodic::Measure::stroke, 1}, -1.0, 0.01, {}});
  narrow.limits.back().lower = -std::numeric_limits<double>::infinity();
  const Optimum infeasible = tuned(narrow);
  CHECK(infeasible.outcome == tuning::Outcome::infeasible);
  CHECK(infeasible.violation > 0.0);
  CHECK(infeasible.parameters.at(0).value.size() == 1);
  CHECK(infeasible.limits.at(0).excess > 0.0);
  CHECK(std::isnan(infeasible.limits.at(0).multiplier));

  Task undamped = absorber(0.05, 0.0);
  undamped.parameters = {{"f", 0.9, 1.1, 1.0, {}}, {"zeta", 0.0, 0.0, 0.0, {}}};
  const Optimum unbounded = tuned(undamped);
  CHECK(unbounded.outcome == tuning::Outcome::unbounded);
  CHECK(unbounded.reason.find("bound") != std::string::npos);
  CHECK(std::isnan(unbounded.parameters.at(0).lower_multiplier.at(0)));
}

TEST_CASE("a schedule meets a limit that no constants do", "[slow]") {
  // No constants bring the main mass below 6.4.
  Task task = absorber(0.05, 0.0);
  task.quantity = {periodic::Measure::stroke, 1};
  task.limits.push_back(
      {"peak", {periodic::Measure::peak, 0}, -std::numeric_limits<double>::infinity(), 5.0, {}});
  tuning::Schedule schedule{{}, 3.0};
  for (int k = 0; k <= 34; ++k) schedule.knots.push_back(0.3 + 0.05 * k);
  schedule.knots.back() = 2.0;
  task.parameters[0].schedule = schedule;
  const Optimum optimum = tuned(task);
  INFO(optimum.reason << ", constants " << optimum.constant_objective);
  CHECK(optimum.violation <= 1e-6);
  CHECK(optimum.limits[0].value <= 5.0 * (1.0 + 1e-6));
}

TEST_CASE("a limit's multiplier is what relaxing it gives") {
  const auto limited = [](double most) {
    Task task = absorber(0.05, 0.0);
    task.limits.push_back(
        {"stroke", {periodic::Measure::stroke, 1}, -std::numeric_limits<double>::infinity(), most, {}});
    return tuned(task);
  };
  // At the main mass's own frequency the stroke is (1 + mu)/mu = 21 whatever the absorber: a limit above
  // that.
  const double most = 0.5 * (21.0 + limited(1e6).limits[0].value), step = 1e-3;
  const Optimum optimum = limited(most);
  REQUIRE(optimum.limits[0].multiplier > 0.0);
  CHECK(optimum.limits[0].excess == 0.0);
  CHECK(optimum.limits[0].value == Approx(most).epsilon(1e-8));
  const double slope = (limited(most + step).objective - limited(most - step).objective) / (2.0 * step);
  CHECK(-slope == Approx(optimum.limits[0].multiplier).epsilon(1e-3));  // of a difference
}

TEST_CASE("an optimum is the same to the last bit however often it is sought") {
  const Optimum one = tuned(absorber(0.1, 0.0), 5), two = tuned(absorber(0.1, 0.0), 5);
  CHECK(one.parameters[0].value == two.parameters[0].value);
  CHECK(one.parameters[1].value == two.parameters[1].value);
  CHECK(one.objective == two.objective);
}

}  // namespace
}  // namespace tuning_test
