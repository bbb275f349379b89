#include "studies/provenance/document_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string_view>
#include <utility>
#include <variant>

#include "studies/reading/keys/repetition.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/toml_building.hpp"
#include "studies/reading/text/toml_writing.hpp"

namespace frahm::studies {
namespace {

const StudyKey* key_of(std::string_view section, std::string_view key) {
  const auto all = study_keys();
  const auto row = std::ranges::find_if(
      all, [&](const StudyKey& each) { return each.section == section && each.key == key; });
  return row == all.end() ? nullptr : &*row;
}

// What no number depends on.
bool is_label(std::string_view section, std::string_view key) {
  const StudyKey* const row = key_of(section, key);
  return row && row->use == Use::label;
}

const std::string* text_in(const TomlValue& table, std::string_view key) {
  const TomlEntry* entry = find_entry(table, key);
  return entry ? entry->value.as<std::string>() : nullptr;
}

// The unit that a table has for its numbers: of the bounds of a design variable, the values of an axis. That
// of a record or a period is of what is in its file, that of a coordinate of what its expression gives.
std::string unit_of_numbers(const TomlValue& table, std::string_view section) {
  const std::string* unit = text_in(table, "unit");
  return unit && !section.starts_with("excitation.") && section != "coordinate" ? *unit : "";
}

bool is_in_unit_of_table(const StudyKey* key) {
  if (!key || std::string_view(key->key) == "variation") return false;  // over the mean
  return key->form == KeyForm::number || key->form == KeyForm::numbers;
}

// What distinguishes the tables of a list.
std::string name_of(const TomlValue& table, const std::string& section, std::size_t number) {
  for (const char* naming : {"name", "parameter", "node", "on", "quantity"}) {
    if (text_in(table, naming))
      return label(table, section.substr(section.rfind('.') + 1), naming, section, number);
  }
  return fmt::format("[[{}]] {}", section, number);
}

class FactReading {
 public:
  explicit FactReading(Labels labels) : labels_(labels) {}

  Facts read(const TomlValue& document) {
    add_table(document, "", "");
    return std::move(facts_);
  }

 private:
  // outer_parameter: of the table around it.
  void add_table(const TomlValue& table, const std::string& section, const std::string& where,
                 const std::string& outer_parameter = "") {
    if (labels_ == Labels::left_out && has_labels_alone(section)) return;
    if (!where.empty()) {
      facts_.tables.insert(where);
      inside_.push_back(where);
    }
    const std::string unit = unit_of_numbers(table, section);
    const std::string* own = text_in(table, "parameter");
    const std::string parameter = own ? *own : outer_parameter;
    for (const TomlEntry& entry : *table.as<TomlTable>()) {
      const bool is_read = labels_ == Labels::read;
      if (!is_read && (is_label(section, entry.key) || (!unit.empty() && entry.key == "unit"))) continue;
      add_entry(entry, section, where, unit, parameter);
    }
    if (!where.empty()) inside_.pop_back();
  }

  void add_entry(const TomlEntry& entry, const std::string& section, const std::string& where,
                 const std::string& unit, const std::string& parameter) {
    const std::string path = section.empty() ? entry.key : section + "." + entry.key;
    const StudyKey* key = key_of(section, entry.key);
    const std::string name = where.empty() ? "[" + entry.key + "]" : fmt::format("{}: {}", where, entry.key);
    if (key && key->form == KeyForm::tables && entry.value.as<TomlArray>()) {
      add_tables(*entry.value.as<TomlArray>(), path, where, key);
    } else if (key && key->form == KeyForm::settings && entry.value.as<TomlTable>()) {
      add_settings(*entry.value.as<TomlTable>(), section, name, key);
    } else if (entry.value.as<TomlTable>() && !keys_of(path).empty()) {
      if (key && key->use != Use::nowhere) add_presence(name, key);
      add_table(entry.value, path, name, parameter);
    } else {
      const bool is_of_table = is_in_unit_of_table(key);
      add_value(entry.value, {.name = name,
                              .tables = inside_,
                              .key = key,
                              .unit = is_of_table ? unit : "",
                              .parameter = is_of_table ? parameter : ""});
    }
  }

