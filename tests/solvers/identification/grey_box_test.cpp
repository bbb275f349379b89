#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/known_answers/free_oscillator.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/solvers/fitted_motions.hpp"

// Grey boxes: parameters found again in motions that were made with them.
namespace frahm::identification::grey_box_test {
namespace {

constexpr double kFound = 1e-10;  // relative, of parameters from motions without noise
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check_found(const Identification& found, Model truth, const std::vector<Place>& places) {
  INFO(found.failure);
  REQUIRE(found.failure.empty());
  REQUIRE(found.estimates.size() == places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double true_value = places[i].of(truth);
    INFO(places[i].name << " = " << found.estimates[i].value << ", off by "
                        << found.estimates[i].value / true_value - 1.0);
    CHECK(std::abs(found.estimates[i].value - true_value) <= kFound * std::abs(true_value));
  }
  for (const FittedRecord& record : found.records) CHECK(record.nrmse > 100.0 - 1e-6);
}

// One mass with viscous damping and friction, released from 20 x_f.
const transient::FreeOscillator kOscillator{.m = 2.0, .k = 200.0, .zeta = 0.01, .x_f = 0.001};
const Model kReleased{kOscillator.values(), {{0.02}, {0.0}}};
const std::vector<Place> kPlaces = {element("k", 0), element("c", 1), element("F", 2),
                                    initial_displacement(0)};

TEST_CASE("Stiffness, damping, friction and release of one mass are found in its decay up to rest") {
  const TimeRecord record =
      displacements("decay", MotionKind::free, kOscillator.network(), kReleased, 8.0, 2000);
  REQUIRE(record.channels[0].values[1800] == record.channels[0].values[1999]);
  SECTION("from starts 20 to 50 % above") {
    check_found(fit(kOscillator.network(), kReleased, kPlaces, {1.3, 1.5, 1.4, 1.2}, {record}), kReleased,
                kPlaces);
  }
  SECTION("from starts 20 to 50 % below") {
    check_found(fit(kOscillator.network(), kReleased, kPlaces, {0.7, 0.5, 0.5, 0.8}, {record}), kReleased,
                kPlaces);
  }
  SECTION("from friction eight times too large, which stops the model in its first swing") {
    check_found(fit(kOscillator.network(), kReleased, kPlaces, {1.2, 1.0, 8.0, 1.0}, {record}), kReleased,
                kPlaces);
  }
}

// The rig's two masses free, the absorber's guide and the main guide rubbing.
TEST_CASE("Both guides' friction and the absorber are found in a decay of two masses") {
  const mechanics::Network network = periodic::rig();
  const Model truth{periodic::rig_values(20.0, 6.36, 0.05), {{0.05, 0.08}, {0.0, 0.0}}};
  const std::vector<Place> places = {element("D", 3), element("k", 4), element("c", 5), element("I", 6),
                                     element("d", 7)};
  const TimeRecord record = displacements("decay", MotionKind::free, network, truth, 4.0, 1500);
  check_found(fit(network, truth, places, {1.5, 1.3, 0.7, 1.3, 0.6}, {record}), truth, places);
}

TEST_CASE("The rig forced at 250 rpm tells damping, friction and inertance from unknown initial values") {
  const mechanics::Network network = periodic::rig();
  const Model truth{periodic::rig_values(250.0 * std::numbers::pi / 30.0, 6.36, 0.0419),
                    {{0.003, -0.002}, {0.05, -0.1}}};
  std::vector<Place> places = {element("D", 3), element("c", 5), element("I", 6), element("d", 7)};
  for (const std::size_t mass : {0, 1}) {
    places.push_back(initial_displacement(mass));
    places.push_back(initial_velocity(mass));
  }
  const TimeRecord record = displacements("forced", MotionKind::forced, network, truth, 6.0, 3000);
  check_found(fit(network, truth, places, {1.5, 0.6, 1.3, 1.4, 0.5, 1.5, 0.6, 1.4}, {record}), truth, places);
}

// The response made by another part of the solvers than what simulates it here.
TEST_CASE("The steady response of the rig tells damping, friction and inertance") {
  const mechanics::Network network = periodic::rig();
  const Model truth{periodic::rig_values(250.0 * std::numbers::pi / 30.0, 6.36, 0.0419), {{}, {}}};
  periodic::PeriodicResponse response(network, {});
  response.set_values(truth.values);
  response.solve();
  TimeRecord record{"steady", MotionKind::periodic, {}, {}, {}};
  std::vector<double> phases;
  for (int i = 0; i < 500; ++i) {
    phases.push_back(0.3 + 0.11 * i);
    record.time.push_back(phases.back() / truth.values.omega);
  }
  const periodic::History history = response.history(phases);
  record.channels = {{"main_displacement", 0, Signal::displacement, history.columns[0]},
                     {"main_velocity", 0, Signal::velocity, history.columns[1]},
                     {"tmd_displacement", 1, Signal::displacement, history.columns[2]}};
  const std::vector<Place> places = {element("D", 3), element("c", 5), element("I", 6), element("d", 7)};
  check_found(fit(network, truth, places, {1.3, 1.3, 1.1, 1.2}, {record}), truth, places);
}

// One mass on a spring and damper to a support and friction to ground, shaken by a support that moves as
// y = A sin(omega t), or pushed by a force alike: what is measured at 400 times a period.
TEST_CASE(
    "A measured force and a measured support drive the model in the place of the network's excitation") {
  using namespace mechanics;
  const Node ground{}, mass{NodeKind::mass, 0}, support{NodeKind::prescribed, 0};
  const bool shaken = GENERATE(true, false);
  const ExcitationKind kind = shaken ? ExcitationKind::motion : ExcitationKind::force;
  const Network network{.masses = {"x"},
                        .prescribed = {"support"},
                        .elements = {{"spring", ElementType::spring, support, mass},
                                     {"damper", ElementType::damper, support, mass},
                                     {"friction", ElementType::coulomb, ground, mass}},
                        .excitations = {{kind, 0, 1}}};
  const double amplitude = shaken ? 0.01 : 2.0;
  const Model truth{{.omega = 9.0,
                     .mass = {2.0},
                     .element = {200.0, 1.5, 0.4},
                     .excitation = {{amplitude, -0.5 * std::numbers::pi}}},
                    {{0.01}, {0.0}}};
  const double period = 2.0 * std::numbers::pi / 9.0;
  TimeRecord record = displacements("driven", MotionKind::forced, network, truth, 8.0 * period, 3201);
  MeasuredExcitation measured{kind, 0, {}};
  for (const double t : record.time) measured.values.push_back(amplitude * std::sin(9.0 * t));
  record.excitation = {measured};
  const std::vector<Place> places = {element("k", 0), element("c", 1), element("F", 2)};
  const Identification found = fit(network, truth, places, {1.2, 0.7, 1.4}, {record});
  INFO(found.failure);
  REQUIRE(found.failure.empty());
  // A force is linear between its values, at most (omega dt)^2 / 8 = 3.1e-5 of it off, which is five times as
  // much of the friction; the spline of a displacement is (omega dt)^4 / 384 = 1.6e-10 off.
  const double tolerance = shaken ? 1e-8 : 3.1e-5 * amplitude / truth.values.element[2];
  Model model = truth;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double off = found.estimates[i].value / places[i].of(model) - 1.0;
    INFO(places[i].name << " off by " << off);
    CHECK(std::abs(off) < tolerance);
  }
}

TEST_CASE("Each record has a release of its own, the parameters are common to all") {
  const mechanics::Network network = kOscillator.network();
  std::vector<TimeRecord> records;
  std::vector<double> releases = {0.02, 0.012, -0.03};
  for (const double release : releases) {
    Model model = kReleased;
    model.initial.displacement[0] = release;
    records.push_back(
        displacements("from_" + std::to_string(records.size()), MotionKind::free, network, model, 6.0, 600));
  }
  GreyBoxTask task{.network = network,
                   .model_at = model_with({kReleased}, kPlaces),
                   .parameters = started_off(kReleased, kPlaces, {1.2, 0.6, 1.3, 1.0}),
                   .records = records};
  task.parameters[3].each_record = true;
  const Identification found = grey_box(task);
  REQUIRE(found.failure.empty());
  REQUIRE(found.estimates.size() == 6);
  Model truth = kReleased;
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(std::abs(found.estimates[i].value / kPlaces[i].of(truth) - 1.0) <= kFound);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(found.estimates[3 + i].name == "x0_" + records[i].name);
    CHECK(std::abs(found.estimates[3 + i].value / releases[i] - 1.0) <= kFound);
  }
}

