#include "studies/reading/system/corner_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "solvers/transient/record_course.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/system/period_series.hpp"
#include "studies/reading/system/recorded_excitation.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using mechanics::Corner, mechanics::ExcitationKind;
using transient::RecordOf;

constexpr std::array<std::pair<const char*, RecordOf>, 4> corner_keys{
    {{"force", RecordOf::force},
     {"displacement", RecordOf::displacement},
     {"velocity", RecordOf::velocity},
     {"acceleration", RecordOf::acceleration}}};

// A number of a corner in SI.
double number_at(const StudyContext& context, const std::string& where, const TomlValue& value,
                 Quantity quantity) {
  if (value.as<std::string>())
    throw context.source.error_at(rules::wrong_type, value.position,
                                  "{}: expected a number or {{ value, unit }}, found {}; an expression that "
                                  "multiplies all values is given by \"scale\"",
                                  where, described(value));
  const NumberWithUnit number = read_number_with_unit(context, where, value);
  try {
    return number.value * (number.unit ? si_factor(*number.unit, quantity) : 1.0);
  } catch (const UnitError& error) {
    throw context.source.error_at(error.rule(), number.unit_position, "{}: {}", where, error.what());
  }
}

// Times rise from 0; a step is two values at one time.
void check_time(const StudySource& source, const std::string& where, const Position& position,
                const std::vector<Corner>& corners, RecordOf of) {
  const std::size_t last = corners.size() - 1;
  const double time = corners[last].at;
  if (last == 0 && time != 0.0)
    throw source.error_at(rules::wrong_order, position,
                          "{}: begins at t = {}; the first corner must be at t = 0", where, time);
  if (last == 0) return;
  const double before = corners[last - 1].at;
  if (time < before)
    throw source.error_at(rules::wrong_order, position,
                          "{}: t = {} is before that of the corner in front of it, {}; times must not fall",
                          where, time, before);
  if (time > before) return;
  if (of == RecordOf::displacement)
    throw source.error_at(rules::wrong_order, position,
                          "{}: is at t = {} as the corner in front of it; a displacement cannot jump", where,
                          time);
  if (last > 1 && corners[last - 2].at == time)
    throw source.error_at(rules::wrong_order, position,
                          "{}: is the third at t = {}; a step has one value before and one after it", where,
                          time);
}

std::vector<Corner> read_list(const NetworkReading& reading, const TomlSection& section, const CornerKey& key,
                              Quantity quantity) {
  const std::string_view unit = written_si_unit(quantity);
  const std::string expected = fmt::format("expected corners [t, {}]{}", key.key,
                                           unit.empty() ? "" : fmt::format(", in s and {}", unit));
  const auto* list = section.require(key.key).as<TomlArray>();
  if (!list)
    section.fail(rules::wrong_type, key.key, "{}: [[0, 0], [1, 5], ...], found {}", expected,
                 described(section.require(key.key)));
  if (list->size() < 2)
    section.fail(rules::too_few, key.key, "{} corner{}; at least two are needed", list->size(),
                 list->size() == 1 ? "" : "s");
  std::vector<Corner> corners;
  for (const TomlValue& item : *list) {
    const std::string where = fmt::format("{}: {}: corner {}", section.where(), key.key, corners.size() + 1);
    const auto* pair = item.as<TomlArray>();
    if (!pair || pair->size() != 2)
      throw section.source().error_at(rules::wrong_type, item.position, "{}: {}, found {}", where, expected,
                                      pair ? fmt::format("{} values", pair->size()) : described(item));
    if (!reading.follows_time && pair->front().as<TomlTable>())
      throw section.source().error_at(
          rules::beyond_schema(rules::key_without_use), pair->front().position,
          "{}: its time has a unit, but the last corner closes the period of [excitation] frequency, however "
          "long it is; leave out the unit",
          where);
    corners.push_back({number_at(reading.context, where, pair->front(), Quantity::time),
                       number_at(reading.context, where, pair->back(), quantity)});
    check_time(section.source(), where, item.position, corners, key.of);
  }
  if (corners.back().at == 0.0)
    section.fail(rules::wrong_order, key.key, "all corners are at t = 0; the last one must be later");
  return corners;
}

