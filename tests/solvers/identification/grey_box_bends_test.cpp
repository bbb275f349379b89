#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "tests/solvers/fitted_motions.hpp"

// Stops, tables and static friction found again in motions that were made with them: the derivative of a
// motion goes through its touches and releases.
namespace frahm::identification::grey_box_bends_test {
namespace {

using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::Node,
    mechanics::NodeKind;

constexpr double kFound = 1e-8;  // relative, of parameters from motions without noise
constexpr double kNoise = 1e-3;  // of the measured peak

const Node ground{}, mass{NodeKind::mass, 0};

Place second_value(std::string name, std::size_t e) {
  return {std::move(name), [e](Model& m) -> double& { return m.values.second[e]; }};
}
Place clearance(std::size_t e, std::size_t bend = 0) {
  return {"D", [e, bend](Model& m) -> double& { return m.values.bends[e][bend].place; }};
}
Place contact_stiffness(std::size_t e, std::size_t bend = 0) {
  return {"k_stop", [e, bend](Model& m) -> double& { return m.values.bends[e][bend].stiffness; }};
}
Place contact_damping(std::size_t e, std::size_t bend = 0) {
  return {"c_stop", [e, bend](Model& m) -> double& { return m.values.bends[e][bend].damping; }};
}

struct Case {
  Network network;
  Model truth;
  std::vector<Place> places;
  std::vector<double> factors;
  MotionKind motion = MotionKind::forced;
  double duration = 40.0;

