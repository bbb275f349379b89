#include "solvers/tuning/variance/variance.hpp"

#include <Eigen/LU>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "solvers/algebra/eigenvalues.hpp"
#include "solvers/tuning/variance/lyapunov.hpp"
#include "tests/solvers/known_optima.hpp"

// The mean square under white noise, against closed forms, a frequency integral and the known optima.
namespace frahm::tuning::variance_test {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace mechanics;
using std::numbers::pi;

constexpr double kExact = 1e-12;       // relative, of a mean square
constexpr double kIntegral = 1e-8;     // relative, of the quadrature over the frequency
constexpr double kGradient = 1e-7;     // relative, of central differences with steps of 1e-5
constexpr double kTuning = 1e-8;       // of f and zeta at an optimum
constexpr double kStationary = 1e-13;  // of d(ln mean square)/d(ln value)

const Node ground{}, base{NodeKind::prescribed, 0}, main_mass{NodeKind::mass, 0}, absorber{NodeKind::mass, 1};

NetworkValues numbers(std::vector<double> mass, std::vector<double> element,
                      std::vector<double> second = {}) {
  NetworkValues values;
  values.mass = std::move(mass);
  values.element = std::move(element);
  values.second = std::move(second);
  return values;
}

// Derivatives by the absorber's spring and damper.
NetworkValues direction(double k, double c) {
  return numbers({}, {0.0, k, c, 0.0});
}

TEST_CASE("one mass under white noise has the variance pi S0 / (c k), or pi S0 m^2 / (c k) of its base") {
  // Integral over all omega of S0 / |k - m omega^2 + i c omega|^2.
  const double m = 3.0, c = 0.7, k = 110.0, intensity = 0.25;
  const NetworkValues values = numbers({m}, {k, c});
  const Network fixed{.masses = {"x"},
                      .elements = {{"spring", ElementType::spring, ground, main_mass},
                                   {"damper", ElementType::damper, ground, main_mass}}};
  const Variance of_force(fixed, {NoiseKind::force_on, 0, intensity}, {});
  CHECK_THAT(of_force.mean_square(values), WithinRel(pi * intensity / (c * k), kExact));

  Network moved = fixed;
  moved.prescribed = {"base"};
  for (Element& element : moved.elements) element.along[0].node = base;
  const Variance of_base(moved, {NoiseKind::acceleration_of, 0, intensity}, {NoisyKind::stroke, 0});
  CHECK_THAT(of_base.mean_square(values), WithinRel(pi * intensity * m * m / (c * k), kExact));
}

TEST_CASE("one mass with modal damping has the variance of one with its damper, and its exact derivatives") {
  const double m = 3.0, k = 110.0, zeta = 0.04, intensity = 0.25, c = 2.0 * zeta * std::sqrt(k * m);
  Network network{.masses = {"x"},
                  .prescribed = {"base"},
                  .elements = {{"spring", ElementType::spring, base, main_mass}}};
  network.damping = mechanics::DampingModel::modal;
  NetworkValues values = numbers({m}, {k}, {0.0});
  values.damping = {zeta};
  const Variance of_base(network, {NoiseKind::acceleration_of, 0, intensity}, {NoisyKind::stroke, 0});
  std::vector<NetworkValues> directions(3, numbers({0.0}, {0.0}, {0.0}));
  for (NetworkValues& each : directions) each.damping = {0.0};
  directions[0].mass[0] = directions[1].element[0] = directions[2].damping[0] = 1.0;
  std::array<double, 3> slopes{};
  const double variance = of_base.mean_square(values, directions, slopes);
  // pi S0 m^2 / (c k) = pi S0 m^(3/2) / (2 zeta k^(3/2))
  CHECK_THAT(variance, WithinRel(pi * intensity * m * m / (c * k), kExact));
  CHECK_THAT(slopes[0], WithinRel(1.5 * variance / m, kExact));
  CHECK_THAT(slopes[1], WithinRel(-1.5 * variance / k, kExact));
  CHECK_THAT(slopes[2], WithinRel(-variance / zeta, kExact));
}

// Main mass on a spring, absorber with spring, damper and inerter; the inerter and the main spring stand on
// `support`. Order of the elements: K, k, c, b.
Network tuned_mass_damper(const Node& support) {
  return {.masses = {"main", "absorber"},
          .prescribed = {"base"},
          .elements = {{"suspension", ElementType::spring, support, main_mass},
                       {"spring", ElementType::spring, main_mass, absorber},
                       {"damper", ElementType::damper, main_mass, absorber},
                       {"inerter", ElementType::inerter, support, absorber}}};
}

// With M = K = 1, mass ratio mu and inertance ratio beta: f = sqrt(k/(m + b)) / sqrt(K/M), zeta = c/(2 (m +
// b) omega_a).
NetworkValues tmd_values(double mu, double beta, double f, double zeta) {
  const double inertia = mu + beta;
  return numbers({1.0, mu}, {1.0, inertia * f * f, 2.0 * zeta * inertia * f, beta});
}

struct Tuning {
  double f, zeta;
};

// Force on the primary, mu -> mu + beta for an inerter to the ground.
Tuning optimum_for_force(double mu) {
  return {std::sqrt((2.0 + mu) / 2.0) / (1.0 + mu),
          std::sqrt(mu * (4.0 + 3.0 * mu) / (8.0 * (1.0 + mu) * (2.0 + mu)))};
}

// Acceleration of the support, on which the inerter stands.
Tuning optimum_for_support(double mu, double beta) {
  const double a = beta * (1.0 - mu) + (2.0 - mu) * (1.0 + mu),
               b = beta * (3.0 - mu) + (4.0 - mu) * (1.0 + mu);
  return {std::sqrt(a / (2.0 * (1.0 + mu))) / (1.0 + beta + mu),
          0.5 * std::sqrt(beta + mu) * std::sqrt(b / (2.0 * (1.0 + beta + mu) * a))};
}

struct Case {
  const char* name;
  Network network;
  Noise noise;
  double mu, beta;
  Tuning known;
};

std::vector<Case> known_optima() {
  std::vector<Case> cases;
  for (const auto& [mu, beta] : {std::pair{0.01, 0.0}, {0.05, 0.0}, {0.2, 0.0}, {0.05, 0.03}, {0.02, 0.5}}) {
    cases.push_back({"force on the main mass",
                     tuned_mass_damper(ground),
                     {NoiseKind::force_on, 0},
                     mu,
                     beta,
                     optimum_for_force(mu + beta)});
    cases.push_back({"acceleration of the base",
                     tuned_mass_damper(base),
                     {NoiseKind::acceleration_of, 0},
                     mu,
                     beta,
                     optimum_for_support(mu, beta)});
  }
  return cases;
}

// d(ln mean square)/d(ln k) and /d(ln c) of the absorber.
std::array<double, 2> relative_slopes(const Case& at, const Tuning& tuning) {
  const NetworkValues values = tmd_values(at.mu, at.beta, tuning.f, tuning.zeta);
  const std::vector<NetworkValues> directions{direction(values.element[1], 0.0),
                                              direction(0.0, values.element[2])};
  std::array<double, 2> slopes{};
  const double value = Variance(at.network, at.noise, {}).mean_square(values, directions, slopes);
  return {slopes[0] / value, slopes[1] / value};
}

TEST_CASE("the known optima of an absorber under white noise are stationary") {
  for (const Case& at : known_optima()) {
    INFO(at.name << ", mu " << at.mu << ", beta " << at.beta);
    for (const double slope : relative_slopes(at, at.known)) CHECK_THAT(slope, WithinAbs(0.0, kStationary));
    // The test sees an error of the formulas: a tuning off by 1e-6 is not stationary.
    const auto off = relative_slopes(at, {at.known.f * (1.0 + 1e-6), at.known.zeta});
    CHECK(std::abs(off[0]) > 100.0 * kStationary);
  }
}

// The root mean square over ln f and ln zeta. (x, not values: the optimum is to be found from far away.)
class AbsorberTuning : public Problem {
 public:
  AbsorberTuning(const Case& at, double f, double zeta) : at_(at), variance_(at.network, at.noise, {}) {
    variables = {
        {.name = "ln_f", .lower = std::log(0.05), .upper = std::log(5.0), .start = std::log(f)},
        {.name = "ln_zeta", .lower = std::log(1e-3), .upper = std::log(5.0), .start = std::log(zeta)}};
    objective_scale = objective(std::vector{variables[0].start, variables[1].start}, {});
  }