  // The order of parameters changes nothing.
  void add_settings(const TomlTable& settings, const std::string& section, const std::string& name,
                    const StudyKey* key) {
    Sequence sequence{.name = name, .key = key};
    for (const TomlEntry& each : settings) {
      add_value(each.value, {.name = section.empty() ? "parameter " + each.key : name + ": " + each.key,
                             .tables = inside_,
                             .key = key,
                             .parameter = key->inside == KeyForm::plain_value ? each.key : ""});
      sequence.members.push_back(each.key);
    }
    if (!section.empty()) facts_.sequences.push_back(std::move(sequence));
  }

  void add_tables(const TomlArray& list, const std::string& section, const std::string& where,
                  const StudyKey* key) {
    const bool stands_alone = where.empty() || where.starts_with('[');  // its name tells enough
    Sequence sequence{.name = fmt::format("{}[[{}]]", stands_alone ? "" : where + ": ", section), .key = key};
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!list[i].as<TomlTable>()) continue;
      const std::string own = name_of(list[i], section, i + 1);
      std::string name = stands_alone ? own : fmt::format("{}: {}", where, own);
      if (facts_.tables.contains(name)) name += fmt::format(" ([[{}]] {})", section, i + 1);
      add_table(list[i], section, name);
      sequence.members.push_back(std::move(name));
    }
    facts_.sequences.push_back(std::move(sequence));
  }

  // That a table is there says something by itself: `branches = {}` is `branches = true`.
  void add_presence(const std::string& name, const StudyKey* key) {
    Fact fact{.name = name, .tables = inside_, .key = key};
    fact.tables.push_back(name);
    add_value({.position = {}, .content = true}, std::move(fact));
  }

  // fact: all but its value.
  void add_value(const TomlValue& value, Fact fact) {
    fact.value = value;
    if (const auto* list = value.as<TomlArray>()) {
      fact.is_list = true;
      for (const TomlValue& each : *list) fact.items.push_back(item_of(each, fact.unit));
    } else {
      fact.items.push_back(item_of(value, fact.unit));
    }
    facts_.list.push_back(std::move(fact));
  }

  Item item_of(const TomlValue& value, const std::string& unit_of_table) const {
    const TomlEntry* inner = find_entry(value, "value");
    const TomlValue& number = inner ? inner->value : value;
    const std::string* own_unit = inner ? text_in(value, "unit") : nullptr;
    if (!is_number(number)) return {.text = toml_in_line(value), .si = std::nullopt};
    const std::string unit = own_unit ? *own_unit : unit_of_table;
    const auto* whole = number.as<std::int64_t>();
    const double plain = whole ? static_cast<double>(*whole) : *number.as<double>();
    const std::string text = toml_in_line(number);
    if (unit.empty()) return {text, plain};
    return {fmt::format("{} {}", text, unit), in_si(plain, unit), true};
  }

  // Cycles are turns here, as in a frequency. None of a unit that another version knew.
  std::optional<double> in_si(double value, const std::string& text) const {
    try {
      const Unit unit = units_.parse(text);
      return value * unit.scale * (unit.counts_cycles() ? 2.0 * std::numbers::pi : 1.0);
    } catch (const UnitError&) {
      return std::nullopt;
    }
  }

  static bool has_labels_alone(const std::string& section) {
    const std::vector<std::string> keys = keys_of(section);
    return !keys.empty() &&
           std::ranges::all_of(keys, [&](const std::string& key) { return is_label(section, key); });
  }

  Labels labels_;
  UnitSystem units_;
  Facts facts_;
  std::vector<std::string> inside_;
};

}  // namespace

const Fact* Facts::find(const std::string& name) const {
  const auto fact = std::ranges::find(list, name, &Fact::name);
  return fact == list.end() ? nullptr : &*fact;
}

Facts facts_of(const TomlValue& document, Labels labels) {
  return FactReading(labels).read(document);
}

TomlValue document_of(const Study& study) {
  TomlValue document = with_repetitions(study.source, read_toml(study.source));
  TomlEntry* parameters = entry_of(std::get<TomlTable>(document.content), "parameters");
  if (!parameters || !parameters->value.as<TomlTable>()) return document;
  TomlTable in_this_run;
  for (TomlEntry& entry : std::get<TomlTable>(parameters->value.content)) {
    const auto i = study.parameters.find(entry.key);
    if (!i || has_axis(study, *i)) continue;
    if (const auto* number = std::get_if<double>(&study.parameters.list[*i].definition))
      entry.value = toml_parameter(study, *i, *number);
    in_this_run.push_back(std::move(entry));
  }
  parameters->value.content = std::move(in_this_run);
  return document;
}

}  // namespace frahm::studies
