#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <string>

#include "tests/known_answers/responses.hpp"

// Levers, gears, racks and inclined elements against the systems that they reduce to by hand.
namespace frahm::periodic::directions_test {
namespace {

using namespace mechanics;

constexpr double kSame = 1e-12;       // relative: only the order of roundings differs
constexpr double kOfNothing = 1e-13;  // of figures that are zero or rounding in both, absolute
constexpr double kAngle = 1e-12;      // [rad]

const Node ground{}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1}, base{NodeKind::prescribed, 0};

bool is_rounding(Measure measure) {
  return measure == Measure::residual || measure == Measure::energy_balance;
}

// Every standard figure of `lever` is that of `reduced` of the same name, times the factor of its owner:
// lengths of what is counted otherwise. Energies, shares and counts have none. The error bound is that of the
// mass that moves most, so it has the factor of "all".
using Factors = std::map<std::string, double>;
void compare(Responses& lever, Responses& reduced, const Factors& factors) {
  for (const Quantity& quantity : standard_quantities(lever.network())) {
    const auto description = describe(quantity, lever.network(), false);
    if (is_rounding(quantity.measure)) continue;
    const bool is_length =
        description.unit == "m" || (description.unit == "rad" && !is_angle(quantity.measure));
    double factor = 1.0;
    for (const auto& [owner, of_owner] : factors) {
      if (is_length && description.name.rfind(owner, 0) == 0) factor = of_owner;
    }
    const double found = lever[description.name], expected = factor * reduced[description.name];
    INFO(description.name << " [" << description.unit << "]");
    if (is_angle(quantity.measure)) {
      CHECK(std::abs(std::remainder(found - expected, 2.0 * std::numbers::pi)) < kAngle);
    } else {
      CHECK_THAT(found, Catch::WithinRel(expected, kSame) || Catch::WithinAbs(expected, kOfNothing));
    }
  }
}

// Mass on a guide that rubs; a lever of arms a, b on a pivot leads to a spring, a damper and a second guide.
Network lever_with(double ratio) {
  const Direction arm{{first, ratio}, {ground, -ratio}};
  return {.masses = {"x"},
          .elements = {{"spring", ElementType::spring, arm},
                       {"damper", ElementType::damper, arm},
                       {"brace", ElementType::jenkins, arm},
                       {"guide", ElementType::coulomb, arm},
                       {"mount", ElementType::spring, ground, first}},
          .excitations = {{ExcitationKind::force, 0, 1}}};
}

TEST_CASE("a spring, a damper, a brace and a guide at the other arm of a lever act by its ratio") {
  // F on the arm is ratio F on the mass, k is ratio^2 k.
  const double ratio = -2.75;
  Responses lever(lever_with(ratio)), reduced(lever_with(1.0));
  for (const double omega : {0.4, 0.9, 1.3, 2.5}) {
    for (const double F : {0.0, 0.05, 0.2}) {
      INFO("omega " << omega << ", F " << F);
      const double k = 0.1, c = 0.02;
      const NetworkValues values{.omega = omega,
                                 .mass = {1.0},
                                 .element = {k, c, 0.05, F, 1.0},
                                 .excitation = {{1.0, 0.3}},
                                 .second = {0.0, 0.0, 0.03, 0.0, 0.0}};
      NetworkValues by_hand = values;
      for (const std::size_t e : {0, 1, 2}) by_hand.element[e] *= ratio * ratio;
      by_hand.second[2] *= std::abs(ratio);
      by_hand.element[3] *= std::abs(ratio);
      REQUIRE(lever.solve(values).status == Status::ok);
      reduced.solve(by_hand);
      compare(lever, reduced, {{"spring", -ratio}});
      CHECK_THAT(lever["guide_force_peak"],
                 Catch::WithinRel(reduced["guide_force_peak"] / -ratio, kSame) || Catch::WithinAbs(0.0, 0.0));
      CHECK_THAT(lever["force_transmissibility"], Catch::WithinRel(reduced["force_transmissibility"], kSame));
    }
  }
}

// Two rotors on torsion springs and dampers, whose teeth mesh by a spring and a damper at radii r and R; a
// brake on the second one. By hand: masses J/r^2, J/R^2 that move along, the second one the other way.
TEST_CASE("a pair of gears is two masses of J/r^2 between which the teeth are a spring") {
  const double r = 0.05, R = 0.16, J = 0.02, big = 0.5;
  const Direction mesh{{first, r}, {second, R}};
  Network gears{.masses = {"pinion", "wheel"},
                .elements = {{"shaft", ElementType::spring, ground, first},
                             {"bearing", ElementType::damper, ground, first},
                             {"teeth", ElementType::spring, mesh},
                             {"oil", ElementType::damper, mesh},
                             {"brake", ElementType::coulomb, ground, second},
                             {"bush", ElementType::damper, ground, second}},
                .excitations = {{ExcitationKind::force, 0, 1}}};
  gears.rotation = {true, true};
  for (const std::size_t e : {0, 1, 4, 5})
    gears.elements[e].rotational = gears.elements[e].twists_ground = true;
  Network straight = gears;
  straight.rotation.clear();
  straight.elements[2].along = straight.elements[3].along = between(second, first);
  for (Element& element : straight.elements) element.rotational = element.twists_ground = false;

  Responses rotors(gears), masses(straight);
  for (const double omega : {8.0, 22.0, 60.0}) {
    for (const double T : {0.0, 0.4, 1.5}) {
      INFO("omega " << omega << ", T " << T);
      const NetworkValues values{.omega = omega,
                                 .mass = {J, big},
                                 .element = {40.0, 0.3, 9e3, 50.0, T, 0.2},
                                 .excitation = {{3.0, 0.0}}};
      const NetworkValues by_hand{.omega = omega,
                                  .mass = {J / (r * r), big / (R * R)},
                                  .element = {40.0 / (r * r), 0.3 / (r * r), 9e3, 50.0, T / R, 0.2 / (R * R)},
                                  .excitation = {{3.0 / r, 0.0}}};
      REQUIRE(rotors.solve(values).status == Status::ok);
      masses.solve(by_hand);
      // The wheel turns the other way: half a turn of phase, which remainder() below 2 pi would not forgive.
      for (const char* figure : {"pinion_peak", "pinion_amplitude", "pinion_rms", "shaft_stroke"})
        CHECK_THAT(rotors[figure], Catch::WithinRel(masses[figure] / r, kSame));
      for (const char* figure : {"wheel_peak", "wheel_amplitude", "wheel_rms"})
        CHECK_THAT(rotors[figure], Catch::WithinRel(masses[figure] / R, kSame));
      for (const char* figure :
           {"teeth_stroke", "brake_stops", "brake_regime", "brake_energy", "energy_input", "floquet_radius",
            "teeth_force_peak", "natural_frequency_1", "modal_damping_2"})
        CHECK_THAT(rotors[figure],
                   Catch::WithinRel(masses[figure], kSame) || Catch::WithinAbs(masses[figure], kOfNothing));
      CHECK_THAT(rotors["brake_stuck_fraction"], Catch::WithinAbs(masses["brake_stuck_fraction"], kSame));
      const double turned = rotors["wheel_phase"] - masses["wheel_phase"] - std::numbers::pi;
      CHECK(std::abs(std::remainder(turned, 2.0 * std::numbers::pi)) < kAngle);
    }
  }
}

// A mass that moves in a plane, x and y, on equal springs; a spring, a damper and a guide at an angle. By
// hand: its displacement along them and across.
TEST_CASE("an inclined spring, damper and guide act along their direction and leave what is across alone") {
  const double angle = 0.7, cos = std::cos(angle), sin = std::sin(angle);
  const auto network = [](const Direction& strut) {
    return Network{.masses = {"x", "y"},
                   .elements = {{"kx", ElementType::spring, ground, first},
                                {"ky", ElementType::spring, ground, second},
                                {"cx", ElementType::damper, ground, first},
                                {"cy", ElementType::damper, ground, second},
                                {"spring", ElementType::spring, strut},
                                {"damper", ElementType::damper, strut},
                                {"guide", ElementType::coulomb, strut}},
                   .excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 1, 1}}};
  };
  Responses plane(network({{first, cos}, {second, sin}, {ground, -1.0}})),
      along(network(between(ground, first)));
  for (const double omega : {0.5, 1.1, 1.9}) {
    for (const double F : {0.0, 0.1, 0.6}) {
      INFO("omega " << omega << ", F " << F);
      // A force of 1 along the strut and one of 0.4 across it.
      const NetworkValues rotated{.omega = omega,
                                  .mass = {1.0, 1.0},
                                  .element = {1.0, 1.0, 0.06, 0.06, 0.5, 0.04, F},
                                  .excitation = {{1.0, 0.0}, {0.4, 0.0}}};
      NetworkValues values = rotated;
      values.excitation = {{cos - 0.4 * sin, 0.0}, {sin + 0.4 * cos, 0.0}};
      REQUIRE(plane.solve(values).status == Status::ok);
      along.solve(rotated);
      for (const char* figure : {"spring_stroke", "guide_stops", "guide_stuck_fraction", "guide_regime",
                                 "guide_energy", "damper_energy", "guide_force_peak", "spring_force_peak",
                                 "floquet_radius", "energy_input", "natural_frequency_2", "modal_damping_1"})
        CHECK_THAT(plane[figure],
                   Catch::WithinRel(along[figure], kSame) || Catch::WithinAbs(along[figure], kOfNothing));
      // rms^2 is the same in any direction of the axes.
      const auto square = [](const Responses& of) {
        return of["x_rms"] * of["x_rms"] + of["y_rms"] * of["y_rms"];
      };
      CHECK_THAT(square(plane), Catch::WithinRel(square(along), kSame));
    }
  }
}

