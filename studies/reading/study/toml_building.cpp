#include "studies/reading/study/toml_building.hpp"

#include <algorithm>

#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {

TomlValue toml_number(double value) {
  return {{}, value};
}

TomlValue toml_string(const std::string& value) {
  return {{}, value};
}

TomlValue toml_with_unit(double value, const std::string& unit) {
  return {{}, TomlTable{{"value", {}, toml_number(value)}, {"unit", {}, toml_string(unit)}}};
}

TomlValue toml_parameter(const Study& study, std::size_t parameter, double si) {
  const SpokenValue spoken = spoken_value(study, parameter, si);
  return spoken.unit.empty() ? toml_number(spoken.value) : toml_with_unit(spoken.value, spoken.unit);
}

TomlEntry* entry_of(TomlTable& table, const std::string& key) {
  const auto entry = std::find_if(table.begin(), table.end(), [&](auto& each) { return each.key == key; });
  return entry == table.end() ? nullptr : &*entry;
}

}  // namespace frahm::studies
