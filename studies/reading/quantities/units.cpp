#include "studies/reading/quantities/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>

#include "studies/reading/text/plain_text.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t longest_unit = 64;  // characters; no sensible unit is longer

struct QuantityEntry {
  std::string_view name, si_unit, written_si_unit, examples;
  std::array<int, 3> exponents;  // of metre, kilogram, second
  int radians = 0;               // of the radian, which a unit may leave out
};

// In the order of Quantity.
constexpr auto quantities = std::to_array<QuantityEntry>({
    {"a pure number", "1", "1", "1 or %", {0, 0, 0}},
    {"a length", "m", "m", "m, mm or um", {1, 0, 0}},
    {"a mass", "kg", "kg", "kg, g or t", {0, 1, 0}},
    {"an inertance", "kg", "kg", "kg, g or t", {0, 1, 0}},
    {"a force", "N", "N", "N, mN or kN", {1, 1, -2}},
    {"a stiffness", "N m-1", "N/m", "N/m, kN/m or N/mm", {0, 1, -2}},
    {"a damping", "N s m-1", "N s/m", "N s/m, kN s/m or N s/mm", {0, 1, -1}},
    {"an angle", "rad", "rad", "rad or degree", {0, 0, 0}, 1},
    {"an angular frequency", "rad s-1", "rad/s", "rad/s, rpm or Hz", {0, 0, -1}, 1},
    {"a speed", "m s-1", "m/s", "m/s or mm/s", {1, 0, -1}},
    {"a time", "s", "s", "s, ms or min", {0, 0, 1}},
    {"an inverse speed", "s m-1", "s/m", "s/m or s/mm", {-1, 0, 1}},
    {"an angular acceleration", "rad s-2", "rad/s2", "rad/s2, rpm/s or Hz/s", {0, 0, -2}, 1},
    {"an acceleration", "m s-2", "m/s2", "m/s2, mm/s2 or gravity", {1, 0, -2}},
    {"an energy", "J", "J", "J, mJ or N m", {2, 1, -2}},
    {"a moment of inertia", "kg m2", "kg m2", "kg m2 or g cm2", {2, 1, 0}},
    {"a torque", "N m", "N m", "N m, N mm or kN m", {2, 1, -2}},
    {"a torsional stiffness", "N m rad-1", "N m/rad", "N m/rad, N m or N m/degree", {2, 1, -2}, -1},
    {"a torsional damping", "N m s rad-1", "N m s/rad", "N m s/rad or N m s", {2, 1, -1}, -1},
    {"an inverse angular speed", "s rad-1", "s/rad", "s/rad or s", {0, 0, 1}, -1},
    {"a rate", "s-1", "1/s", "1/s or 1/min", {0, 0, -1}},
    {"a cubic stiffness", "N m-3", "N/m3", "N/m3, kN/m3 or N/mm3", {-2, 1, -2}},
    {"a torsional cubic stiffness", "N m rad-3", "N m/rad3", "N m/rad3 or N m", {2, 1, -2}, -3},
});

const QuantityEntry& entry(Quantity quantity) {
  return quantities[static_cast<std::size_t>(quantity)];
}

bool has_dimension(const Unit& unit, Quantity quantity) {
  if (unit.foreign || unit.exponents != entry(quantity).exponents) return false;
  return unit.radians == 0 || unit.radians == entry(quantity).radians;
}

// A unit as the visitor of UDUNITS reads it; proportional = false for temperatures, logarithms and dates.
struct Reading {
  Unit unit;
  bool proportional = true;
};

void count_base_unit(Reading& reading, const ut_unit* base, int power) {
  const char* symbol = ut_get_symbol(base, UT_ASCII);
  const std::string_view name = symbol ? symbol : "";
  if (name == "m") {
    reading.unit.exponents[0] += power;
  } else if (name == "kg") {
    reading.unit.exponents[1] += power;
  } else if (name == "s") {
    reading.unit.exponents[2] += power;
  } else if (name == "rad") {
    reading.unit.radians += power;
  } else {
    reading.unit.foreign = true;
  }
}