TEST_CASE("The stated intervals cover each parameter in at least 90 of 100 noisy records", "[long]") {
  const mechanics::Network network = kOscillator.network();
  const TimeRecord clean = displacements("decay", MotionKind::free, network, kReleased, 7.0, 700);
  std::mt19937 random(20261123);
  std::vector<int> covered(kPlaces.size(), 0);
  for (int number = 0; number < 100; ++number) {
    TimeRecord record = clean;
    add_noise(record, 2e-4, random);
    const Identification found = fit(network, kReleased, kPlaces, {1.2, 0.7, 1.3, 0.9}, {record});
    INFO("record " << number << ": " << found.failure);
    REQUIRE(found.failure.empty());
    CHECK(found.records[0].nrmse > 90.0);
    Model truth = kReleased;
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      const double value = kPlaces[i].of(truth);
      if (found.estimates[i].low <= value && value <= found.estimates[i].high) ++covered[i];
    }
  }
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    INFO(kPlaces[i].name << " covered by " << covered[i]);
    CHECK(covered[i] >= 90);
  }
}

TEST_CASE(
    "Mass and stiffness of a decay without force are told as not determined, its friction's ratio too") {
  const TimeRecord record =
      displacements("decay", MotionKind::free, kOscillator.network(), kReleased, 4.0, 400);
  std::vector<Place> places = {{"m", [](Model& m) -> double& { return m.values.mass[0]; }},
                               element("k", 0),
                               element("c", 1),
                               element("F", 2),
                               initial_displacement(0)};
  const Identification found =
      fit(kOscillator.network(), kReleased, places, {1.0, 1.1, 0.9, 1.1, 1.0}, {record});
  INFO(found.failure);
  REQUIRE(found.failure.empty());
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::isinf(found.estimates[i].standard_error));
    CHECK(std::isnan(found.estimates[i].value));
  }
  CHECK(std::abs(found.estimates[4].value / 0.02 - 1.0) <= kFound);
  CHECK(std::isfinite(found.estimates[4].standard_error));
}

