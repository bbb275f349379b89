#include "studies/reading/system/characteristic_reading.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "solvers/flow/sizes.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using mechanics::ElementKind;

// Room for one more value of the characteristic.
void add_value(NetworkReading& reading, StudyCharacteristic& of, StudyValue value) {
  reading.result.values.points.push_back(std::move(value));
  ++of.count;
}

// One distance for both sides, or [lower, upper]; inf is no stop.
void read_stops(NetworkReading& reading, const TomlSection& section, const ElementKind& kind, bool rotational,
                StudyCharacteristic& of, mechanics::Element& element) {
  const TomlValue& clearance = section.require("clearance");
  const auto* pair = clearance.as<TomlArray>();
  if (pair && pair->size() != 2)
    section.fail(rules::wrong_length, "clearance",
                 "expected one distance for both sides, or two: [lower, upper], inf for no stop");
  const laws::Bend* law = section.boolean("tension") ? kind.pulling_stop : kind.stop;
  const auto add = [&](const TomlValue& value, double side) {
    if (const auto* number = value.as<double>(); number && *number == std::numeric_limits<double>::infinity())
      return;
    add_value(reading, of,
              read_value_at(reading, of.where, value, rotational ? Quantity::angle : Quantity::length,
                            range_in(section, "clearance")));
    of.sides.push_back(side);
    element.bends.push_back({side, law});
  };
  add(pair ? pair->front() : clearance, -1.0);
  add(pair ? pair->back() : clearance, 1.0);
  if (of.sides.empty())
    section.fail(rules::beyond_schema(rules::empty), "clearance", "has no stop on either side");
}

struct PointQuantities {
  Quantity place, force;
};

PointQuantities quantities_of_table(const StudyCharacteristic& of, bool rotational) {
  const Quantity of_displacement = rotational ? Quantity::angle : Quantity::length;
  const Quantity of_velocity = rotational ? Quantity::angular_frequency : Quantity::speed;
  return {of.of_velocity ? of_velocity : of_displacement, rotational ? Quantity::torque : Quantity::force};
}

void read_points(NetworkReading& reading, const TomlSection& section, bool rotational,
                 StudyCharacteristic& of) {
  const PointQuantities quantities = quantities_of_table(of, rotational);
  const std::string expected = fmt::format("expected points [{}, {}]", written_si_unit(quantities.place),
                                           written_si_unit(quantities.force));
  const auto* points = section.require("table").as<TomlArray>();
  if (!points) section.fail(rules::wrong_type, "table", "{}: [[-1, -5], [1, 5], ...]", expected);
  if (points->size() < 2)
    section.fail(rules::too_few, "table", "{} point{}; at least two are needed for a slope", points->size(),
                 points->size() == 1 ? "" : "s");
  const Range range = of.kind == StudyCharacteristic::Kind::curve ? Range::not_negative : Range::finite;
  std::size_t number = 0;
  for (const TomlValue& point : *points) {
    const std::string where = fmt::format("{}: point {}", of.where, ++number);
    const auto* pair = point.as<TomlArray>();
    if (!pair || pair->size() != 2)
      throw section.source().error_at(rules::wrong_type, point.position, "{}: {}, found {}", where, expected,
                                      pair ? fmt::format("{} values", pair->size()) : described(point));
    add_value(reading, of, read_value_at(reading, where, pair->front(), quantities.place, range));
    add_value(reading, of, read_value_at(reading, where, pair->back(), quantities.force, range));
  }
}

// Their sides follow from the numbers: set_characteristics().
void bend_at_inner_points(const ElementKind& kind, StudyCharacteristic& of, mechanics::Element& element) {
  const std::size_t inner = of.count / 2 - 2;
  of.sides.assign(inner, 1.0);
  element.bends.assign(inner, {1.0, kind.table});
}

// The exact law knows which bends an element is beyond by the bits of a word.
void check_number_of_bends(const NetworkReading& reading, const TomlSection& section,
                           const mechanics::Element& element) {
  std::size_t bends = element.bends.size();
  for (const mechanics::Element& other : reading.result.network.elements) bends += other.bends.size();
  if (bends <= periodic::kMostContacts) return;
  section.fail_here(rules::too_large,
                    "with it the system has {} stops and inner points of tables; at most {} can be followed",
                    bends, periodic::kMostContacts);
}

}  // namespace

StudyCharacteristic read_characteristic(NetworkReading& reading, const TomlSection& section, bool rotational,
                                        mechanics::Element& element) {
  using Kind = StudyCharacteristic::Kind;
  const ElementKind& kind = mechanics::kind_of(element);
  StudyCharacteristic of;
  of.first = reading.result.values.points.size();
  const bool has_table = kind.table != nullptr && section.find("table");
  const bool has_curve = element.law == mechanics::ForceLaw::stribeck;
  if (!has_table && !has_curve && kind.stop == nullptr) return of;
  of.kind = has_curve ? Kind::curve : has_table ? Kind::table : Kind::stops;
  of.of_velocity = has_curve || (has_table && kind.table->of_velocity);
  const char* key = of.kind == Kind::stops ? "clearance" : "table";
  of.where = fmt::format("{}: {}", section.where(), key);
  of.position = section.require(key).position;
  for (const mechanics::ValueKey* value : kind.values()) {
    if (has_table && section.find(value->key))
      section.fail(rules::one_of_two_keys, value->key,
                   "its table already gives the force, linear between its points; give only one of the two");
  }
  if (of.kind != Kind::stops) read_points(reading, section, rotational, of);
  if (has_table) bend_at_inner_points(kind, of, element);
  if (of.kind == Kind::stops) {
    read_stops(reading, section, kind, rotational, of, element);
  }
  check_number_of_bends(reading, section, element);
  return of;
}

void set_characteristics(Study& study) {
  std::vector<double> parameters = study.parameters.nominal();
  study.parameters.complete(std::span<double>(parameters));
  for (std::size_t e = 0; e < study.values.characteristic.size(); ++e) {
    StudyCharacteristic& of = study.values.characteristic[e];
    if (of.kind != StudyCharacteristic::Kind::table) continue;
    for (std::size_t b = 0; b < of.sides.size(); ++b) {
      const Expression& place = study.values.points_of(e)[2 * (b + 1)].expression;
      of.sides[b] = place.evaluate(std::span<const double>(parameters)) > 0.0 ? 1.0 : -1.0;
      study.network.elements[e].bends[b].side = of.sides[b];
    }
  }
}

}  // namespace frahm::studies
