#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/transient/forced_motion.hpp"
#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/random_network.hpp"

// Motions under records against closed forms, and against the independent integration of the same record.
namespace frahm::transient::recorded_motion_test {
namespace {

using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::NetworkValues;
using mechanics::Node, mechanics::NodeKind;
using periodic::random_network, periodic::RandomNetwork;

constexpr double kIntegrated = 1e-9;  // of the peak; the reference's own error over dozens of events
constexpr double kRefined = 1e-12;    // of the peak
constexpr double kExact = 1e-12;

ForcedMotion motion_of(const Network& network, const NetworkValues& values,
                       std::vector<RecordedExcitation> records, double duration, int samples) {
  return forced_motion(
      network, [&](double) { return values; }, {},
      {.from = values.omega, .records = std::move(records), .duration = duration, .samples = samples});
}

double largest(const Samples& history) {
  double most = 0.0;
  for (const auto& mass : history.displacement)
    for (const double x : mass) most = std::max(most, std::abs(x));
  return most;
}

// One mass of 1 kg on a spring of 1 N/m; with a support, the spring ends there.
Network one_mass(ExcitationKind kind) {
  const bool is_force = kind == ExcitationKind::recorded_force;
  Network network{.masses = {"m"}, .prescribed = {}, .elements = {}, .excitations = {{kind, 0, 0}}};
  if (!is_force) network.prescribed = {"base"};
  const Node end = is_force ? Node{} : Node{NodeKind::prescribed, 0};
  network.elements.push_back({"k", ElementType::spring, end, {NodeKind::mass, 0}});
  return network;
}
const NetworkValues kUnit{.omega = 1.0, .mass = {1.0}, .element = {1.0}, .excitation = {{1.0, 0.0}}};

TEST_CASE("A force that rises linearly and stops moves an oscillator as Duhamel's integral says") {
  // x'' + x = t / 2 until 2, then 0:  x = (t - sin t) / 2, then free.
  const Record ramp{.name = "ramp", .of = RecordOf::force, .time = {0.0, 2.0}, .values = {0.0, 1.0}};
  const ForcedMotion motion =
      motion_of(one_mass(ExcitationKind::recorded_force), kUnit, {{0, &ramp}}, 10.0, 101);
  REQUIRE(motion.failure.empty());
  for (std::size_t i = 0; i < motion.history.time.size(); ++i) {
    const double t = motion.history.time[i], late = t - 2.0;
    const double x2 = 0.5 * (2.0 - std::sin(2.0)), v2 = 0.5 * (1.0 - std::cos(2.0));
    const double expected = t <= 2.0 ? 0.5 * (t - std::sin(t)) : x2 * std::cos(late) + v2 * std::sin(late);
    INFO("t = " << t);
    CHECK(std::abs(motion.history.displacement[0][i] - expected) < kExact);
  }
  CHECK(motion.energy.balance < kExact);
}

TEST_CASE("A support's acceleration, velocity and displacement are one motion") {
  // y'' = 2 - 3 t until 4/3 ... as a velocity its integral is not linear, so each is compared with its own
  // closed form: y = t^2 (a = 2), and v = 2 t.
  const std::vector<double> t{0.0, 0.7, 1.1, 2.0};
  const Record acceleration{.name = "a", .of = RecordOf::acceleration, .time = t, .values = {2, 2, 2, 2}};
  const Record velocity{.name = "v", .of = RecordOf::velocity, .time = t, .values = {0, 1.4, 2.2, 4.0}};
  const Record displacement{
      .name = "y", .of = RecordOf::displacement, .time = t, .values = {0, 0.49, 1.21, 4.0}};
  for (const Record* record : {&acceleration, &velocity, &displacement}) {
    const ForcedMotion motion =
        motion_of(one_mass(ExcitationKind::recorded_motion), kUnit, {{0, record}}, 2.0, 21);
    REQUIRE(motion.failure.empty());
    for (std::size_t i = 0; i < motion.history.time.size(); ++i) {
      // x'' + x = t^2 from rest: x = t^2 - 2 + 2 cos t
      const double s = motion.history.time[i];
      INFO(record->name << " at " << s);
      CHECK(std::abs(motion.history.displacement[0][i] - (s * s - 2.0 + 2.0 * std::cos(s))) < kExact);
    }
    CHECK(motion.energy.balance < kExact);
  }
}

TEST_CASE("Behind an acceleration its support keeps its velocity, behind a force nothing acts") {
  const Record pulse{.name = "p", .of = RecordOf::acceleration, .time = {0.0, 1.0}, .values = {1.0, 1.0}};
  Network network = one_mass(ExcitationKind::recorded_motion);
  network.signals.push_back({"base", {{{NodeKind::prescribed, 0}, 1.0}}});
  const ForcedMotion motion = motion_of(network, kUnit, {{0, &pulse}}, 3.0, 4);
  REQUIRE(motion.failure.empty());
  CHECK(std::abs(motion.history.displacement[1][3] - 2.5) < kExact);
  CHECK(std::abs(motion.history.velocity[1][3] - 1.0) < kExact);
}

TEST_CASE("Where a support starts without velocity and acceleration, the weaker of two contacts slides") {
  // A mass of 1 kg on a spring of 1 N/m to ground, with 1 N of friction there and 2 N on a support with y'' =
  // t: it goes along with the support, y = t^3/6, until its spring, its friction and its inertia take 2 N,
  // t^3/6 + 1 + t = 2.
  const Node ground{}, mass{NodeKind::mass, 0}, base{NodeKind::prescribed, 0};
  const Network network{.masses = {"m"},
                        .prescribed = {"base"},
                        .elements = {{"k", ElementType::spring, ground, mass},
                                     {"to_base", ElementType::coulomb, base, mass},
                                     {"to_ground", ElementType::coulomb, ground, mass}},
                        .excitations = {{ExcitationKind::recorded_motion, 0, 0}}};
  const NetworkValues values{
      .omega = 1.0, .mass = {1.0}, .element = {1.0, 2.0, 1.0}, .excitation = {{1.0, 0.0}}};
  const Record rising{.name = "t", .of = RecordOf::acceleration, .time = {0.0, 1.0}, .values = {0.0, 1.0}};
  const ForcedMotion motion = motion_of(network, values, {{0, &rising}}, 1.0, 11);
  REQUIRE(motion.failure.empty());
  CHECK(motion.energy.balance < kExact);
  CHECK(std::abs(motion.history.displacement[0][8] - 0.512 / 6.0) < kExact);
  REQUIRE(motion.stops[0].size() == 1);
  const double t = motion.stops[0][0].release;
  CHECK(std::abs(t * t * t / 6.0 + t - 1.0) < 1e-9);
}

TEST_CASE("A motion does not outlast a record that ends while its support moves") {
  const Record velocity{.name = "v", .of = RecordOf::velocity, .time = {0.0, 1.0}, .values = {0.0, 1.0}};
  const auto run = [&](double duration) {
    return motion_of(one_mass(ExcitationKind::recorded_motion), kUnit, {{0, &velocity}}, duration, 2);
  };
  CHECK(run(1.0).failure.empty());
  CHECK_THROWS_WITH(run(1.01), Catch::Contains("record 'v'") && Catch::Contains("not known beyond"));
}

TEST_CASE("Records that are none are refused by name") {
  const Network network = one_mass(ExcitationKind::recorded_force);
  const auto refused = [&](const Record& record, const std::string& word) {
    CHECK_THROWS_WITH(motion_of(network, kUnit, {{0, &record}}, 1.0, 2), Catch::Contains(word));
  };
  refused({.name = "short", .of = RecordOf::force, .time = {0.0}, .values = {0.0}}, "record 'short'");
  refused({.name = "back", .of = RecordOf::force, .time = {0.0, 0.0}, .values = {0, 0}}, "must ascend");
  refused({.name = "nan", .of = RecordOf::force, .time = {0.0, 1.0}, .values = {0, NAN}}, "finite");
  refused({.name = "y", .of = RecordOf::velocity, .time = {0.0, 1.0}, .values = {0, 1}}, "one of a support");
  CHECK_THROWS_WITH(motion_of(network, kUnit, {}, 1.0, 2), Catch::Contains("has no record"));
}

// A record and its plain interpolation, for the reference.
struct Drawn {
  Record record;

