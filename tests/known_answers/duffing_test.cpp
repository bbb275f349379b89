#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "solvers/smooth/integrator.hpp"
#include "tests/known_answers/responses.hpp"

// A spring with a cubic part (Duffing): x'' + c x' + x + a x^3 = P cos(r tau).
namespace frahm::periodic::duffing_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
using std::numbers::pi;
constexpr double kPeriod = 1e-10;        // of a free vibration over one period, relative to its amplitude
constexpr double kBalanced = 1e-8;       // of peaks by harmonic balance, relative
constexpr double kLinear = 1e-10;        // of the linear response
constexpr double kEnergyBalance = 1e-8;  // of the integration

const Node ground{}, mass{NodeKind::mass, 0};

Network duffing() {
  Network network{.masses = {"x"},
                  .elements = {{"spring", ElementType::spring, ground, mass},
                               {"damper", ElementType::damper, ground, mass}},
                  .excitations = {{ExcitationKind::force, 0, 1}}};
  network.elements[0].law = ForceLaw::cubic;
  return network;
}

struct Duffing {
  double r, c, a, P;
};

NetworkValues values_of(const Duffing& of) {
  return {.omega = of.r,
          .mass = {1.0},
          .element = {1.0, of.c},
          .excitation = {{of.P, 0.0}},
          .smooth = {{.cubic = of.a}, {}}};
}

// One orbit by harmonic balance with odd orders up to 2 H - 1: Newton's method on the coefficients, whose
// residual is projected from samples.
class HarmonicBalance {
 public:
  HarmonicBalance(const Duffing& of, double first_amplitude) : of_(of) {
    for (int j = 0; j < kSamples; ++j) {
      const double theta = 2.0 * pi * j / kSamples;
      for (int h = 0; h < kHarmonics; ++h) {
        const double n = 2 * h + 1, w = n * of.r;
        x_.block<1, 2>(j, 2 * h) << std::cos(n * theta), std::sin(n * theta);
        v_.block<1, 2>(j, 2 * h) << -w * std::sin(n * theta), w * std::cos(n * theta);
      }
      force_[j] = of.P * std::cos(theta);
    }
    solve(first_amplitude);
  }

  double residual() const { return residual_; }
  double peak() const {
    const auto value = [&](double theta, int derivative) {
      double sum = 0.0;
      for (int h = 0; h < kHarmonics; ++h) {
        const double n = 2 * h + 1, phase = n * theta + 0.5 * pi * derivative;
        sum += std::pow(n, derivative) * (q_[2 * h] * std::cos(phase) + q_[2 * h + 1] * std::sin(phase));
      }
      return sum;
    };
    Eigen::Index at = 0;
    (x_ * q_).cwiseAbs().maxCoeff(&at);
    double theta = 2.0 * pi * static_cast<double>(at) / kSamples;
    for (int i = 0; i < 20; ++i) theta -= value(theta, 1) / value(theta, 2);
    return std::abs(value(theta, 0));
  }

 private:
  static constexpr int kHarmonics = 24, kSamples = 512;

  // Steps along the response of the linear equation at rising cubic would leave one branch for another; the
  // first harmonic's amplitude says which.
  void solve(double first_amplitude) {
    q_.setZero(2 * kHarmonics);
    // A ((1 - r^2 + 3/4 a A^2) cos + c r sin) = P
    const double stiff = 1.0 - of_.r * of_.r + 0.75 * of_.a * first_amplitude * first_amplitude;
    const double lag = std::atan2(of_.c * of_.r, stiff);
    q_[0] = first_amplitude * std::cos(lag);
    q_[1] = first_amplitude * std::sin(lag);
    Eigen::VectorXd squares(2 * kHarmonics);
    for (int h = 0; h < kHarmonics; ++h)
      squares[2 * h] = squares[2 * h + 1] = std::pow((2 * h + 1) * of_.r, 2);
    for (int i = 0; i < 40; ++i) {
      const Eigen::VectorXd x = x_ * q_;
      const Eigen::VectorXd rest = of_.c * (v_ * q_) + x + of_.a * x.array().cube().matrix() - force_;
      const Eigen::VectorXd r = 2.0 / kSamples * x_.transpose() * rest - squares.cwiseProduct(q_);
      const Eigen::VectorXd slope = (1.0 + 3.0 * of_.a * x.array().square()).matrix();
      Eigen::MatrixXd J = 2.0 / kSamples * x_.transpose() * (of_.c * v_ + slope.asDiagonal() * x_);
      J.diagonal() -= squares;
      residual_ = r.norm();
      q_ -= J.partialPivLu().solve(r);
    }
  }