  TimeRecord record(int samples = 1500) const {
    return displacements("record", motion, network, truth, duration, samples);
  }
};

// A mass that its spring lets swing against a damped stop on one side.
Case bouncing() {
  Case of;
  of.network = {.masses = {"x"},
                .elements = {{"spring", ElementType::spring, ground, mass},
                             {"damper", ElementType::damper, ground, mass},
                             {"stop", ElementType::gap, ground, mass}}};
  of.network.elements[2].bends = {{1.0, &laws::elastic_stop}};
  of.truth = {{.omega = 1.0,
               .mass = {1.0},
               .element = {1.0, 0.02, 6.0},
               .second = {0.0, 0.0, 0.3},
               .bends = {{}, {}, {{0.4, 6.0, 0.3}}}},
              {{-1.0}, {0.0}}};
  of.places = {element("k", 0),      element("c", 1),    clearance(2),
               contact_stiffness(2), contact_damping(2), initial_displacement(0)};
  of.factors = {1.1, 0.6, 1.2, 0.7, 1.5, 1.1};
  of.motion = MotionKind::free;
  return of;
}

// A block that a slow force drags: it sticks harder than it slides.
Case dragging() {
  Case of;
  of.network = {.masses = {"x"},
                .elements = {{"spring", ElementType::spring, ground, mass},
                             {"damper", ElementType::damper, ground, mass},
                             {"guide", ElementType::coulomb, ground, mass}},
                .excitations = {{ExcitationKind::force, 0, 1}}};
  of.network.elements[2].has_static_force = true;
  of.truth = {{.omega = 0.4,
               .mass = {1.0},
               .element = {1.0, 0.2, 0.3},
               .excitation = {{1.0, 0.0}},
               .second = {0.0, 0.0, 0.6}},
              {{0.0}, {0.0}}};
  of.places = {element("k", 0), element("c", 1), element("F", 2), second_value("F_s", 2)};
  of.factors = {1.1, 0.8, 0.8, 1.15};
  return of;
}

// A spring that hardens to one side, and a shock absorber.
Case shaken_tables() {
  Case of;
  const Node base{NodeKind::prescribed, 0};
  of.network = {.masses = {"x"},
                .prescribed = {"base"},
                .elements = {{"spring", ElementType::spring, base, mass},
                             {"absorber", ElementType::damper, base, mass}},
                .excitations = {{ExcitationKind::motion, 0, 1}}};
  of.network.elements[0].bends = {{1.0, &laws::spring_bend}};
  of.network.elements[1].bends = {{1.0, &laws::damper_bend}, {-1.0, &laws::damper_bend}};
  of.truth = {{.omega = 0.9,
               .mass = {1.0},
               .element = {1.0, 0.2},
               .excitation = {{0.5, 0.3}},
               .bends = {{{0.3, 1.5, 0.0}}, {{0.2, 0.0, 0.3}, {0.3, 0.0, -0.1}}}},
              {{0.1}, {0.0}}};
  of.places = {element("k", 0), clearance(0),          contact_stiffness(0),
               element("c", 1), contact_damping(1, 0), contact_damping(1, 1)};
  of.factors = {1.1, 1.2, 0.8, 1.2, 0.8, 1.2};
  return of;
}

// The block on a belt of known speed.
Case squealing() {
  Case of;
  const Node belt{NodeKind::prescribed, 0};
  of.network = {
      .masses = {"x"},
      .prescribed = {"belt"},
      .elements = {{"spring", ElementType::spring, ground, mass}, {"rub", ElementType::coulomb, belt, mass}},
      .excitations = {{ExcitationKind::belt, 0, 0}}};
  of.network.elements[1].has_static_force = true;
  of.truth = {
      {.omega = 1.0, .mass = {1.0}, .element = {1.0, 0.2}, .excitation = {{0.1, 0.0}}, .second = {0.0, 0.5}},
      {{0.0}, {0.1}}};
  of.places = {element("k", 0),
               element("F", 1),
               second_value("F_s", 1),
               {"V", [](Model& m) -> double& { return m.values.excitation[0].amplitude; }}};
  of.factors = {1.05, 0.9, 1.05, 0.97};
  return of;
}

void check_found_exactly(const Case& of, std::vector<TimeRecord> records) {
  const Identification found = fit(of.network, of.truth, of.places, of.factors, std::move(records));
  INFO(found.failure);
  REQUIRE(found.failure.empty());
  Model truth = of.truth;
  for (std::size_t i = 0; i < of.places.size(); ++i) {
    const double off = found.estimates[i].value / of.places[i].of(truth) - 1.0;
    INFO(of.places[i].name << " off by " << off);
    CHECK(std::abs(off) <= kFound);
  }
}

TEST_CASE("Clearance, stiffness and damping of a stop are found in the decay of a mass that bounces on it") {
  check_found_exactly(bouncing(), {bouncing().record()});
}

TEST_CASE("Static and kinetic force are found in a driven motion with stops") {
  check_found_exactly(dragging(), {dragging().record()});
}

TEST_CASE("The points and slopes of tables are found in the motion of a shaken mass") {
  check_found_exactly(shaken_tables(), {shaken_tables().record()});
}

TEST_CASE("Both forces of friction, the spring and the belt's speed are found in stick and slip") {
  check_found_exactly(squealing(), {squealing().record()});
}

// Each 95 % interval holds the truth in all but a few of the records.
void check_intervals(const Case& of, int records, int at_least) {
  const TimeRecord clean = of.record(800);
  double peak = 0.0;
  for (const double x : clean.channels[0].values) peak = std::max(peak, std::abs(x));
  std::mt19937 random(20261123);
  std::vector<int> covered(of.places.size(), 0);
  for (int number = 0; number < records; ++number) {
    TimeRecord record = clean;
    add_noise(record, kNoise * peak, random);
    const Identification found = fit(of.network, of.truth, of.places, of.factors, {record});
    INFO("record " << number << ": " << found.failure);
    REQUIRE(found.failure.empty());
    Model truth = of.truth;
    for (std::size_t i = 0; i < of.places.size(); ++i) {
      const double value = of.places[i].of(truth);
      if (found.estimates[i].low <= value && value <= found.estimates[i].high) ++covered[i];
    }
  }
  for (std::size_t i = 0; i < of.places.size(); ++i) {
    INFO(of.places[i].name << " covered by " << covered[i] << " of " << records);
    CHECK(covered[i] >= at_least);
  }
}

TEST_CASE("Under noise the intervals of a stop, of static friction and of tables cover the truth", "[slow]") {
  for (const Case& of : {bouncing(), dragging(), shaken_tables()}) check_intervals(of, 20, 16);
}

Identification found_under_noise(const Case& of) {
  TimeRecord record = of.record(800);
  double peak = 0.0;
  for (const double x : record.channels[0].values) peak = std::max(peak, std::abs(x));
  std::mt19937 random(20261124);
  add_noise(record, kNoise * peak, random);
  return fit(of.network, of.truth, of.places, of.factors, {record});
}

// Up to a static force of 1.2 or so the block never sticks: the data say that it is below, and no more.
TEST_CASE("The interval of a static force that never holds reaches down to the force") {
  Case of = dragging();
  of.truth.values.omega = 0.8;
  of.truth.values.second[2] = 0.4;
  of.places = {element("F", 2), second_value("F_s", 2)};
  for (const double start : {1.2, 3.0}) {
    INFO("from " << start);
    of.factors = {0.9, start};
    const Identification found = found_under_noise(of);
    REQUIRE(found.failure.empty());
    CHECK(found.estimates[1].low <= 0.35);
    CHECK(found.estimates[1].high >= 0.4);
  }
}

TEST_CASE("A clearance that the motion does not reach is not determined upwards") {
  Case of = bouncing();
  of.truth.values.bends[2][0].place = 3.0;
  of.places = {element("k", 0), clearance(2)};
  for (const double start : {0.3, 0.5}) {
    INFO("from " << start);
    of.factors = {1.05, start};
    const Identification found = found_under_noise(of);
    REQUIRE(found.failure.empty());
    CHECK(std::isinf(found.estimates[1].high));
  }
}

// Two equal bumpers side by side, fitted to the motion against one as stiff as both.
TEST_CASE("A spring is found where two equal stops are touched and left at one instant") {
  for (const double c : {0.0, 10.0}) {
    INFO("damping " << c);
    const auto bumpers = [&](std::size_t count) {
      Network network{.masses = {"x"},
                      .elements = {{"spring", ElementType::spring, ground, mass},
                                   {"damper", ElementType::damper, ground, mass}}};
      Model model{{.omega = 1.0, .mass = {1.0}, .element = {1000.0, 1.0}}, {{0.03}, {0.0}}};
      model.values.second = {0.0, 0.0};
      model.values.bends = {{}, {}};
      const double share = 1.0 / static_cast<double>(count);
      for (std::size_t i = 0; i < count; ++i) {
        network.elements.emplace_back("stop" + std::to_string(i), ElementType::gap, ground, mass);
        network.elements.back().bends = {{1.0, &laws::elastic_stop}};
        model.values.element.push_back(1e4 * share);
        model.values.second.push_back(c * share);
        model.values.bends.push_back({{0.01, 1e4 * share, c * share}});
      }
      return std::pair{network, model};
    };
    const auto [one, truth] = bumpers(1);
    for (const int samples : {11, 30}) {
      const TimeRecord record =
          displacements("record", MotionKind::free, one, truth, 2e-3 * (samples - 1), samples);
      const auto [two, model] = bumpers(2);
      const Identification result = fit(two, model, {element("k", 0)}, {1.05}, {record});
      CHECK(result.failure == "");
      CHECK(result.converged);
      REQUIRE(result.estimates.size() == 1);
      CHECK_THAT(result.estimates[0].value, Catch::WithinRel(1000.0, kFound));
      CHECK(std::isfinite(result.estimates[0].standard_error));
    }
  }
}

}  // namespace
}  // namespace frahm::identification::grey_box_bends_test