// A rack on a machine drives a pinion of radius r with a flywheel of inertia J, through teeth that yield. By
// hand: a mass J/r^2 after a spring. With rigid teeth the flywheel is an inerter of J/r^2, written as one
// that acts along the angle x/r.
TEST_CASE("a flywheel behind a rack and pinion is a mass of J/r^2, and behind rigid teeth an inerter") {
  const double r = 0.03, J = 0.004;
  const Direction teeth{{first, 1.0}, {second, -r}};
  const auto network = [&](const Direction& mesh, bool turns) {
    Network result{.masses = {"machine", "flywheel"},
                   .elements = {{"mount", ElementType::spring, ground, first},
                                {"damper", ElementType::damper, ground, first},
                                {"teeth", ElementType::spring, mesh},
                                {"mesh", ElementType::damper, mesh},
                                {"bearing", ElementType::coulomb, ground, second},
                                {"oil", ElementType::damper, ground, second}},
                   .excitations = {{ExcitationKind::force, 0, 1}}};
    if (turns) result.rotation = {false, true};
    for (const std::size_t e : {4, 5})
      result.elements[e].rotational = result.elements[e].twists_ground = turns;
    return result;
  };
  Responses turning(network(teeth, true)), sliding(network(between(second, first), false));
  for (const double omega : {10.0, 25.0, 90.0}) {
    for (const double T : {0.0, 0.01, 0.05}) {
      INFO("omega " << omega << ", T " << T);
      const NetworkValues values{.omega = omega,
                                 .mass = {20.0, J},
                                 .element = {2e4, 60.0, 3e4, 30.0, T, 1e-3},
                                 .excitation = {{10.0, 0.0}}};
      NetworkValues by_hand = values;
      by_hand.mass[1] = J / (r * r);
      by_hand.element[4] = T / r;
      by_hand.element[5] = 1e-3 / (r * r);
      REQUIRE(turning.solve(values).status == Status::ok);
      sliding.solve(by_hand);
      for (const char* figure : {"machine_peak", "machine_rms", "mount_stroke", "teeth_stroke",
                                 "bearing_stops", "bearing_stuck_fraction", "bearing_regime",
                                 "bearing_energy", "floquet_radius", "natural_frequency_2"})
        CHECK_THAT(turning[figure],
                   Catch::WithinRel(sliding[figure], kSame) || Catch::WithinAbs(sliding[figure], kOfNothing));
      CHECK_THAT(turning["flywheel_peak"], Catch::WithinRel(sliding["flywheel_peak"] / r, kSame));
    }
  }
  const auto rigid = [&](const Direction& along, bool turns) {
    Network result{.masses = {"machine"},
                   .elements = {{"mount", ElementType::spring, ground, first},
                                {"damper", ElementType::damper, ground, first},
                                {"inerter", ElementType::inerter, along},
                                {"guide", ElementType::coulomb, ground, first}},
                   .excitations = {{ExcitationKind::force, 0, 1}}};
    result.elements[2].rotational = turns;
    return result;
  };
  Responses flywheel(rigid({{first, 1.0 / r}, {ground, -1.0 / r}}, true)),
      inerter(rigid(between(ground, first), false));
  for (const double F : {0.0, 2.0, 6.0}) {
    const NetworkValues values{
        .omega = 30.0, .mass = {20.0}, .element = {2e4, 60.0, J, F}, .excitation = {{10.0, 0.0}}};
    NetworkValues by_hand = values;
    by_hand.element[2] = J / (r * r);
    REQUIRE(flywheel.solve(values).status == Status::ok);
    inerter.solve(by_hand);
    INFO("F " << F);
    for (const Quantity& quantity : standard_quantities(flywheel.network())) {
      if (is_rounding(quantity.measure)) continue;
      const std::string name = describe(quantity, flywheel.network(), false).name;
      INFO(name);
      CHECK_THAT(flywheel[name],
                 Catch::WithinRel(inerter[name], kSame) || Catch::WithinAbs(inerter[name], kOfNothing));
    }
  }
}