TEST_CASE("A friction that never slides is not determined") {
  // The absorber sticks to the main mass throughout.
  const mechanics::Network network = periodic::rig();
  const Model truth{periodic::rig_values(20.0, 6.36, 0.05, 5000.0), {{0.02, 0.02}, {0.0, 0.0}}};
  const std::vector<Place> places = {element("D", 3), element("d", 7)};
  const TimeRecord record = displacements("decay", MotionKind::free, network, truth, 2.0, 300);
  const Identification found = fit(network, truth, places, {1.3, 1.1}, {record});
  REQUIRE(found.failure.empty());
  CHECK(std::abs(found.estimates[0].value / truth.values.element[3] - 1.0) <= kFound);
  CHECK(std::isinf(found.estimates[1].standard_error));
}

// Two records: the damper of the first is c_m alone, of the second c_m + c. With c_m known from the first,
// c of the second is as uncertain as c of a fit of both.
TEST_CASE("What is uncertain of a fixed parameter adds to what it is fixed for, as in a joint fit") {
  const mechanics::Network network = kOscillator.network();
  Model alone = kReleased, together = kReleased;
  alone.values.element[1] = 0.4;
  together.values.element[1] = 1.0;
  std::mt19937 random(20261124);
  TimeRecord first = displacements("alone", MotionKind::free, network, alone, 6.0, 3000);
  TimeRecord second = displacements("together", MotionKind::free, network, together, 6.0, 3000);
  add_noise(first, 1e-3, random);
  add_noise(second, 1e-3, random);
  // at: c_m, c; or c, c_m where c_m is fixed
  const auto model_of = [](std::size_t c_m, bool both) {
    return [c_m, both](std::size_t record, std::span<const double> at, Model& model,
                       std::vector<Model>* derivatives) {
      model = kReleased;
      const bool has_c = !both || record == 1;
      model.values.element[1] = at[c_m] + (has_c && at.size() > 1 ? at[1 - c_m] : 0.0);
      if (derivatives == nullptr) return;
      derivatives->assign(at.size(), {periodic::zero_direction(kReleased.values), {}});
      (*derivatives)[c_m].values.element[1] = 1.0;
      if (has_c && at.size() > 1) (*derivatives)[1 - c_m].values.element[1] = 1.0;
    };
  };
  const FittedParameter c_m{"c_m", "N s m-1", 0.5, 0.0, kInfinity, false};
  const FittedParameter c{"c", "N s m-1", 0.5, 0.0, kInfinity, false};
  const GreyBoxTask of_first{
      .network = network, .model_at = model_of(0, true), .parameters = {c_m}, .records = {first}};
  const Identification known = grey_box(of_first);
  const GreyBoxTask of_both{
      .network = network, .model_at = model_of(0, true), .parameters = {c_m, c}, .records = {first, second}};
  const Identification joint = grey_box(of_both);
  const GreyBoxTask of_second{.network = network,
                              .model_at = model_of(1, false),
                              .parameters = {c},
                              .fixed = {{"c_m", "N s m-1", known.estimates[0].value}},
                              .fixed_covariance = known.covariance,
                              .records = {second}};
  const Identification chained = grey_box(of_second);
  REQUIRE(joint.failure.empty());
  REQUIRE(chained.failure.empty());
  constexpr double kSampleVariance = 0.06;  // of an estimated variance of 3000 residuals: 2 standard errors
  CHECK(chained.covariance(0, 0) > 1.2 * (chained.covariance(0, 0) - known.covariance(0, 0)));
  CHECK(std::abs(chained.covariance(0, 0) / joint.covariance(1, 1) - 1.0) < kSampleVariance);
  CHECK(std::abs(chained.estimates[0].value - joint.estimates[1].value) <
        0.05 * chained.estimates[0].standard_error);
}

