#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/smooth/friction_curve.hpp"
#include "tests/known_answers/responses.hpp"

// Chains of one to three masses on curves of friction that rise or fall, with and without dampers, at and
// next to their resonances, against a march from rest by the classical method of Runge and Kutta. Its steps
// are the same in every period: steps chosen by an error estimate miss bends of a curve at times, and the
// march never settles.
namespace frahm::periodic::random_curves_test {
namespace {

using namespace mechanics;
constexpr double kAgrees = 1e-6;   // of the state's size
constexpr double kSettled = 1e-9;  // the same: distance of the march from where it leads
constexpr double kStill = 1e-12;   // the same: a step of the rounding of the march
constexpr double kGrows =
    1.05;  // from the third to the last quarter of a march, in which a linear growth is 4/3

struct Drawn {
  Network network;
  NetworkValues values;
  bool rises = true, damped = false;
};

Drawn draw(unsigned trial) {
  std::mt19937 random(trial);
  const auto pick = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  const auto power = [&](double a, double b) { return std::pow(10.0, uniform(a, b)); };
  Drawn drawn;
  Network& network = drawn.network;
  NetworkValues& values = drawn.values;
  const int masses = 1 + pick(3);
  const auto node = [](int i) { return i < 0 ? Node{} : Node{NodeKind::mass, static_cast<std::size_t>(i)}; };
  const auto add = [&](const char* kind, ElementType type, int a, int b, double value, ForceLaw law) {
    network.elements.emplace_back(kind + std::to_string(network.elements.size()), type, node(a), node(b),
                                  law);
    values.element.push_back(value);
    values.smooth.emplace_back();
  };
  for (int i = 0; i < masses; ++i) {
    network.masses.push_back("m" + std::to_string(i));
    values.mass.push_back(uniform(0.3, 1.5));
    add("k", ElementType::spring, i - 1, i, uniform(0.5, 2.0), ForceLaw::exact);
  }
  drawn.damped = pick(2) == 0;
  if (drawn.damped)
    for (int i = 0; i < masses; ++i)
      add("c", ElementType::damper, i - 1, i, power(-1.5, -0.5), ForceLaw::exact);
  const double P = power(-1.0, 0.5);
  network.excitations.push_back({ExcitationKind::force, static_cast<std::size_t>(pick(masses)), 1});
  values.excitation.push_back({P, uniform(0.0, 6.0)});
  const int curves = std::max(masses, 1 + pick(2));  // one at each mass
  drawn.rises = pick(2) == 0;
  for (int c = 0; c < curves; ++c) {
    const int at = c % masses;
    add("f", ElementType::coulomb, pick(2) == 0 ? -1 : at - 1, at, 0.0, ForceLaw::stribeck);
    std::vector<CurvePoint>& curve = values.smooth.back().curve;
    curve.push_back({});
    std::vector<double> forces;
    const int points = 2 + pick(3);
    for (int i = 0; i < points; ++i) forces.push_back(P * power(-0.4, 0.4));
    std::sort(forces.begin(), forces.end());
    if (pick(3) == 0) forces.back() = forces[forces.size() - 2];
    if (!drawn.rises) std::reverse(forces.begin() + pick(points - 1), forces.end());
    double speed = 0.0;
    for (const double force : forces) curve.push_back({speed += P * power(-0.8, 0.3), force});
  }
  LinearSystem system;
  values.omega = 1.0;
  const Assembly assembly(network);
  assembly.set_values(values, system);
  const Eigen::VectorXd squares = algebra::symmetric_modes(system.K, system.M).values;
  const double natural = std::sqrt(squares[pick(masses)]);
  switch (pick(3)) {
    case 0:
      values.omega = natural;
      break;
    case 1:
      values.omega = natural * (1.0 + (pick(2) == 0 ? 1.0 : -1.0) * power(-6.0, -1.5));
      break;
    default:
      values.omega = natural * uniform(0.3, 2.0);
  }
  return drawn;
}

// The motion from rest, period by period.
class March {
 public:
  explicit March(const Drawn& drawn) : network_(drawn.network), values_(drawn.values) {
    for (const SmoothValue& each : values_.smooth)
      curves_.emplace_back(each.curve.empty() ? std::vector<CurvePoint>{{0, 0}, {1, 0}} : each.curve);
    state_.assign(2 * values_.mass.size(), 0.0);
    moved_ = state_;
    k_.fill(state_);
  }

  void pass_period() {
    constexpr int kFewest = 2000;
    constexpr double kLongest = 0.005;  // of the steepest curves and lightest masses drawn: h c/m < 2
    const double period = 2.0 * std::numbers::pi / values_.omega;
    const int count = std::max(kFewest, static_cast<int>(std::ceil(period / kLongest)));
    const double h = period / count;
    for (int i = 0; i < count; ++i) step(i * h, h);
  }
  const std::vector<double>& state() const { return state_; }

 private:
  void step(double t, double h) {
    rates(state_, k_[0], t);
    rates(moved(0.5 * h, k_[0]), k_[1], t + 0.5 * h);
    rates(moved(0.5 * h, k_[1]), k_[2], t + 0.5 * h);
    rates(moved(h, k_[2]), k_[3], t + h);
    for (std::size_t i = 0; i < state_.size(); ++i)
      state_[i] += h / 6.0 * (k_[0][i] + 2.0 * k_[1][i] + 2.0 * k_[2][i] + k_[3][i]);
  }

  const std::vector<double>& moved(double h, const std::vector<double>& rate) {
    for (std::size_t i = 0; i < state_.size(); ++i) moved_[i] = state_[i] + h * rate[i];
    return moved_;
  }