// M + m, m l; m l, m l^2: a pendulum on a base. Its bob moves by x + l theta, so it is an inerter of its mass
// along that; gravity holds it by m g l.
TEST_CASE(
    "a pendulum on a base is an inerter along x + l theta, and the force on its supports is the base's") {
  using Complex = std::complex<double>;
  const double M = 100.0, m = 6.0, l = 0.4, g = 9.81, K = 4e4, C = 120.0, d = 0.05;
  Network network{.masses = {"base", "pendulum"},
                  .elements = {{"mount", ElementType::spring, ground, first},
                               {"damper", ElementType::damper, ground, first},
                               {"bob", ElementType::inerter, {{first, 1.0}, {second, l}}},
                               {"gravity", ElementType::spring, ground, second},
                               {"hinge", ElementType::damper, ground, second}},
                  .excitations = {{ExcitationKind::force, 0, 1}}};
  network.rotation = {false, true};
  for (const std::size_t e : {3, 4})
    network.elements[e].rotational = network.elements[e].twists_ground = true;
  Responses pendulum(network);
  for (const double omega : {3.0, 4.8, 20.0, 31.0}) {
    pendulum.solve(
        {.omega = omega, .mass = {M, 0.0}, .element = {K, C, m, m * g * l, d}, .excitation = {{50.0, 0.0}}});
    const Complex s(0.0, omega);
    const Complex a = (M + m) * s * s + C * s + K, b = m * l * s * s,
                  e = m * l * l * s * s + d * s + m * g * l;
    const Complex x = 50.0 * e / (a * e - b * b), theta = -b / e * x, on_ground = (K + C * s) * x;
    INFO("omega " << omega);
    CHECK_THAT(pendulum["base_amplitude"], Catch::WithinRel(std::abs(x), 1e-11));
    CHECK_THAT(pendulum["pendulum_amplitude"], Catch::WithinRel(std::abs(theta), 1e-11));
    CHECK_THAT(pendulum["transmitted_force"], Catch::WithinRel(std::abs(on_ground), 1e-11));
    CHECK_THAT(pendulum["force_transmissibility"], Catch::WithinRel(std::abs(on_ground) / 50.0, 1e-9));
  }
}

