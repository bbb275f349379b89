#include "studies/reading/system/damping_reading.hpp"

#include <fmt/format.h>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {
namespace {

// One ratio for all modes, or a list: the last one is that of all higher modes.
void read_modal(NetworkReading& reading, const TomlSection& section) {
  std::vector<StudyValue>& ratios = reading.result.values.damping;
  const auto read = [&](const std::string& where, const TomlValue& value) {
    ratios.push_back(read_value_at(reading, where, value, Quantity::number, range_in(section, "modal")));
  };
  const TomlValue& value = section.require("modal");
  const auto* list = value.as<TomlArray>();
  if (!list) return read("[damping]: modal", value);
  if (list->empty()) section.fail(rules::empty, "modal", "is an empty list; expected at least one ratio");
  const std::size_t modes = reading.result.network.masses.size();
  if (list->size() > modes)
    section.fail(rules::beyond_schema(rules::wrong_length), "modal",
                 "{} ratios are given, but the system has {} mode{}", list->size(), modes,
                 modes == 1 ? "" : "s");
  for (const TomlValue& each : *list)
    read(fmt::format("[damping]: modal: ratio {}", ratios.size() + 1), each);
}

void read_rayleigh(NetworkReading& reading, const TomlSection& section) {
  const auto* list = section.require("rayleigh").as<TomlArray>();
  if (!list || list->size() != 2)
    section.fail(list ? rules::wrong_length : rules::wrong_type, "rayleigh",
                 "expected two numbers: rayleigh = [a, b] is a M + b K, a in 1/s, b in s");
  const auto read = [&](const char* where, const TomlValue& value, Quantity quantity) {
    reading.result.values.damping.push_back(
        read_value_at(reading, where, value, quantity, range_in(section, "rayleigh")));
  };
  read("[damping]: rayleigh: a", list->front(), Quantity::rate);
  read("[damping]: rayleigh: b", list->back(), Quantity::time);
}

}  // namespace

void read_damping(NetworkReading& reading, const TomlValue& root) {
  const TomlEntry* entry = find_entry(root, "damping");
  if (!entry) return;
  const TomlSection section(reading.context.source, entry->value, "[damping]", "damping");
  const bool is_modal = section.find("modal") != nullptr;
  reading.result.network.damping =
      is_modal ? mechanics::DampingModel::modal : mechanics::DampingModel::rayleigh;
  is_modal ? read_modal(reading, section) : read_rayleigh(reading, section);
}

}  // namespace frahm::studies