TEST_CASE("A bound that holds a parameter is told of") {
  const TimeRecord record =
      displacements("decay", MotionKind::free, kOscillator.network(), kReleased, 4.0, 400);
  GreyBoxTask task{.network = kOscillator.network(),
                   .model_at = model_with({kReleased}, kPlaces),
                   .parameters = started_off(kReleased, kPlaces, {1.0, 1.0, 0.8, 1.0}),
                   .records = {record}};
  task.parameters[2].lower = 0.0;
  task.parameters[2].upper = 0.9 * kReleased.values.element[2];
  const Identification found = grey_box(task);
  REQUIRE(found.failure.empty());
  CHECK(found.estimates[2].value == Approx(task.parameters[2].upper));
  REQUIRE(found.notes.size() == 1);
  CHECK(found.notes[0].rfind("`F` is held by its upper bound", 0) == 0);
}

// On a belt that is always faster than the mass the friction is constant: x = x_e + (x_0 - x_e) cos(w t)
// about x_e = (F + P)/k.
TEST_CASE("A free motion is one without harmonics: a belt and a constant load act on") {
  using namespace mechanics;
  const Node ground{}, mass{NodeKind::mass, 0}, belt{NodeKind::prescribed, 0};
  const Network network{
      .masses = {"x"},
      .prescribed = {"belt"},
      .elements = {{"k", ElementType::spring, ground, mass}, {"F", ElementType::coulomb, belt, mass}},
      .excitations = {
          {ExcitationKind::force, 0, 1}, {ExcitationKind::belt, 0, 0}, {ExcitationKind::force, 0, 0}}};
  const double k = 2.0, F = 0.7, P = 0.4, x_0 = 1.5;
  const Model truth{
      {.omega = 1.3, .mass = {1.0}, .element = {k, F}, .excitation = {{100.0, 0.0}, {10.0, 0.0}, {P, 0.0}}},
      {{x_0}, {0.0}}};
  TimeRecord record{"free", MotionKind::free, {}, {{"x_displacement", 0, Signal::displacement, {}}}, {}};
  const double x_e = (F + P) / k, w = std::sqrt(k);
  for (int i = 0; i <= 200; ++i) {
    record.time.push_back(0.05 * i);
    record.channels[0].values.push_back(x_e + (x_0 - x_e) * std::cos(w * record.time.back()));
  }
  check_found(fit(network, truth, {element("k", 0), element("F", 1)}, {1.1, 0.8}, {record}), truth,
              {element("k", 0), element("F", 1)});
  // The load instead of the friction: its own derivative.
  const Place load{"P", [](Model& m) -> double& { return m.values.excitation[2].amplitude; }};
  check_found(fit(network, truth, {element("k", 0), load}, {1.1, 0.5}, {record}), truth,
              {element("k", 0), load});
}

TEST_CASE("A start without a meaning is refused") {
  const TimeRecord record =
      displacements("decay", MotionKind::free, kOscillator.network(), kReleased, 1.0, 100);
  CHECK_THROWS_AS(fit(kOscillator.network(), kReleased, kPlaces, {1.0, -1.0, 1.0, 1.0}, {record}),
                  mechanics::MechanicsError);
}

}  // namespace
}  // namespace frahm::identification::grey_box_test