  std::size_t interval(double t) const {
    const auto next = std::upper_bound(record.time.begin(), record.time.end() - 1, t);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - record.time.begin() - 1, 0));
  }
  double linear(double t) const {
    const std::size_t i = interval(t);
    const double part = (t - record.time[i]) / (record.time[i + 1] - record.time[i]);
    return record.values[i] + part * (record.values[i + 1] - record.values[i]);
  }
  // y, y' and y'' of an acceleration, by the trapezoid of each interval and its cubic.
  double motion(double t, int derivative) const {
    if (derivative == 2) return linear(t);
    double v = 0.0, y = 0.0;
    const auto add = [&](double h, double a0, double a1) {
      y += v * h + h * h * (a0 / 3.0 + a1 / 6.0);
      v += 0.5 * h * (a0 + a1);
    };
    const std::size_t last = interval(t);
    for (std::size_t i = 0; i < last; ++i)
      add(record.time[i + 1] - record.time[i], record.values[i], record.values[i + 1]);
    add(t - record.time[last], record.values[last], linear(t));
    return derivative == 1 ? v : y;
  }
};

Drawn draw(RecordOf of, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Drawn drawn{{.name = "drawn", .of = of, .time = {0.0}, .values = {size * uniform(random)}}};
  while (drawn.record.time.back() < 12.0) {
    drawn.record.time.push_back(drawn.record.time.back() + 0.3 + 0.2 * uniform(random));
    drawn.record.values.push_back(size * uniform(random));
  }
  return drawn;
}

// A random network whose harmonics are records instead: a force on its first mass, and its support's
// acceleration.
struct Recorded {
  RandomNetwork drawn;
  Drawn force, shaking;