  double objective(std::span<const double> x, std::span<double> gradient) override {
    const double f = std::exp(x[0]), zeta = std::exp(x[1]);
    const NetworkValues values = tmd_values(at_.mu, at_.beta, f, zeta);
    const double k = values.element[1], c = values.element[2];
    const std::vector<NetworkValues> directions{direction(2.0 * k, c), direction(0.0, c)};
    std::array<double, 2> slopes{};
    const double rms = std::sqrt(variance_.mean_square(values, directions, slopes));
    for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] = slopes[i] / (2.0 * rms);
    return rms;
  }
  void constrain(std::span<const double>, std::span<double>, std::span<double>) override {}

 private:
  Case at_;
  Variance variance_;
};

TEST_CASE("both solvers tune the absorber to the known optima from poor starts") {
  for (const Case& at : known_optima()) {
    for (const auto& [f, zeta] : {Tuning{0.3, 1.5}, Tuning{2.5, 0.02}, Tuning{1.2, 3.0}}) {
      for (const SolverKind solver : {SolverKind::ipopt, SolverKind::slsqp}) {
        INFO(at.name << ", mu " << at.mu << ", beta " << at.beta << ", from " << f << ", " << zeta << " by "
                     << name(solver));
        AbsorberTuning problem(at, f, zeta);
        const SolverOptions options{.tolerance = 1e-10};
        const Solution solution = solve(problem, solver, options);
        INFO(name(solution.ending) << " " << solution.kkt_residual);
        CHECK(solution.ending <= Ending::acceptable);
        CHECK_THAT(std::exp(solution.x[0]), WithinAbs(at.known.f, kTuning));
        CHECK_THAT(std::exp(solution.x[1]), WithinAbs(at.known.zeta, kTuning));
      }
    }
  }
}

