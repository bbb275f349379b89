#pragma once

#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "studies/reading/text/rules.hpp"

namespace frahm::studies {

// The kinds of quantity a study has, each with its SI unit.
enum class Quantity {
  number,                     // 1
  length,                     // m
  mass,                       // kg
  inertance,                  // kg
  force,                      // N
  stiffness,                  // N/m
  damping,                    // N s/m
  angle,                      // rad
  angular_frequency,          // rad/s
  speed,                      // m/s
  time,                       // s
  inverse_speed,              // s/m
  angular_acceleration,       // rad/s2
  acceleration,               // m/s2
  energy,                     // J
  inertia,                    // kg m2
  torque,                     // N m
  torsional_stiffness,        // N m/rad
  torsional_damping,          // N m s/rad
  inverse_rate,               // s/rad
  rate,                       // 1/s, of a decay: no cycles
  cubic_stiffness,            // N/m3
  torsional_cubic_stiffness,  // N m/rad3
};

std::string_view quantity_name(Quantity quantity);    // with its article: "a stiffness"
std::string_view si_unit(Quantity quantity);          // for the record, in the form of CF: "N m-1"
std::string_view written_si_unit(Quantity quantity);  // for readers: "N/m"
std::string_view usual_units(Quantity quantity);      // for readers: "N/m, kN/m or N/mm"

// A unit that does not exist or has the wrong dimension; what() names the unit, its dimension and what was
// expected.
class UnitError : public std::runtime_error {
 public:
  UnitError(Rule rule, const std::string& message) : std::runtime_error(message), rule_(rule) {}
  Rule rule() const { return rule_; }

 private:
  Rule rule_;
};

// A unit as read: 1 unit = scale x (m^a kg^b s^c rad^d).
struct Unit {
  std::string text;                // as the user wrote it, which is a form UDUNITS reads
  double scale = 1.0;              // to the coherent SI unit of the same dimension
  std::array<int, 3> exponents{};  // of metre, kilogram, second
  int radians = 0;                 // exponent of the radian: rad/s is not 1/s
  bool foreign = false;            // contains kelvin, ampere, mole or candela

  // 1/s, Hz or 1/min: cycles where an angular frequency is meant, wrong by 2 pi where a plain rate is meant.
  bool counts_cycles() const;
};

// Value in SI = factor x value in this unit. Where an angular frequency or acceleration is expected 1/s, Hz
// and 1/min count cycles: 1 Hz = 60 rpm = 2 pi rad/s (UDUNITS alone takes 1 Hz = 1 rad/s). Throws UnitError
// for another dimension.
double si_factor(const Unit& unit, Quantity expected);

// The quantity of a unit, in words: "a stiffness", otherwise its dimension in base units: "m2 s-2".
std::string dimension_name(const Unit& unit);

// The quantities whose values may have this unit: of N m an energy, a torque, a torsional stiffness.
std::vector<Quantity> quantities_in(const Unit& unit);

// The same with the SI unit, for readers: "a stiffness (N/m)", "a pure number", "a quantity in kg s2".
std::string dimension_with_unit(const Unit& unit);

// The SI unit of a quantity, radians left out.
Unit coherent_unit_of(Quantity quantity);

// The coherent SI unit of the same dimension: "N s m-1" where it has a name, otherwise "m2 kg s-3"; "1" of a
// number.
std::string coherent_unit(const Unit& unit);

// The units UDUNITS-2 knows. Reading its database costs some milliseconds; UDUNITS is not thread-safe, so a
// system is used by one thread, when a study is read.
class UnitSystem {
 public:
  UnitSystem();  // throws std::runtime_error if the database of UDUNITS is not installed
  ~UnitSystem();
  UnitSystem(const UnitSystem&) = delete;
  UnitSystem& operator=(const UnitSystem&) = delete;

  // Throws UnitError for a text that is not a unit, or not a proportional one (degC, dB, dates).
  Unit parse(std::string_view text) const;

  // The factor of a unit of pure numbers or angles, "degree" or "percent": of what a dimensionless study may
  // have too, in radians. Nothing of another unit, or of no unit.
  std::optional<double> pure_factor(std::string_view text) const;

  // `value` of `unit` in the SI unit of `expected`. Throws UnitError.
  double to_si(double value, std::string_view unit, Quantity expected) const;

 private:
  struct Database;
  std::unique_ptr<Database> database_;
};

}  // namespace frahm::studies