  std::vector<RecordedExcitation> records() const {
    std::vector<RecordedExcitation> all{{0, &force.record}};
    if (drawn.network.excitations.size() > 1) all.push_back({1, &shaking.record});
    return all;
  }
};

Recorded random_recorded(int trial, std::mt19937& random) {
  Recorded all{.drawn = random_network({.masses = 1 + trial % 5,
                                        .contacts = trial % 7 == 0 ? 0 : 1 + trial % 4,
                                        .maxwell_elements = trial % 4 == 3 ? 1 : 0,
                                        .orders = {1},
                                        .shaken = trial % 3 != 0},
                                       random),
               .force = draw(RecordOf::force, 1.0, random),
               .shaking = draw(RecordOf::acceleration, 1.0, random)};
  all.drawn.network.excitations = {{ExcitationKind::recorded_force, 0, 0}};
  all.drawn.values.excitation = {{1.0, 0.0}};
  if (!all.drawn.network.prescribed.empty()) {
    all.drawn.network.excitations.push_back({ExcitationKind::recorded_motion, 0, 0});
    all.drawn.values.excitation.push_back({0.7, 0.0});
  }
  return all;
}

TEST_CASE("Random networks under records move as the independent integration says", "[slow]") {
  std::mt19937 random(20261123);
  int with_stops = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Recorded all = random_recorded(trial, random);
    const Network& network = all.drawn.network;
    const ForcedMotion motion = motion_of(network, all.drawn.values, all.records(), 12.0, 61);
    INFO("trial " << trial << " " << motion.failure);
    REQUIRE(motion.failure.empty());
    CHECK(motion.energy.balance < 1e-11);
    for (const auto& stops : motion.stops) with_stops += stops.size() > 1;

    const mechanics::Assembly assembly(network);
    mechanics::LinearSystem system;
    assembly.set_values(all.drawn.values, system);
    assembly.set_forcing(all.drawn.values, system);
    periodic::EventIntegrator reference(system);
    const auto n = static_cast<Eigen::Index>(network.masses.size());
    periodic::EventIntegrator::Recorded recorded;
    recorded.speed = 1.0;
    recorded.force = [&](double t) -> Eigen::VectorXd {
      return all.force.linear(t) * Eigen::VectorXd::Unit(n, 0);
    };
    if (!network.prescribed.empty())
      recorded.motion = [&](double t, int derivative) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, 0.7 * all.shaking.motion(t, derivative));
      };
    reference.set_recorded(recorded);
    reference.start(0.0, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n));
    std::vector<double> stations = motion.history.time;
    for (const RecordedExcitation& each : all.records())
      stations.insert(stations.end(), each.record->time.begin(), each.record->time.end());
    std::ranges::sort(stations);
    double error = 0.0;
    std::size_t next = 0;
    for (const double t : stations) {
      if (t > 12.0) break;
      reference.advance_to(t);
      if (next == motion.history.time.size() || t != motion.history.time[next]) continue;
      const Eigen::VectorXd q = reference.displacements();
      for (Eigen::Index i = 0; i < n; ++i)
        error =
            std::max(error, std::abs(motion.history.displacement[static_cast<std::size_t>(i)][next] - q[i]));
      ++next;
    }
    CHECK(error < kIntegrated * largest(motion.history));
  }
  CHECK(with_stops > 50);
}

TEST_CASE("A record with further samples on its own lines moves every network alike") {
  std::mt19937 random(20261124);
  for (int trial = 0; trial < 50; ++trial) {
    Recorded all = random_recorded(trial, random);
    all.force.record.values[0] = all.shaking.record.values[0] = 0.0;  // as an earthquake begins
    const ForcedMotion coarse = motion_of(all.drawn.network, all.drawn.values, all.records(), 12.0, 61);
    for (Drawn* drawn : {&all.force, &all.shaking}) {
      Record refined = drawn->record;
      refined.time.clear();
      refined.values.clear();
      for (std::size_t i = 0; i + 1 < drawn->record.time.size(); ++i) {
        for (const double part : {0.0, 0.31, 0.5}) {
          const double t = drawn->record.time[i] + part * (drawn->record.time[i + 1] - drawn->record.time[i]);
          refined.time.push_back(t);
          refined.values.push_back(drawn->linear(t));
        }
      }
      refined.time.push_back(drawn->record.time.back());
      refined.values.push_back(drawn->record.values.back());
      drawn->record = refined;
    }
    const ForcedMotion fine = motion_of(all.drawn.network, all.drawn.values, all.records(), 12.0, 61);
    INFO("trial " << trial << " " << coarse.failure << fine.failure);
    REQUIRE((coarse.failure.empty() && fine.failure.empty()));
    double change = 0.0;
    for (std::size_t mass = 0; mass < coarse.history.displacement.size(); ++mass)
      for (std::size_t i = 0; i < coarse.history.time.size(); ++i)
        change = std::max(
            change, std::abs(coarse.history.displacement[mass][i] - fine.history.displacement[mass][i]));
    CHECK(change < kRefined * largest(coarse.history));
  }
}

}  // namespace
}  // namespace frahm::transient::recorded_motion_test