  Duffing of_;
  Eigen::MatrixXd x_{kSamples, 2 * kHarmonics}, v_{kSamples, 2 * kHarmonics};
  Eigen::VectorXd force_{kSamples}, q_;
  double residual_ = 0.0;
};

// x' = 0 at x = A: T = 4 K(m)/sqrt(1 + a A^2), m = a A^2/(2 (1 + a A^2)) (Abramowitz and Stegun, 17.3).
TEST_CASE("A free vibration on a cubic spring has the period of the elliptic integral") {
  const Network network = duffing();
  const Assembly assembly(network);
  for (const auto& [a, A] : {std::pair{1.0, 2.0}, std::pair{0.05, 1.0}, std::pair{-0.3, 1.2}}) {
    INFO("cubic " << a << ", amplitude " << A);
    const NetworkValues values = values_of({1.0, 0.0, a, 0.0});
    LinearSystem system;
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    smooth::Equation equation(assembly);
    equation.set(system, values);
    smooth::Integrator integrator(equation);
    const double stiff = 1.0 + a * A * A, m = 0.5 * a * A * A / stiff;
    // K of a negative parameter: K(m) = K(m/(m - 1))/sqrt(1 - m) (17.3.29).
    const double K = m >= 0.0 ? std::comp_ellint_1(std::sqrt(m))
                              : std::comp_ellint_1(std::sqrt(m / (m - 1.0))) / std::sqrt(1.0 - m);
    smooth::Passage passage;
    const Eigen::VectorXd start = Eigen::Vector2d(A, 0.0);
    integrator.pass(start, 0.0, 4.0 * K / std::sqrt(stiff), Eigen::Vector2d(A, A), passage);
    REQUIRE(passage.failure == nullptr);
    CHECK((passage.end - start).norm() < kPeriod * A);
  }
}

TEST_CASE("A cubic of zero leaves the linear response") {
  Responses response(duffing());
  for (const double r : {0.3, 0.9, 1.0, 1.7}) {
    REQUIRE(response.solve(values_of({r, 0.1, 0.0, 1.0})).status == Status::ok);
    CHECK_THAT(response["x_peak"], WithinRel(1.0 / std::hypot(1.0 - r * r, 0.1 * r), kLinear));
    CHECK(response["coexisting"] == 1.0);
  }
}

// For the first harmonic alone, 3/4 a A^3 + (1 - r^2) A = P cos(lag): amplitudes near the two stable orbits.
TEST_CASE("A hard spring has two stable orbits at one frequency, as harmonic balance has them") {
  const Duffing of{1.6, 0.1, 0.2, 1.0};
  const HarmonicBalance large(of, 3.3), small(of, 0.65);
  REQUIRE(large.residual() < 1e-12);
  REQUIRE(small.residual() < 1e-12);
  REQUIRE(large.peak() > 2.0 * small.peak());
  for (const auto show : {OrbitsWanted::Show::largest, OrbitsWanted::Show::smallest}) {
    const Network network = duffing();
    const std::vector<Quantity> quantities = {{Measure::peak, 0},
                                              {Measure::coexisting, 0},
                                              {Measure::period_multiple, 0},
                                              {Measure::energy_balance, 0},
                                              {Measure::energy, 0}};
    PeriodicResponse response(network, quantities, Path::fastest, {.starts = 8, .show = show});
    response.set_values(values_of(of));
    CHECK(response.solve().status == Status::several);
    std::vector<double> found(quantities.size());
    response.quantities(found);
    const double peak = show == OrbitsWanted::Show::largest ? large.peak() : small.peak();
    CHECK_THAT(found[0], WithinRel(peak, kBalanced));
    CHECK(found[1] == 2.0);
    CHECK(found[2] == 1.0);
    CHECK(found[3] < kEnergyBalance);
    CHECK(found[4] == 0.0);  // a spring dissipates nothing
    CHECK_THAT(response.gradient({}, {}), Catch::Contains("integrated"));
  }
}

