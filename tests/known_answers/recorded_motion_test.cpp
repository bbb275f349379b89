#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/transient/displacement_sensitivity.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/record_course.hpp"
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
  Network network{.masses = {"m"}, .elements = {}, .excitations = {{kind, 0, 0}}};
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
  CHECK_THROWS_WITH(run(1.01), Catch::Contains("record 'v'") && Catch::Contains("motion is not known"));
}

// A list of corners.
Record corners(RecordOf of, std::vector<double> time, std::vector<double> values) {
  Record record{.name = "corners", .of = of, .time = std::move(time), .values = std::move(values)};
  record.interpolation = Interpolation::linear;
  record.is_corners = true;
  return record;
}

TEST_CASE("Corners are the record of the same samples, until it ends") {
  const std::vector<double> t{0.0, 0.7, 1.1, 2.0}, y{0.0, 0.3, -0.2, 0.5};
  for (const RecordOf of : {RecordOf::displacement, RecordOf::velocity, RecordOf::acceleration}) {
    const Record list = corners(of, t, y);
    Record record = list;
    record.is_corners = false;
    const Network network = one_mass(ExcitationKind::recorded_motion);
    const ForcedMotion a = motion_of(network, kUnit, {{0, &list}}, 2.0, 21);
    const ForcedMotion b = motion_of(network, kUnit, {{0, &record}}, 2.0, 21);
    CHECK(a.history.displacement == b.history.displacement);
    CHECK(a.history.velocity == b.history.velocity);
  }
}

TEST_CASE("A force steps at two corners of one time, and its last value holds") {
  // x'' + x = 1 until 2, then -1/2:  x = 1 - cos t, then -1/2 + A cos s + B sin s, s = t - 2.
  const Record steps = corners(RecordOf::force, {0.0, 2.0, 2.0, 3.0}, {1.0, 1.0, -0.5, -0.5});
  const ForcedMotion motion =
      motion_of(one_mass(ExcitationKind::recorded_force), kUnit, {{0, &steps}}, 12.0, 121);
  REQUIRE(motion.failure.empty());
  for (std::size_t i = 0; i < motion.history.time.size(); ++i) {
    const double t = motion.history.time[i], s = t - 2.0;
    const double expected = s <= 0.0
                                ? 1.0 - std::cos(t)
                                : -0.5 + (1.5 - std::cos(2.0)) * std::cos(s) + std::sin(2.0) * std::sin(s);
    INFO("t = " << t);
    CHECK(std::abs(motion.history.displacement[0][i] - expected) < kExact);
  }
  CHECK(motion.energy.balance < kExact);
}

TEST_CASE("A velocity goes on with its last value, and an acceleration and a displacement with theirs") {
  Network network = one_mass(ExcitationKind::recorded_motion);
  network.signals.push_back({"base", {{{NodeKind::prescribed, 0}, 1.0}}});
  const auto at_three = [&](const Record& record) {
    const ForcedMotion motion = motion_of(network, kUnit, {{0, &record}}, 3.0, 4);
    REQUIRE(motion.failure.empty());
    CHECK(motion.energy.balance < kExact);
    return std::pair{motion.history.displacement[1][3], motion.history.displacement[0][3]};
  };
  // y = t^2/2 until 1, then y = 1/2 + s, s = t - 1:  x = y - 1 + cos t, then y + A cos s + B sin s with
  // A = cos 1 - 1, B = -sin 1.
  const auto [base, mass] = at_three(corners(RecordOf::velocity, {0.0, 1.0}, {0.0, 1.0}));
  CHECK(std::abs(base - 2.5) < kExact);
  CHECK(std::abs(mass - (2.5 + (std::cos(1.0) - 1.0) * std::cos(2.0) - std::sin(1.0) * std::sin(2.0))) <
        kExact);
  CHECK(std::abs(at_three(corners(RecordOf::acceleration, {0.0, 1.0}, {2.0, 2.0})).first - 9.0) < kExact);
  CHECK(std::abs(at_three(corners(RecordOf::displacement, {0.0, 1.0}, {0.0, 4.0})).first - 4.0) < kExact);
}