void refuse(const TomlSection& section, const char* key, const char* why) {
  if (section.find(key)) section.fail(rules::beyond_schema(rules::key_without_use), key, "{}", why);
}

// As a record, which drives one component.
void add_course(NetworkReading& reading, const TomlSection& section, const CornerKey& key,
                const mechanics::Node& node, const std::vector<Corner>& corners) {
  refuse(section, "orders", "belongs to corners that are a period; in a transient they are a course in time");
  refuse(section, "phase", "belongs to corners that are a period; in a transient they are a course in time");
  auto& [network, values, driving] = reading.result;
  transient::Record record;
  record.name = "corners";
  record.of = key.of;
  record.interpolation = transient::Interpolation::linear;
  record.is_corners = true;
  for (const Corner& corner : corners) {
    record.time.push_back(corner.at);
    record.values.push_back(corner.value);
  }
  driving.push_back({.excitation = network.excitations.size(),
                     .records = {std::move(record)},
                     .position = section.require(key.key).position});
  network.excitations.push_back(
      {key.of == RecordOf::force ? ExcitationKind::recorded_force : ExcitationKind::recorded_motion,
       node.index, 0});
  values.amplitude.push_back(read_value(reading, section, "scale", Quantity::number, 1.0));
  values.phase.push_back({});
  values.rod.push_back({});
}

}  // namespace

std::optional<CornerKey> corner_key(const TomlSection& section) {
  for (const auto& [key, of] : corner_keys) {
    const TomlValue* value = section.find(key);
    const bool may_be_a_number = of == RecordOf::velocity || of == RecordOf::acceleration;
    if (value && (!may_be_a_number || value->as<TomlArray>())) return CornerKey{key, of};
  }
  return std::nullopt;
}

void read_corners(NetworkReading& reading, const TomlSection& section, const CornerKey& key,
                  const mechanics::Node& node) {
  refuse(section, "order", "belongs to a harmonic; corners are a whole course");
  const mechanics::Network& network = reading.result.network;
  if (reading.follows_time && key.of == RecordOf::force && node.index >= network.masses.size())
    section.fail(rules::wrong_node, key.key,
                 "\"{}\" is a joint without mass, on which no course of a force can act; give it a mass",
                 network.joints[node.index - network.masses.size()]);
  const Quantity quantity = quantity_of_course(reading.result.network, key.of, node.index);
  const std::vector<Corner> corners = read_list(reading, section, key, quantity);
  if (reading.follows_time) return add_course(reading, section, key, node, corners);
  add_period(reading, section, {.of = key.of, .node = node, .corners = corners, .key = key.key});
}

void check_jumps(const NetworkReading& reading) {
  const mechanics::Network& network = reading.result.network;
  for (const DrivingRecord& driving : reading.result.driving) {
    const transient::Record& record = driving.records.front();
    if (!record.jumps() && !(record.of == RecordOf::velocity && record.steps())) continue;
    const std::size_t support = network.excitations[driving.excitation].node;
    const std::string inerter = transient::inerter_on(network, support);
    if (inerter.empty()) continue;
    throw reading.context.source.error_at(
        rules::wrong_node, driving.position,
        "motion of \"{}\": its velocity jumps at {}, and the inerter \"{}\" there would need an infinite "
        "force; give corners of {}",
        network.prescribed[support],
        record.of == RecordOf::velocity ? "a step" : "the corners of its displacement", inerter,
        record.of == RecordOf::velocity ? "a velocity without steps, or of an acceleration"
                                        : "its velocity or acceleration");
  }
}

}  // namespace frahm::studies