TEST_CASE("quantities of rotations are in rad and N m, those of lengths in m and N") {
  Network network{.masses = {"machine", "flywheel"},
                  .prescribed = {"floor"},
                  .elements = {{"teeth", ElementType::spring, {{first, 1.0}, {second, -0.03}}},
                               {"shaft", ElementType::coulomb, ground, second},
                               {"mount", ElementType::spring, base, first}},
                  .excitations = {{ExcitationKind::motion, 0, 1}}};
  network.rotation = {false, true};
  network.elements[1].rotational = network.elements[1].twists_ground = true;
  const auto unit = [&](const std::string& name) {
    const auto quantity = find_quantity(name, network);
    REQUIRE(quantity);
    return describe(*quantity, network, false).unit;
  };
  CHECK(unit("machine_peak") == "m");
  CHECK(unit("flywheel_peak") == "rad");
  CHECK(unit("flywheel_velocity_peak") == "rad s-1");
  CHECK(unit("flywheel_acceleration_peak") == "rad s-2");
  CHECK(unit("flywheel_transmissibility") == "rad m-1");
  CHECK(unit("flywheel_phase") == "rad");
  CHECK(unit("teeth_stroke") == "m");
  CHECK(unit("teeth_force_peak") == "N");
  CHECK(unit("shaft_stroke") == "rad");
  CHECK(unit("shaft_force_peak") == "N m");
  CHECK(unit("shaft_energy") == "J");
  CHECK(unit("transmitted_force") == "N m");  // of the shaft, which alone stands on the ground
  CHECK(unit("floor_transmitted_force") == "N");
  CHECK(unit("error_bound") == "m");
  network.elements[2].along[0].node = ground;
  CHECK(unit("transmitted_force") == "N");
  CHECK(describe(*find_quantity("flywheel_peak", network), network, true).unit == "1");
}

TEST_CASE("contacts along equal or opposite directions are one, and no others") {
  const Direction strut{{first, 0.6}, {second, 0.8}}, back{{second, -0.8}, {first, -0.6}, {ground, 1.0}},
      longer{{first, 1.2}, {second, 1.6}};
  const Network network{.masses = {"x", "y"},
                        .elements = {{"one", ElementType::coulomb, strut},
                                     {"back", ElementType::coulomb, back},
                                     {"longer", ElementType::coulomb, longer},
                                     {"x_guide", ElementType::coulomb, ground, first}}};
  const Assembly assembly(network);
  CHECK(assembly.contacts() == 3);
  CHECK(assembly.shares()[1].contact == assembly.shares()[0].contact);
  CHECK(assembly.shares()[1].orientation == -1.0);
  CHECK(assembly.shares()[2].contact != assembly.shares()[0].contact);
}

}  // namespace
}  // namespace frahm::periodic::directions_test