// A block of 1 kg, held by friction of 2 N alone, to the ground or to a support.
Network block(ExcitationKind kind) {
  Network network = one_mass(kind);
  network.elements[0].type = ElementType::coulomb;
  network.elements[0].name = "friction";
  if (kind == ExcitationKind::recorded_motion)
    network.signals.push_back({"slip", {{{NodeKind::mass, 0}, 1.0}, {{NodeKind::prescribed, 0}, -1.0}}});
  return network;
}
const NetworkValues kBlock{.omega = 1.0, .mass = {1.0}, .element = {2.0}, .excitation = {{1.0, 0.0}}};

TEST_CASE("A belt that starts at once slips under its block, until the block has its speed") {
  // v = 2 s from t = 1 on, 3 m/s after 1.5 s and 2.25 m; then it rides.
  const Record start = corners(RecordOf::velocity, {0.0, 1.0, 1.0, 2.0}, {0.0, 0.0, 3.0, 3.0});
  const ForcedMotion motion =
      motion_of(block(ExcitationKind::recorded_motion), kBlock, {{0, &start}}, 4.0, 5);
  REQUIRE(motion.failure.empty());
  CHECK(std::abs(motion.history.displacement[0][2] - 1.0) < kExact);
  CHECK(std::abs(motion.history.displacement[0][4] - (2.25 + 3.0 * 1.5)) < 10.0 * kExact);
  CHECK(std::abs(motion.history.displacement[1][4] - (2.25 - 4.5)) < 10.0 * kExact);
  REQUIRE(motion.stops[0].size() == 2);
  CHECK(std::abs(motion.stops[0][0].release - 1.0) < kExact);
  CHECK(std::abs(motion.stops[0][1].onset - 2.5) < kExact);
  CHECK(motion.energy.balance < kExact);
}

TEST_CASE("A block lets go where its force steps above the friction, and stops after it steps down") {
  // 3 N - 2 N from t = 1 to 2: 0.5 m and 1 m/s; then -2 N for 0.5 s and 0.25 m.
  const Record pushes =
      corners(RecordOf::force, {0.0, 1.0, 1.0, 2.0, 2.0, 3.0}, {1.0, 1.0, 3.0, 3.0, 0.0, 0.0});
  const ForcedMotion motion =
      motion_of(block(ExcitationKind::recorded_force), kBlock, {{0, &pushes}}, 5.0, 6);
  REQUIRE(motion.failure.empty());
  CHECK(std::abs(motion.history.displacement[0][1]) < kExact);
  CHECK(std::abs(motion.history.displacement[0][2] - 0.5) < kExact);
  CHECK(std::abs(motion.history.displacement[0][5] - 0.75) < kExact);
  CHECK(motion.energy.balance < kExact);
}

TEST_CASE("Newmark's block slips V^2/(2 mu g) (1 - mu g/a) under a pulse of acceleration") {
  // mu g = 2 m/s2, a = 5 m/s2 for 0.4 s: V = 2 m/s.
  const Record pulse = corners(RecordOf::acceleration, {0.0, 0.4, 0.4, 1.0}, {5.0, 5.0, 0.0, 0.0});
  const ForcedMotion motion =
      motion_of(block(ExcitationKind::recorded_motion), kBlock, {{0, &pulse}}, 3.0, 4);
  REQUIRE(motion.failure.empty());
  CHECK(std::abs(motion.history.displacement[1][3] + 0.6) < kExact);
  CHECK(motion.energy.balance < kExact);
}

TEST_CASE("Records that are none are refused by name") {
  const Network network = one_mass(ExcitationKind::recorded_force);
  const auto refused = [&](const Record& record, const std::string& word) {
    CHECK_THROWS_WITH(motion_of(network, kUnit, {{0, &record}}, 1.0, 2), Catch::Contains(word));
  };
  refused({.name = "short", .of = RecordOf::force, .time = {0.0}, .values = {0.0}}, "record 'short'");
  refused({.name = "back", .of = RecordOf::force, .time = {0.0, 0.0}, .values = {0, 0}}, "must ascend");
  refused(corners(RecordOf::force, {0.0, 1.0, 1.0, 1.0}, {0, 0, 1, 2}), "must ascend");
  refused({.name = "nan", .of = RecordOf::force, .time = {0.0, 1.0}, .values = {0, NAN}}, "finite");
  refused({.name = "y", .of = RecordOf::velocity, .time = {0.0, 1.0}, .values = {0, 1}},
          "a motion belongs to a support");
  CHECK_THROWS_WITH(motion_of(network, kUnit, {}, 1.0, 2), Catch::Contains("has no record"));
}