ut_status visit_basic(const ut_unit* unit, void* reading) {
  count_base_unit(*static_cast<Reading*>(reading), unit, 1);
  return UT_SUCCESS;
}

ut_status visit_product(const ut_unit*, int count, const ut_unit* const* bases, const int* powers,
                        void* reading) {
  for (int i = 0; i < count; ++i) count_base_unit(*static_cast<Reading*>(reading), bases[i], powers[i]);
  return UT_SUCCESS;
}

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* underlying, double offset, void* data);

ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void* reading) {
  static_cast<Reading*>(reading)->proportional = false;
  return UT_SUCCESS;
}

ut_status visit_logarithmic(const ut_unit*, double, const ut_unit*, void* reading) {
  static_cast<Reading*>(reading)->proportional = false;
  return UT_SUCCESS;
}

const ut_visitor visitor{visit_basic, visit_product, visit_galilean, visit_timestamp, visit_logarithmic};

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* underlying, double offset, void* data) {
  auto& reading = *static_cast<Reading*>(data);
  reading.unit.scale *= scale;
  if (offset != 0.0) reading.proportional = false;
  return ut_accept_visitor(underlying, &visitor, data);
}

// Reading the database takes ten times as long as the rest of a small study, so each thread reads it once.
// Null where it cannot be read, which is tried again.
std::shared_ptr<ut_system> system_of_thread() {
  thread_local std::shared_ptr<ut_system> system;
  if (!system)
    system = {ut_read_xml(nullptr), [](ut_system* read) {
                if (read) ut_free_system(read);
              }};
  return system;
}

}  // namespace

// UDUNITS prints its errors unless a handler is set; the previous handler is restored at the end.
struct UnitSystem::Database {
  ut_error_message_handler previous_handler = ut_set_error_message_handler(ut_ignore);
  std::shared_ptr<ut_system> system = system_of_thread();

  ~Database() { ut_set_error_message_handler(previous_handler); }
};

std::string_view quantity_name(Quantity quantity) {
  return entry(quantity).name;
}
std::string_view si_unit(Quantity quantity) {
  return entry(quantity).si_unit;
}
std::string_view written_si_unit(Quantity quantity) {
  return entry(quantity).written_si_unit;
}

std::string_view usual_units(Quantity quantity) {
  return entry(quantity).examples;
}

std::vector<Quantity> quantities_in(const Unit& unit) {
  std::vector<Quantity> found;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (has_dimension(unit, static_cast<Quantity>(i))) found.push_back(static_cast<Quantity>(i));
  }
  return found;
}

bool Unit::counts_cycles() const {
  return radians == 0 && has_dimension(*this, Quantity::angular_frequency);
}

double si_factor(const Unit& unit, Quantity expected) {
  if (!has_dimension(unit, expected)) {
    const QuantityEntry& wanted = entry(expected);
    const bool is_gram = expected == Quantity::acceleration && unit.text == "g";
    throw UnitError(
        rules::wrong_dimension,
        fmt::format("the unit \"{}\" is that of {}, but {} is expected (such as {}){}", unit.text,
                    dimension_name(unit), wanted.name, wanted.examples,
                    is_gram ? "; \"g\" is the gram: did you mean \"gravity\", 9.80665 m/s2?" : ""));
  }
  const bool rotates = expected == Quantity::angular_frequency || expected == Quantity::angular_acceleration;
  const bool cycles = rotates && unit.radians == 0;
  return cycles ? 2.0 * std::numbers::pi * unit.scale : unit.scale;
}

std::string dimension_name(const Unit& unit) {
  if (unit.foreign) return "a temperature, current, amount or light intensity";
  if (has_dimension(unit, Quantity::energy)) return "an energy or a torque";
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto quantity = static_cast<Quantity>(i);
    if (has_dimension(unit, quantity)) return std::string(quantity_name(quantity));
  }
  return "a quantity in " + coherent_unit(unit);
}