TEST_CASE("Hard and soft springs have the peaks of harmonic balance, damped and undamped") {
  struct Point {
    Duffing of;
    double first_amplitude;
    int starts;  // undamped, a motion from elsewhere never comes to the orbit
  };
  for (const auto& [of, first, starts] :
       {Point{{0.7, 0.1, 0.5, 1.0}, 1.0, 4}, Point{{2.5, 0.1, 0.5, 1.0}, 0.2, 2},
        Point{{0.5, 0.2, -0.05, 0.3}, 0.4, 4}, Point{{3.0, 0.0, 0.5, 1.0}, 0.12, 1}}) {
    INFO("r " << of.r << ", c " << of.c << ", cubic " << of.a);
    const HarmonicBalance balance(of, first);
    REQUIRE(balance.residual() < 1e-12);
    PeriodicResponse response(duffing(), {{Measure::peak, 0}}, Path::fastest,
                              {.starts = starts, .most_multiple = 1, .show = OrbitsWanted::Show::smallest});
    response.set_values(values_of(of));
    REQUIRE(has_response(response.solve().status));
    double peak = 0.0;
    response.quantities({&peak, 1});
    CHECK_THAT(peak, WithinRel(balance.peak(), kBalanced));
  }
}

// A light reed that answers to a third of the frequency shows the orbit of three periods as its largest peak.
TEST_CASE("An orbit of three periods of the force is found and told as one", "[slow]") {
  const Node machine{NodeKind::mass, 1};
  Network network{.masses = {"reed", "machine"},
                  .elements = {{"spring", ElementType::spring, ground, machine},
                               {"damper", ElementType::damper, ground, machine},
                               {"leaf", ElementType::spring, machine, mass},
                               {"air", ElementType::damper, machine, mass}},
                  .excitations = {{ExcitationKind::force, 1, 1}}};
  network.elements[0].law = ForceLaw::cubic;
  const NetworkValues values{.omega = 6.0,
                             .mass = {1e-4, 1.0},
                             .element = {1.0, 0.04, 4e-4, 4e-6},
                             .excitation = {{8.0, 0.0}},
                             .smooth = {{.cubic = 1.0}, {}, {}, {}}};
  const std::vector<Quantity> quantities = {{Measure::coexisting, 0},
                                            {Measure::period_multiple, 0},
                                            {Measure::energy_balance, 0},
                                            {Measure::floquet_radius, 0},
                                            {Measure::peak, 1}};
  PeriodicResponse response(network, quantities, Path::fastest, {.starts = 6, .most_multiple = 3});
  response.set_values(values);
  CHECK(response.solve().status == Status::several);
  std::vector<double> found(quantities.size());
  response.quantities(found);
  CHECK(found[0] == 3.0);
  CHECK(found[1] == 3.0);
  CHECK(found[2] < kEnergyBalance);
  CHECK(found[3] < 1.0);
  // Its history goes through three periods, and the machine's largest displacement is met there.
  const History history = response.history(phases_of_a_period(721));
  CHECK_THAT(history.time.back(), WithinRel(3.0 * 2.0 * pi / values.omega, kLinear));
  double largest = 0.0;
  for (const double x : history.columns[2]) largest = std::max(largest, std::abs(x));
  CHECK_THAT(largest, WithinRel(found[4], 1e-4));  // by its samples
}

}  // namespace
}  // namespace frahm::periodic::duffing_test