// A handle that is pulled by 1 m within a tenth of a second, from its corners.
Record pulled(Interpolation interpolation) {
  return {.name = "pull.csv",
          .of = RecordOf::displacement,
          .time = {0.0, 1.0, 1.1, 10.0},
          .values = {0.0, 0.0, 1.0, 1.0},
          .interpolation = interpolation};
}

// x'' + c x' + k x = k t from rest: x = t - c/k + e^{-c t/2} (c/k cos w t + (c^2/(2 k) - 1)/w sin w t), and
// its rate; 0 before t = 0.
struct OfRamp {
  double c = 0.0, k = 0.0;
  double w() const { return std::sqrt(k - 0.25 * c * c); }
  double value(double t) const {
    const double a = c / k, b = (0.5 * c * a - 1.0) / w();
    return t < 0.0 ? 0.0 : t - a + std::exp(-0.5 * c * t) * (a * std::cos(w() * t) + b * std::sin(w() * t));
  }
  double rate(double t) const {
    const double a = c / k, b = (0.5 * c * a - 1.0) / w();
    return t < 0.0 ? 0.0
                   : 1.0 + std::exp(-0.5 * c * t) * ((b * w() - 0.5 * c * a) * std::cos(w() * t) -
                                                     (a * w() + 0.5 * c * b) * std::sin(w() * t));
  }
};

TEST_CASE("A handle that moves along straight lines pulls a mass as the closed form of its ramps says") {
  const Node ground{}, mass{NodeKind::mass, 0}, handle{NodeKind::prescribed, 0};
  const Record record = pulled(Interpolation::linear);
  // The damper runs to the ground, or to the handle: its force then jumps with the handle's velocity,
  // x'' + c x' + k x = k y + c y'.
  for (const Node& end : {ground, handle}) {
    Network network{
        .masses = {"block"},
        .prescribed = {"handle"},
        .elements = {{"k", ElementType::spring, handle, mass}, {"c", ElementType::damper, end, mass}},
        .excitations = {{ExcitationKind::recorded_motion, 0, 0}}};
    network.signals.push_back({"pulled", {{handle, 1.0}}});
    const NetworkValues values{
        .omega = 1.0, .mass = {1.0}, .element = {4.0, 1.0}, .excitation = {{1.0, 0.0}}};
    const ForcedMotion motion = motion_of(network, values, {{0, &record}}, 10.0, 1001);
    INFO(motion.failure);
    REQUIRE(motion.failure.empty());
    CHECK(motion.energy.balance < kExact);
    const OfRamp ramp{.c = 1.0, .k = 4.0};
    const double by_rate = end == handle ? 0.25 : 0.0;
    for (std::size_t i = 0; i < motion.history.time.size(); ++i) {
      const double t = motion.history.time[i];
      const double x = 10.0 * (ramp.value(t - 1.0) - ramp.value(t - 1.1)) +
                       10.0 * by_rate * (ramp.rate(t - 1.0) - ramp.rate(t - 1.1));
      INFO("t = " << t);
      CHECK(std::abs(motion.history.displacement[0][i] - x) < 10.0 * kExact);
    }
    if (end == handle) {  // c y' at once
      CHECK(std::abs(motion.history.acceleration[0][100] - 10.0) < 1e-9);
      continue;
    }
    constexpr double kPeak = 1.443604083,
                     kDigits = 5e-10;  // of the same closed form, on a fine grid in Python
    CHECK(std::abs(motion.peaks[0].displacement - kPeak) < kDigits);
  }
}