// Three masses with every linear element, Maxwell elements and an inerter to the ground.
Network every_element() {
  const Node third{NodeKind::mass, 2};
  return {.masses = {"a", "b", "c"},
          .prescribed = {"base"},
          .elements = {{"k1", ElementType::spring, base, main_mass},
                       {"k2", ElementType::spring, main_mass, absorber},
                       {"k3", ElementType::spring, third, absorber},
                       {"c1", ElementType::damper, base, main_mass},
                       {"c2", ElementType::damper, absorber, third},
                       {"b1", ElementType::inerter, main_mass, third},
                       {"b2", ElementType::inerter, ground, absorber},
                       {"b3", ElementType::inerter, third, base},
                       {"m1", ElementType::maxwell, main_mass, absorber},
                       {"m2", ElementType::maxwell, third, base}}};
}

NetworkValues every_value() {
  return numbers({2.0, 0.7, 0.3}, {50.0, 9.0, 4.0, 0.8, 0.3, 0.2, 0.15, 0.4, 6.0, 11.0},
                 {0, 0, 0, 0, 0, 0, 0, 0, 0.9, 2.5});
}

// |u / w|^2 by the equation of motion at one frequency, in absolute coordinates with the base's displacement
// y = -w / omega^2: nothing of the state-space form enters.
double gain(const Network& network, const NetworkValues& values, const Noise& noise,
            const NoisyQuantity& measure, double omega) {
  using Complex = std::complex<double>;
  const Complex i_omega(0.0, omega);
  const Eigen::Index n = Eigen::Index(network.masses.size());
  Eigen::MatrixXcd dynamic = Eigen::MatrixXcd::Zero(n, n);
  Eigen::VectorXcd force = Eigen::VectorXcd::Zero(n);
  const bool moved = noise.kind == NoiseKind::acceleration_of;
  const Complex y = moved ? -1.0 / (omega * omega) : 0.0;
  for (Eigen::Index i = 0; i < n; ++i) dynamic(i, i) = -omega * omega * values.mass[std::size_t(i)];
  if (!moved) force[Eigen::Index(noise.node)] = 1.0;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const double value = values.element[e];
    Complex stiffness = value;
    if (network.elements[e].type == ElementType::damper) stiffness = i_omega * value;
    if (network.elements[e].type == ElementType::inerter) stiffness = -omega * omega * value;
    if (network.elements[e].type == ElementType::maxwell) {
      stiffness = 1.0 / (1.0 / value + 1.0 / (i_omega * values.second[e]));  // compliances in series
    }
    const auto at = mechanics::incidence(network, network.elements[e]);
    dynamic += stiffness * (at.w * at.w.transpose()).cast<Complex>();
    if (moved) force -= stiffness * y * at.p[0] * at.w.cast<Complex>();
  }
  const Eigen::VectorXcd q = dynamic.partialPivLu().solve(force);
  if (measure.kind == NoisyKind::displacement) return std::norm(q[Eigen::Index(measure.index)] - y);
  const auto at = mechanics::incidence(network, network.elements[measure.index]);
  return std::norm(at.w.cast<Complex>().dot(q) + (moved ? y * at.p[0] : Complex(0.0)));
}