  void rates(const std::vector<double>& z, std::vector<double>& dz, double t) const {
    const std::size_t n = values_.mass.size();
    std::array<double, 3> force{};  // of up to three masses
    const auto [amplitude, phase, rod] = values_.excitation[0];
    force[network_.excitations[0].node] = amplitude * std::cos(values_.omega * t + phase);
    for (std::size_t e = 0; e < network_.elements.size(); ++e) {
      const Element& element = network_.elements[e];
      double u = 0.0, v = 0.0;
      for (const auto& [node, factor] : element.along) {
        if (node.kind != NodeKind::mass) continue;
        u += factor * z[node.index];
        v += factor * z[n + node.index];
      }
      const double own = element.type == ElementType::spring   ? values_.element[e] * u
                         : element.type == ElementType::damper ? values_.element[e] * v
                                                               : curves_[e].at(v).force;
      for (const auto& [node, factor] : element.along)
        if (node.kind == NodeKind::mass) force[node.index] -= factor * own;
    }
    for (std::size_t i = 0; i < n; ++i) {
      dz[i] = z[n + i];
      dz[n + i] = force[i] / values_.mass[i];
    }
  }

  const Network& network_;
  const NetworkValues& values_;
  std::vector<smooth::FrictionCurve> curves_;
  std::vector<double> state_, moved_;
  std::array<std::vector<double>, 4> k_;
};

double size_of(const std::vector<double>& z) {
  double most = 1e-12;
  for (const double each : z) most = std::max(most, std::abs(each));
  return most;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

enum class Outcome { settles, stays_bounded, grows };

// It settles where what is left of the way, by the slowest rate at which its steps have shrunk lately, is
// nothing.
Outcome march(March& motion, int periods) {
  constexpr std::size_t kLately = 12;  // periods, in which several modes take turns
  std::vector<double> steps;
  double third = 0.0, last = 0.0;
  for (int i = 0; i < periods; ++i) {
    const std::vector<double> from = motion.state();
    motion.pass_period();
    const double size = size_of(motion.state());
    steps.push_back(distance(from, motion.state()));
    if (steps.size() > 2 * kLately) {
      const double now = *std::max_element(steps.end() - kLately, steps.end());
      const double before = *std::max_element(steps.end() - 2 * kLately, steps.end() - kLately);
      const double left = now < before ? kLately * now / (1.0 - now / before) : HUGE_VAL;
      if (left < kSettled * size || now < kStill * size) return Outcome::settles;
    }
    if (4 * i >= 3 * periods)
      last = std::max(last, size);
    else if (4 * i >= 2 * periods)
      third = std::max(third, size);
  }
  return last > kGrows * third ? Outcome::grows : Outcome::stays_bounded;
}

struct Counts {
  int settled = 0, bounded = 0, growing = 0, compared = 0, several = 0, unbounded = 0, wrong = 0;
};

void compare(unsigned trial, int periods, Counts& counts) {
  const Drawn drawn = draw(trial);
  March motion(drawn);
  const Outcome outcome = march(motion, periods);
  Responses responses(drawn.network);
  const ResponseSummary& summary = responses.solve(drawn.values);
  INFO("network " << trial << (drawn.rises ? ", rising" : ", falling") << (drawn.damped ? ", damped" : "")
                  << ", masses " << drawn.network.masses.size() << ", omega " << drawn.values.omega
                  << ": status " << static_cast<int>(summary.status) << ' ' << summary.reason);
  counts.settled += outcome == Outcome::settles;
  counts.bounded += outcome == Outcome::stays_bounded;
  counts.growing += outcome == Outcome::grows;
  counts.unbounded += summary.status == Status::unbounded;
  counts.several += summary.status == Status::several;
  bool is_right = true;
  if (outcome != Outcome::grows) is_right = summary.status != Status::unbounded;
  if (outcome == Outcome::settles) {
    is_right = is_right && has_response(summary.status);
    if (is_right && summary.coexisting == 1) {
      const History history = responses.response().history(phases_of_a_period(2));
      const std::size_t n = drawn.network.masses.size();
      std::vector<double> found(2 * n);
      for (std::size_t i = 0; i < n; ++i) {
        found[i] = history.columns[2 * i][0];
        found[n + i] = history.columns[2 * i + 1][0];
      }
      ++counts.compared;
      is_right = distance(found, motion.state()) < kAgrees * size_of(found);
      INFO("off by " << distance(found, motion.state()) / size_of(found));
      CHECK(is_right);
    } else {
      CHECK(is_right);
    }
  } else {
    INFO((outcome == Outcome::grows ? "grows" : "stays bounded"));
    CHECK(is_right);
  }
  counts.wrong += !is_right;
}

Counts compare_all(unsigned first, unsigned count, int periods) {
  Counts counts;
  for (unsigned trial = first; trial < first + count; ++trial) compare(trial, periods, counts);
  return counts;
}

TEST_CASE("Random curves of friction have the responses to which a march from rest settles") {
  const Counts counts = compare_all(1, 20, 600);
  CHECK(counts.settled >= 18);
  CHECK(counts.compared >= 16);
}

TEST_CASE("So do 300 random systems with curves that rise and fall", "[long]") {
  const Counts counts = compare_all(1000, 300, 2000);
  WARN(counts.settled << " settle, " << counts.compared << " of them compared, " << counts.several
                      << " points with several responses, " << counts.bounded << " unsettled, "
                      << counts.growing << " growing, " << counts.unbounded << " told unbounded, "
                      << counts.wrong << " wrong");
  CHECK(counts.settled > 200);
}

}  // namespace
}  // namespace frahm::periodic::random_curves_test