TEST_CASE(
    "A contact slides from the instant at which the velocity of its support jumps, and its mass keeps its "
    "own") {
  // 1 kg on a spring of 1 N/m to the ground, F of friction on a base that moves by 2 m from t = 1 to 2 s:
  // x'' + x = F until 2, x = F (1 - cos(t - 1)); then the base rests and x'' + x = -F until the mass stops,
  // where its spring cannot move it any more: x + F = F R, R^2 = (2 - cos 1)^2 + sin^2 1.
  const Node ground{}, mass{NodeKind::mass, 0}, base{NodeKind::prescribed, 0};
  const Network network{
      .masses = {"m"},
      .prescribed = {"base"},
      .elements = {{"k", ElementType::spring, ground, mass}, {"belt", ElementType::coulomb, base, mass}},
      .excitations = {{ExcitationKind::recorded_motion, 0, 0}}};
  const double F = 0.8;
  const NetworkValues values{.omega = 1.0, .mass = {1.0}, .element = {1.0, F}, .excitation = {{1.0, 0.0}}};
  const Record record{.name = "base",
                      .of = RecordOf::displacement,
                      .time = {0.0, 1.0, 2.0, 6.0},
                      .values = {0.0, 0.0, 2.0, 2.0},
                      .interpolation = Interpolation::linear};
  const ForcedMotion motion = motion_of(network, values, {{0, &record}}, 8.0, 81);
  INFO(motion.failure);
  REQUIRE(motion.failure.empty());
  CHECK(motion.energy.balance < kExact);
  const double R = std::hypot(2.0 - std::cos(1.0), std::sin(1.0));
  const double stop = 2.0 + std::atan2(std::sin(1.0), 2.0 - std::cos(1.0));
  CHECK(std::abs(motion.history.displacement[0][15] - F * (1.0 - std::cos(0.5))) < kExact);
  CHECK(std::abs(motion.history.velocity[0][10]) < kExact);
  CHECK(std::abs(motion.history.velocity[0][20] - F * std::sin(1.0)) < kExact);
  CHECK(std::abs(motion.history.displacement[0][80] - F * (R - 1.0)) < kExact);
  REQUIRE(motion.stops[0].size() == 2);
  CHECK(std::abs(motion.stops[0][0].release - 1.0) < kExact);
  CHECK(std::abs(motion.stops[0][1].onset - stop) < 1e-10);

  // All of it is proportional to F, and so is its derivative.
  NetworkValues by{.omega = 0.0, .mass = {0.0}, .element = {0.0, 1.0}, .excitation = {{0.0, 0.0}}};
  const RecordedExcitation driven{0, &record};
  const DisplacementSensitivity sensitivity = displacement_sensitivity(
      network, values, std::span(&by, 1), std::span(&driven, 1), 0, std::vector<double>{1.5, 2.2, 5.0}, {});
  INFO(sensitivity.failure << sensitivity.why_none);
  REQUIRE(sensitivity.why_none.empty());
  for (Eigen::Index i = 0; i < 3; ++i)
    CHECK(std::abs(sensitivity.by(i, 0) - sensitivity.displacement[i] / F) < 1e-10);
  CHECK(std::abs(sensitivity.by(2, 0) - (R - 1.0)) < 1e-10);
}

TEST_CASE("A spline that strays from its samples is refused, and one through a smooth motion is not") {
  const Network network = one_mass(ExcitationKind::recorded_motion);
  const Record step = pulled(Interpolation::spline);
  CHECK_THROWS_WITH(motion_of(network, kUnit, {{0, &step}}, 10.0, 2),
                    Catch::Contains("record 'pull.csv': the cubic spline") && Catch::Contains("sample 3") &&
                        Catch::Contains("sample 4") && Catch::Contains("interpolation = \"linear\""));
  Record sine{.name = "sine", .of = RecordOf::displacement, .time = {}, .values = {}};
  for (int i = 0; i < 40; ++i) {
    sine.time.push_back(0.25 * std::numbers::pi * i + (i % 3 == 0 ? 0.1 : 0.0));
    sine.values.push_back(std::sin(sine.time.back()));
  }
  CHECK(why_no_spline(sine).empty());
}

