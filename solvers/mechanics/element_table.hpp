#pragma once

#include <array>
#include <optional>
#include <span>
#include <type_traits>

#include "solvers/laws/bend.hpp"
#include "solvers/laws/law.hpp"
#include "solvers/mechanics/dual.hpp"
#include "solvers/mechanics/network.hpp"

// The kinds of element, one row each: all other code reads its knowledge of them here. A new kind is a row of
// the table in element_table.cpp, and an enumerator of ElementType at its end; also the README's table of
// elements and the switches of tests/invariants. An element has at most two values: a third one needs a new
// list in NetworkValues, and in all code that goes through its lists.
namespace frahm::mechanics {

// What a value of an element measures, with its SI unit.
enum class Dimension {
  number,           // 1
  stiffness,        // N/m
  damping,          // N s/m
  inertance,        // kg
  force,            // N
  inverse_speed,    // s/m
  cubic_stiffness,  // N/m3
};

// The range in which a value must lie; every value must be finite.
enum class Range { finite, not_negative, positive };

struct ValueKey {
  const char* key = "";     // in a study file; "": the kind has no such value
  const char* symbol = "";  // in ElementKind::force; "": the key itself
  Dimension dimension = Dimension::number;
  Range range = Range::finite;
  bool is_optional = false;       // 0 where it is left out
  std::optional<ForceLaw> law{};  // the only law that has it; none: every law of the kind

  constexpr bool exists() const { return key[0] != '\0'; }
  constexpr bool exists_under(ForceLaw of_element) const {
    return exists() && law.value_or(of_element) == of_element;
  }
};

// What an element adds between its two nodes, u its relative displacement:
//   force k u + c u' + b u'' + s + the force of a contact of this limit,   s' = internal_stiffness u' -
//   internal_rate s
template <class Number>
struct Added {
  Number stiffness{}, damping{}, inertance{};  // k [N/m], c [N s/m], b [kg]
  Number limit{};                              // F [N], where the kind has a law
  Number internal_stiffness{};                 // of the spring whose force s is [N/m]
  Number internal_rate{};                      // [1/s]; 0: no damper lets s go
  Number internal_damping{};                   // of the damper that s runs through [N s/m]; 0: none
};

// One formula (value, second value, omega_h) -> Added, for numbers and for numbers with a derivative alike.
// So it is given as a generic lambda without captures.
class ElementFormula {
 public:
  template <class Formula>
  requires std::is_empty_v<Formula>
  constexpr ElementFormula(Formula)
      : numbers_(
            [](double value, double second, double omega_h) { return Formula{}(value, second, omega_h); }),
        duals_([](Dual value, Dual second, Dual omega_h) { return Formula{}(value, second, omega_h); }) {}

  Added<double> operator()(double value, double second, double omega_h) const {
    return numbers_(value, second, omega_h);
  }
  Added<Dual> operator()(Dual value, Dual second, Dual omega_h) const {
    return duals_(value, second, omega_h);
  }

 private:
  Added<double> (*numbers_)(double, double, double);
  Added<Dual> (*duals_)(Dual, Dual, Dual);
};

// What an element may have: its value, its second value, and those of smooth laws.
inline constexpr std::size_t first_smooth_number = 2;
inline constexpr std::size_t numbers_of_an_element = first_smooth_number + smooth_numbers.size();

struct ElementKind {  // NOLINT(cppcoreguidelines-pro-type-member-init): rows give what has no default
  ElementType type;
  const char* name;   // in a study file
  const char* force;  // its force by the symbols of its values, for readers; u across it, v = u'
  ValueKey value, second{};
  ElementFormula adds;
  const laws::Law* law = nullptr;  // of its contact; none: it has no contact
  bool has_internal_force = false;
  bool dissipates = false;
  bool depends_on_frequency = false;  // what it adds depends on omega_h
  bool holds = false;                 // holds a mass in position, if its other end is held
  ValueKey slope{};                 // of the arctan law, which smooths its contact; none: nothing smooths it
  ValueKey cubic{};                 // of what it may add in u^3
  bool stroke_is_standard = false;  // its stroke is among what an atlas shows
  // How it bends: at the points of a table that it may have in place of its value; at its stops, which only
  // push, or pull as well. None: it does not.
  const laws::Bend *table = nullptr, *stop = nullptr, *pulling_stop = nullptr;

  // All that a study file may give, those too that the kind has not.
  constexpr std::array<const ValueKey*, numbers_of_an_element> values() const {
    return std::array{&value, &second, &slope, &cubic};  // the smooth ones as in smooth_numbers
  }
  constexpr bool can_be_smoothed() const { return slope.exists(); }
  // It feels the acceleration across it and nothing else.
  bool is_inertia_alone() const;
};

std::span<const ElementKind> element_kinds();  // in the order of ElementType
const ElementKind& kind_of(ElementType type);
inline const ElementKind& kind_of(const Element& element) {
  return kind_of(element.type);
}
// Whether the element has a contact, of any law.
inline bool has_contact(const Element& element) {
  return kind_of(element).law != nullptr;
}

// Whether its force is in proportion to the motion across it.
bool is_linear(const Element& element);

// Whether it has one that is reported by itself; the sliders of an iwan element are reported together.
inline bool has_own_contact(const Element& element) {
  return has_contact(element) && element.parts == 1;
}

// The element by which element e is reported: the first of an iwan element's parts, or itself.
std::size_t reported_by(const Network& network, std::size_t e);

// The first element whose values depend on the frequency (hysteretic), or null.
const Element* frequency_dependent_element(const Network& network);

// The first element that is not linear with constant values, or null.
const Element* element_unfit_for_noise(const Network& network);

// Number i of element e, in the order of ElementKind::values(); 0 if it has none.
double number_of(const NetworkValues& values, std::size_t i, std::size_t e);
// The second value of the element; 0 if it has none.
double second_value(const NetworkValues& values, std::size_t element);

// The limit of a contact's force at rest, where the element has one of its own; otherwise 0.
double static_force(const Element& element, const NetworkValues& values, std::size_t index);

}  // namespace frahm::mechanics