std::string dimension_with_unit(const Unit& unit) {
  for (std::size_t i = 1; i < quantities.size() && !unit.foreign; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    if (has_dimension(unit, quantity) && quantity != Quantity::angle)
      return fmt::format("{} ({})", dimension_name(unit), written_si_unit(quantity));
  }
  return dimension_name(unit);
}

Unit coherent_unit_of(Quantity quantity) {
  return {.text = std::string(si_unit(quantity)), .exponents = entry(quantity).exponents};
}

std::string coherent_unit(const Unit& unit) {
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto quantity = static_cast<Quantity>(i);
    if (has_dimension(unit, quantity)) return std::string(si_unit(quantity));
  }
  constexpr std::array<std::string_view, 4> symbols{"m", "kg", "s", "rad"};
  const std::array powers{unit.exponents[0], unit.exponents[1], unit.exponents[2], unit.radians};
  std::string text;
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    if (powers[i] == 0) continue;
    text += text.empty() ? "" : " ";
    text += powers[i] == 1 ? std::string(symbols[i]) : fmt::format("{}{}", symbols[i], powers[i]);
  }
  return text.empty() ? "1" : text;
}

UnitSystem::UnitSystem() : database_(std::make_unique<Database>()) {
  if (!database_->system) {
    throw StudyError(rules::unreadable_file, "{}",
                     "the unit database of UDUNITS-2 cannot be read (package libudunits2-data, or the "
                     "environment variable UDUNITS2_XML_PATH)");
  }
}

UnitSystem::~UnitSystem() = default;

Unit UnitSystem::parse(std::string_view text) const {
  const bool blank = text.find_first_not_of(' ') == std::string_view::npos;
  const bool padded = !blank && (text.front() == ' ' || text.back() == ' ');
  if (blank)
    throw UnitError(rules::unknown_unit,
                    "the unit is empty (leave it out for SI, or write \"1\" for a pure number)");
  if (text.size() > longest_unit || padded || text.find('\0') != std::string_view::npos) {
    throw UnitError(rules::unknown_unit, fmt::format("\"{}\" is not a unit", shortened(text, longest_unit)));
  }
  Reading reading;
  reading.unit.text = text;
  const std::unique_ptr<ut_unit, decltype(&ut_free)> unit(
      ut_parse(database_->system.get(), reading.unit.text.c_str(), UT_UTF8), &ut_free);
  if (!unit) {
    throw UnitError(
        rules::unknown_unit,
        fmt::format("\"{}\" is not a unit that UDUNITS knows (such as N/m, kN/m, N s/m, kg, mm, rpm, Hz, "
                    "rad/s, degree)",
                    text));
  }
  ut_accept_visitor(unit.get(), &visitor, &reading);
  if (!reading.proportional || !(reading.unit.scale > 0.0) || !std::isfinite(reading.unit.scale)) {
    throw UnitError(rules::unknown_unit,
                    fmt::format("the unit \"{}\" is not proportional to an SI unit", text));
  }
  const bool is_number = text != "1" && text.find_first_not_of("0123456789.eE+- ") == std::string_view::npos;
  if (is_number) throw UnitError(rules::unknown_unit, fmt::format("\"{}\" is a number, not a unit", text));
  return reading.unit;
}

std::optional<double> UnitSystem::pure_factor(std::string_view text) const {
  try {
    const Unit unit = parse(text);
    const bool is_pure =
        unit.exponents == std::array<int, 3>{} && !unit.foreign && unit.radians <= 1 && unit.radians >= 0;
    return is_pure ? std::optional(unit.scale) : std::nullopt;
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

double UnitSystem::to_si(double value, std::string_view unit, Quantity expected) const {
  return value * si_factor(parse(unit), expected);
}

}  // namespace frahm::studies