TEST_CASE(
    "A support whose velocity jumps holds no inerter, and where it still moves at its end is not known") {
  Network network = one_mass(ExcitationKind::recorded_motion);
  Record record = pulled(Interpolation::linear);
  record.time.pop_back();
  record.values.pop_back();
  CHECK_THROWS_WITH(motion_of(network, kUnit, {{0, &record}}, 2.0, 2),
                    Catch::Contains("motion is not known"));
  NetworkValues values = kUnit;
  values.element.push_back(1.0);
  network.elements.push_back({"b", ElementType::inerter, {NodeKind::prescribed, 0}, {NodeKind::mass, 0}});
  CHECK_THROWS_WITH(motion_of(network, values, {{0, &record}}, 1.0, 2),
                    Catch::Contains("the inerter \"b\"") && Catch::Contains("infinite force"));
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

// The velocity of straight lines, with ramps of `width` [s] in place of its jumps.
Record velocity_of(const Record& lines, double width) {
  Record velocity{.name = "v", .of = RecordOf::velocity, .time = {0.0}, .values = {0.0}};
  for (std::size_t i = 0; i + 1 < lines.time.size(); ++i) {
    const double slope = (lines.values[i + 1] - lines.values[i]) / (lines.time[i + 1] - lines.time[i]);
    velocity.time.push_back(lines.time[i] + width);
    velocity.values.push_back(slope);
    velocity.time.push_back(lines.time[i + 1]);
    velocity.values.push_back(slope);
  }
  return velocity;
}

TEST_CASE("Straight lines move every network as a velocity does that turns ever faster at their ends") {
  // [s]; shorter ones are lost in the rounding of their own accelerations. What they leave is proportional to
  // their width, and two widths take it away but for this part of the peak.
  constexpr double kWidth = 1e-5, kTurns = 1e-5;
  std::mt19937 random(20261128);
  int with_stops = 0;
  for (int trial = 0; trial < 40; ++trial) {
    RandomNetwork drawn = random_network({.masses = 1 + trial % 4,
                                          .contacts = 1 + trial % 4,
                                          .maxwell_elements = trial % 4 == 3 ? 1 : 0,
                                          .orders = {1},
                                          .shaken = true},
                                         random);
    for (std::size_t e = 0; e < drawn.network.elements.size(); ++e) {
      if (drawn.network.elements[e].type == ElementType::inerter)
        drawn.network.elements[e].type = ElementType::damper;
    }
    drawn.network.excitations = {{ExcitationKind::recorded_motion, 0, 0}};
    drawn.values.excitation = {{1.0, 0.0}};
    Record lines = draw(RecordOf::displacement, 1.0, random).record;
    lines.values.front() = 0.0;
    lines.interpolation = Interpolation::linear;
    const Record wide = velocity_of(lines, kWidth), narrow = velocity_of(lines, 0.5 * kWidth);
    const double end = lines.time.back() - 1e-3;
    const ForcedMotion exact = motion_of(drawn.network, drawn.values, {{0, &lines}}, end, 61);
    const ForcedMotion of_wide = motion_of(drawn.network, drawn.values, {{0, &wide}}, end, 61);
    const ForcedMotion of_narrow = motion_of(drawn.network, drawn.values, {{0, &narrow}}, end, 61);
    INFO("trial " << trial << " " << exact.failure << " " << of_wide.failure << " " << of_narrow.failure);
    REQUIRE((exact.failure.empty() && of_wide.failure.empty() && of_narrow.failure.empty()));
    CHECK(exact.energy.balance < 1e-10);
    for (const auto& stops : exact.stops) with_stops += stops.size() > 1;
    double difference = 0.0;
    for (std::size_t mass = 0; mass < drawn.network.masses.size(); ++mass)
      for (std::size_t i = 0; i < exact.history.time.size(); ++i)
        difference = std::max(difference, std::abs(exact.history.displacement[mass][i] -
                                                   2.0 * of_narrow.history.displacement[mass][i] +
                                                   of_wide.history.displacement[mass][i]));
    CHECK(difference < kTurns * largest(exact.history));
  }
  CHECK(with_stops > 10);
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