// Integral of S0 |u/w|^2 over all omega = tan(angle): the trapezium rule, whose error falls exponentially for
// a smooth periodic integrand.
double integrate(const Network& network, const NetworkValues& values, const Noise& noise,
                 const NoisyQuantity& measure) {
  const int steps = 20000;
  const double unit = 3.0;  // rad/s, amid the resonances
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double angle = (k + 0.5) * 0.5 * pi / steps, omega = unit * std::tan(angle);
    sum += gain(network, values, noise, measure, omega) * unit / (std::cos(angle) * std::cos(angle));
  }
  return 2.0 * noise.intensity * sum * 0.5 * pi / steps;
}

std::vector<std::pair<Noise, NoisyQuantity>> every_question() {
  const Noise force{NoiseKind::force_on, 1, 0.3}, acceleration{NoiseKind::acceleration_of, 0, 1.7};
  return {{force, {NoisyKind::displacement, 0}},
          {force, {NoisyKind::stroke, 5}},
          {force, {NoisyKind::stroke, 6}},
          {force, {NoisyKind::stroke, 9}},
          {acceleration, {NoisyKind::displacement, 2}},
          {acceleration, {NoisyKind::stroke, 8}},
          {acceleration, {NoisyKind::stroke, 7}}};
}

TEST_CASE(
    "the mean square is the integral of the response over the frequency, of every element and quantity") {
  const Network network = every_element();
  const NetworkValues values = every_value();
  for (const auto& [noise, measure] : every_question()) {
    INFO("noise kind " << int(noise.kind) << ", measure kind " << int(measure.kind) << " of "
                       << measure.index);
    CHECK_THAT(Variance(network, noise, measure).mean_square(values),
               WithinRel(integrate(network, values, noise, measure), kIntegral));
  }
}

