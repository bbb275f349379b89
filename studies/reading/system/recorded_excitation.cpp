#include "studies/reading/system/recorded_excitation.hpp"

#include <fmt/format.h>

#include <array>

#include "solvers/mechanics/rotation.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using mechanics::ExcitationKind;
using mechanics::NodeKind;
using transient::RecordOf;

const std::string record_path = "excitation.record";

struct PlaceKey {
  const char* key;
  RecordOf of;
};
constexpr std::array place_keys{
    PlaceKey{"acceleration_of", RecordOf::acceleration}, PlaceKey{"velocity_of", RecordOf::velocity},
    PlaceKey{"displacement_of", RecordOf::displacement}, PlaceKey{"force_on", RecordOf::force}};

std::string why_no_record(StudyKind kind) {
  if (kind == StudyKind::identify) return "its measured excitations are columns of [[identify.record]]";
  return fmt::format(
      "{} needs periodic responses, but a record does not repeat; use it with kind = \"transient\" or "
      "\"tune\"",
      kind_noun(kind));
}

}  // namespace

std::vector<TomlSection> record_sections(const StudySource& source, const TomlValue& excitation) {
  std::vector<TomlSection> sections;
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(source, excitation, record_path)) {
    ++number;
    std::string where = fmt::format("[[{}]] {}", record_path, number);
    for (const PlaceKey& each : place_keys) {
      if (find_entry(*table, each.key))
        where = label(*table, each.of == RecordOf::force ? "record of a force on" : "record of", each.key,
                      record_path, number);
    }
    sections.emplace_back(source, *table, std::move(where), record_path);
  }
  return sections;
}

// One of the keys is there: their group says so (keys/key_groups.cpp).
RecordedPlace place_of(const TomlSection& section) {
  const auto* const given =
      std::ranges::find_if(place_keys, [&](const PlaceKey& each) { return section.find(each.key); });
  return {given->key, section.text(given->key), given->of};
}

Quantity quantity_of_course(const mechanics::Network& network, RecordOf of, std::size_t node) {
  switch (of) {
    case RecordOf::acceleration:
      return Quantity::acceleration;
    case RecordOf::velocity:
      return Quantity::speed;
    case RecordOf::displacement:
      return Quantity::length;
    case RecordOf::force:
      break;
  }
  return mechanics::rotates(network, node) ? Quantity::torque : Quantity::force;
}

Quantity quantity_of(const RecordedPlace& place, const mechanics::Network& network) {
  const mechanics::Node node = *find_node(network, place.node);
  const bool is_joint = node.kind == NodeKind::joint;
  return quantity_of_course(network, place.of, is_joint ? network.masses.size() + node.index : node.index);
}

void refuse_records(const StudyContext& context, const TomlValue& excitation, StudyKind kind) {
  if (has(study_key("excitation", "record"), kind_name(kind))) return;
  if (const TomlEntry* entry = find_entry(excitation, "record"))
    throw context.source.error_at(rules::other_kind, entry->position, "[[{}]] is not part of {}: {}",
                                  record_path, kind_noun(kind), why_no_record(kind));
}

void read_recorded_components(NetworkReading& reading, const TomlValue& excitation) {
  auto& [network, values, driving] = reading.result;
  for (const TomlSection& section : record_sections(reading.context.source, excitation)) {
    const RecordedPlace place = place_of(section);
    const bool is_force = place.of == RecordOf::force;
    const std::size_t node =
        is_force ? read_forced_node(section, network, place.key) : find_node(network, place.node)->index;
    if (is_force && node >= network.masses.size())
      section.fail(rules::wrong_node, place.key,
                   "\"{}\" is a joint without mass, on which no recorded force can act; give it a mass",
                   place.node);
    network.excitations.push_back(
        {is_force ? ExcitationKind::recorded_force : ExcitationKind::recorded_motion, node, 0});
    values.amplitude.push_back(read_value(reading, section, "scale", Quantity::number, 1.0));
    values.phase.push_back({});
    values.rod.push_back({});
  }
}

}  // namespace frahm::studies
