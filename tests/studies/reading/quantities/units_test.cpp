#include "studies/reading/quantities/units.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <string>
#include <utility>

namespace units_test {
namespace {

using frahm::studies::dimension_name;
using frahm::studies::Quantity;
using frahm::studies::UnitError;
using frahm::studies::UnitSystem;

// UDUNITS keeps factors such as pi/30 to full precision; a few roundings remain.
constexpr double rounding = 1e-14;

void check_si(const std::string& unit, Quantity quantity, double expected) {
  INFO(unit);
  CHECK_THAT(UnitSystem().to_si(1.0, unit, quantity), Catch::WithinRel(expected, rounding));
}

std::string complaint_about(const std::string& unit, Quantity expected) {
  try {
    UnitSystem().to_si(1.0, unit, expected);
  } catch (const UnitError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("an angular frequency counts Hz, kHz, 1/s and 1/min as cycles") {
  const double cycle = 2.0 * std::numbers::pi;
  const UnitSystem units;
  CHECK_THAT(units.to_si(1.0, "Hz", Quantity::angular_frequency),
             Catch::WithinRel(6.283185307179586, rounding));
  CHECK_THAT(units.to_si(60.0, "rpm", Quantity::angular_frequency),
             Catch::WithinRel(6.283185307179586, rounding));
  check_si("kHz", Quantity::angular_frequency, 1000.0 * cycle);
  check_si("1/s", Quantity::angular_frequency, cycle);
  check_si("1/min", Quantity::angular_frequency, cycle / 60.0);
  check_si("min-1", Quantity::angular_frequency, cycle / 60.0);
  check_si("cycle/s", Quantity::angular_frequency, cycle);
  check_si("revolution/minute", Quantity::angular_frequency, cycle / 60.0);
  check_si("rad/s", Quantity::angular_frequency, 1.0);
  check_si("rad s-1", Quantity::angular_frequency, 1.0);
  check_si("rad/min", Quantity::angular_frequency, 1.0 / 60.0);
  check_si("degree/s", Quantity::angular_frequency, std::numbers::pi / 180.0);
}

TEST_CASE("an angular acceleration counts Hz/s and rpm/s as cycles too") {
  const double cycle = 2.0 * std::numbers::pi;
  check_si("Hz/s", Quantity::angular_acceleration, cycle);
  check_si("rpm/s", Quantity::angular_acceleration, cycle / 60.0);
  check_si("1/s2", Quantity::angular_acceleration, cycle);
  check_si("rad/s2", Quantity::angular_acceleration, 1.0);
  check_si("degree s-2", Quantity::angular_acceleration, std::numbers::pi / 180.0);
}

TEST_CASE("units of mechanics convert to SI") {
  check_si("kN/m", Quantity::stiffness, 1e3);
  check_si("N/mm", Quantity::stiffness, 1e3);
  check_si("N m-1", Quantity::stiffness, 1.0);
  check_si("N s/m", Quantity::damping, 1.0);
  check_si("N.s/mm", Quantity::damping, 1e3);
  check_si("kg/s", Quantity::damping, 1.0);
  check_si("kN", Quantity::force, 1e3);
  check_si("g", Quantity::mass, 1e-3);
  check_si("t", Quantity::inertance, 1e3);
  check_si("mm", Quantity::length, 1e-3);
  check_si("um", Quantity::length, 1e-6);
  check_si("µm", Quantity::length, 1e-6);
  check_si("degree", Quantity::angle, std::numbers::pi / 180.0);
  check_si("rad", Quantity::angle, 1.0);
  check_si("1", Quantity::angle, 1.0);
  check_si("1", Quantity::number, 1.0);
  check_si("%", Quantity::number, 0.01);
}

TEST_CASE("every quantity's own SI unit has the factor 1") {
  for (int i = 0; i <= static_cast<int>(Quantity::angular_frequency); ++i) {
    const auto quantity = static_cast<Quantity>(i);
    check_si(std::string(si_unit(quantity)), quantity, 1.0);
  }
}

TEST_CASE("a quantity has its own power of the radian or none, and no other") {
  for (int i = 0; i <= static_cast<int>(Quantity::torsional_cubic_stiffness); ++i) {
    const auto quantity = static_cast<Quantity>(i);
    const std::string own(frahm::studies::si_unit(quantity));
    const int radians = UnitSystem().parse(own).radians;
    for (const auto& [text, by] : {std::pair{" rad", 1}, std::pair{" rad-1", -1}}) {
      INFO(own << text);
      CHECK((complaint_about(own + text, quantity) == "none") == (radians + by == 0));
    }
  }
}

TEST_CASE("a unit of the wrong dimension is named with its dimension and what was expected") {
  CHECK(complaint_about("N", Quantity::stiffness) ==
        "the unit \"N\" is that of a force, but a stiffness is expected (such as N/m, kN/m or N/mm)");
  CHECK_THAT(complaint_about("mm", Quantity::angular_frequency),
             Catch::Contains("a length, but an angular frequency"));
  CHECK_THAT(complaint_about("rad", Quantity::number), Catch::Contains("an angle, but a pure number"));
  CHECK_THAT(complaint_about("Hz", Quantity::angle), Catch::Contains("an angular frequency, but an angle"));
  CHECK_THAT(complaint_about("degC", Quantity::mass), Catch::Contains("not proportional"));
  CHECK_THAT(complaint_about("kg m3", Quantity::mass),
             Catch::Contains("that of a quantity in m3 kg, but a mass"));
  CHECK_THAT(complaint_about("K", Quantity::stiffness), Catch::Contains("a temperature"));
}

TEST_CASE("quantities of rotations are written with the radian or without it, and by degrees") {
  const double degree = std::numbers::pi / 180.0;
  check_si("N m/rad", Quantity::torsional_stiffness, 1.0);
  check_si("N m", Quantity::torsional_stiffness, 1.0);
  check_si("N m/degree", Quantity::torsional_stiffness, 1.0 / degree);
  check_si("N m s/rad", Quantity::torsional_damping, 1.0);
  check_si("N mm s", Quantity::torsional_damping, 1e-3);
  check_si("kg cm2", Quantity::inertia, 1e-4);
  check_si("kN m", Quantity::torque, 1e3);
  check_si("s/rad", Quantity::inverse_rate, 1.0);
  CHECK_THAT(complaint_about("N m rad", Quantity::torsional_stiffness),
             Catch::Contains("a torsional stiffness"));
  CHECK_THAT(complaint_about("N m/rad", Quantity::energy), Catch::Contains("that of a torsional stiffness"));
  CHECK_THAT(complaint_about("kg m2", Quantity::mass), Catch::Contains("that of a moment of inertia"));
}

TEST_CASE("a unit is not inverted to make it fit, as UDUNITS would") {
  CHECK_THAT(complaint_about("m/N", Quantity::stiffness), Catch::Contains("but a stiffness is expected"));
  CHECK_THAT(complaint_about("s", Quantity::angular_frequency), Catch::Contains("a time"));
}

TEST_CASE("what is no unit is refused") {
  CHECK_THAT(complaint_about("Nm/rd", Quantity::stiffness),
             Catch::Contains("is not a unit that UDUNITS knows"));
  CHECK_THAT(complaint_about("", Quantity::number), Catch::Contains("the unit is empty"));
  CHECK_THAT(complaint_about("1000", Quantity::number), Catch::Contains("is a number, not a unit"));
  CHECK_THAT(complaint_about("lg(re 1 mW)", Quantity::force), Catch::Contains("not proportional"));
  CHECK_THAT(complaint_about("s since 1990-01-01", Quantity::number), Catch::Contains("not proportional"));
  CHECK_THAT(complaint_about("g", Quantity::acceleration),
             Catch::Contains("did you mean \"gravity\", 9.80665 m/s2?"));
  CHECK_THAT(complaint_about(" N", Quantity::force), Catch::Contains("is not a unit"));
  CHECK_THAT(complaint_about(std::string(10'000, '('), Quantity::force),
             Catch::Contains("(((...\" is not a unit"));
}

}  // namespace
}  // namespace units_test