TEST_CASE("the gradient of the mean square is that of differences, by every value") {
  const Network network = every_element();
  const NetworkValues values = every_value();
  for (const auto& [noise, measure] : every_question()) {
    const Variance variance(network, noise, measure);
    std::vector<NetworkValues> directions;
    std::vector<double*> places;  // in `moved`, of each direction
    NetworkValues moved = values;
    const auto add = [&](std::vector<double> NetworkValues::*list, std::size_t index) {
      NetworkValues direction;
      (direction.*list).assign((values.*list).size(), 0.0);
      (direction.*list)[index] = (values.*list)[index];
      directions.push_back(direction);
      places.push_back(&(moved.*list)[index]);
    };
    for (std::size_t i = 0; i < 3; ++i) add(&NetworkValues::mass, i);
    for (std::size_t e = 0; e < 10; ++e) add(&NetworkValues::element, e);
    for (std::size_t e = 8; e < 10; ++e) add(&NetworkValues::second, e);
    std::vector<double> slopes(directions.size());
    const double value = variance.mean_square(values, directions, slopes);
    for (std::size_t k = 0; k < slopes.size(); ++k) {
      const double old = *places[k], step = 1e-5;
      *places[k] = old * (1.0 + step);
      const double above = variance.mean_square(moved);
      *places[k] = old * (1.0 - step);
      const double below = variance.mean_square(moved);
      *places[k] = old;
      INFO("noise kind " << int(noise.kind) << ", measure of " << measure.index << ", direction " << k);
      CHECK_THAT(slopes[k] / value, WithinAbs((above - below) / (2.0 * step * value), kGradient));
    }
  }
}

TEST_CASE("a Lyapunov equation is solved to rounding, and its adjoint agrees with it") {
  std::mt19937 generator(1892);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Index size = 1 + trial % 15;
    const auto random = [&](Eigen::Index columns) {
      return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(size, columns, [&] { return normal(generator); }));
    };
    Eigen::MatrixXd A = random(size);
    A -= (0.01 + algebra::eigenvalues(A).real().maxCoeff()) * Eigen::MatrixXd::Identity(size, size);
    const Lyapunov lyapunov(A);
    const Eigen::VectorXd B = random(1), h = random(1);
    const Eigen::MatrixXd P = lyapunov.solve(B * B.transpose()),
                          Q = lyapunov.solve_adjoint(h * h.transpose());
    INFO("size " << size);
    CHECK(lyapunov.abscissa() < 0.0);
    CHECK((A * P + P * A.transpose() + B * B.transpose()).norm() <= 1e-13 * A.norm() * P.norm());
    CHECK((A.transpose() * Q + Q * A + h * h.transpose()).norm() <= 1e-13 * A.norm() * Q.norm());
    // h^T P h = B^T Q B; a square of few significant parts is known to |h|^2 |P|.
    CHECK_THAT(h.dot(P * h) - B.dot(Q * B), WithinAbs(0.0, 1e-9 * h.squaredNorm() * P.norm()));
  }
}

TEST_CASE("a variance that is infinite, or of no linear system, is refused by name") {
  const Noise force{NoiseKind::force_on, 0}, acceleration{NoiseKind::acceleration_of, 0};
  const Network standing = tuned_mass_damper(ground), moved = tuned_mass_damper(base);
  CHECK_THROWS_WITH(Variance(standing, acceleration, {}),
                    Contains("'suspension'") && Contains("'base' drifts"));
  Network partly = moved;
  partly.elements[3].along[0].node = ground;  // the inerter alone may stand on the ground
  CHECK_NOTHROW(Variance(partly, acceleration, {}).mean_square(tmd_values(0.1, 0.1, 0.9, 0.1)));
  CHECK_THROWS_WITH(Variance(partly, acceleration, {NoisyKind::stroke, 3}), Contains("'inerter'"));
  CHECK_THROWS_WITH(Variance(moved, force, {}).mean_square(tmd_values(0.1, 0.0, 0.9, 0.0)),
                    Contains("not damped"));
  for (const ElementType type : {ElementType::coulomb, ElementType::hysteretic}) {
    Network refused = moved;
    refused.elements.push_back({"guide", type, main_mass, absorber});
    CHECK_THROWS_WITH(Variance(refused, force, {}), Contains("'guide' is "));
  }
  CHECK_THROWS_AS(Variance(moved, {NoiseKind::force_on, 0, 0.0}, {}), MechanicsError);
}

}  // namespace
}  // namespace frahm::tuning::variance_test
