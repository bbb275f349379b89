#include "studies/provenance/document_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/text/toml_writing.hpp"

namespace frahm::studies {
namespace {

constexpr double rounding_of_units = 1e-14;  // relative: of a value times the factor of its unit
constexpr std::size_t longest_list = 60;     // bytes of a list that is reported whole

// A single value; `si` where it is a number, of a unit where it has one.
struct Item {
  std::string text;
  std::optional<double> si;
  bool has_unit = false;
};

// What a study says under one name.
struct Fact {
  std::string name;                 // `mass "main": mass`
  std::vector<std::string> tables;  // those it is in, the outermost first
  bool is_list = false;
  std::vector<Item> items{};  // one unless it is a list
};

// The names in a list of tables or of settings, in their order.
struct Sequence {
  std::string name;  // "[[element]]"
  std::vector<std::string> members{};
};

// All that a study says, in the order of its file.
struct Facts {
  std::vector<Fact> list;
  std::set<std::string> tables;
  std::vector<Sequence> sequences;

  const Fact* find(const std::string& name) const {
    const auto fact = std::ranges::find(list, name, &Fact::name);
    return fact == list.end() ? nullptr : &*fact;
  }
};

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
enum class Labels { left_out, read };

const std::string* text_in(const TomlValue& table, std::string_view key) {
  const TomlEntry* entry = find_entry(table, key);
  return entry ? entry->value.as<std::string>() : nullptr;
}

// The unit that a table has for its numbers: of the bounds of a design variable, the values of an axis. That
// of a measured record is of what is in its file, that of a coordinate of what its expression gives.
std::string unit_of_numbers(const TomlValue& table, std::string_view section) {
  const std::string* unit = text_in(table, "unit");
  return unit && section != "excitation.record" && section != "coordinate" ? *unit : "";
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
  void add_table(const TomlValue& table, const std::string& section, const std::string& where) {
    if (labels_ == Labels::left_out && has_labels_alone(section)) return;
    if (!where.empty()) {
      facts_.tables.insert(where);
      inside_.push_back(where);
    }
    const std::string unit = unit_of_numbers(table, section);
    for (const TomlEntry& entry : *table.as<TomlTable>()) {
      const bool is_read = labels_ == Labels::read;
      if (!is_read && (is_label(section, entry.key) || (!unit.empty() && entry.key == "unit"))) continue;
      add_entry(entry, section, where, unit);
    }
    if (!where.empty()) inside_.pop_back();
  }

  void add_entry(const TomlEntry& entry, const std::string& section, const std::string& where,
                 const std::string& unit) {
    const std::string path = section.empty() ? entry.key : section + "." + entry.key;
    const StudyKey* key = key_of(section, entry.key);
    const std::string name = where.empty() ? "[" + entry.key + "]" : fmt::format("{}: {}", where, entry.key);
    if (key && key->form == KeyForm::tables && entry.value.as<TomlArray>()) {
      add_tables(*entry.value.as<TomlArray>(), path, where);
    } else if (key && key->form == KeyForm::settings && entry.value.as<TomlTable>()) {
      add_settings(*entry.value.as<TomlTable>(), section, name);
    } else if (entry.value.as<TomlTable>() && !keys_of(path).empty()) {
      add_table(entry.value, path, name);
    } else {
      add_value(entry.value, name, is_in_unit_of_table(key) ? unit : "");
    }
  }

  // The order of parameters changes nothing.
  void add_settings(const TomlTable& settings, const std::string& section, const std::string& name) {
    Sequence sequence{.name = name};
    for (const TomlEntry& each : settings) {
      add_value(each.value, section.empty() ? "parameter " + each.key : name + ": " + each.key, "");
      sequence.members.push_back(each.key);
    }
    if (!section.empty()) facts_.sequences.push_back(std::move(sequence));
  }

  void add_tables(const TomlArray& list, const std::string& section, const std::string& where) {
    const bool stands_alone = where.empty() || where.starts_with('[');  // its name tells enough
    Sequence sequence{.name = fmt::format("{}[[{}]]", stands_alone ? "" : where + ": ", section)};
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

  void add_value(const TomlValue& value, std::string name, const std::string& unit) {
    Fact fact{.name = std::move(name), .tables = inside_};
    if (const auto* list = value.as<TomlArray>()) {
      fact.is_list = true;
      for (const TomlValue& each : *list) fact.items.push_back(item_of(each, unit));
    } else {
      fact.items.push_back(item_of(value, unit));
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

bool is_same(const Item& a, const Item& b) {
  if (a.text == b.text) return true;
  if (!a.si || !b.si) return false;
  const double rounding = a.has_unit || b.has_unit ? rounding_of_units * std::abs(*a.si) : 0.0;
  return std::abs(*a.si - *b.si) <= rounding;
}

bool is_same(const Fact& a, const Fact& b) {
  return a.is_list == b.is_list &&
         std::ranges::equal(a.items, b.items,
                            [](const Item& one, const Item& other) { return is_same(one, other); });
}

std::string text_of(const Fact& fact) {
  if (!fact.is_list) return fact.items.front().text;
  std::string text;
  for (const Item& item : fact.items) text += (text.empty() ? "" : ", ") + item.text;
  return text.size() <= longest_list ? "[" + text + "]" : fmt::format("{} values", fact.items.size());
}

std::string change_of(const Fact& before, const Fact& after) {
  const std::string first = text_of(before), second = text_of(after);
  if (first != second) return fmt::format("{}: {}, now {}", before.name, first, second);
  // Two long lists of as many values: the first that differs.
  std::size_t at = 0, different = 0;
  for (std::size_t i = before.items.size(); i-- > 0;) {
    if (is_same(before.items[i], after.items[i])) continue;
    at = i;
    ++different;
  }
  return fmt::format("{}: value {} of {}: {}, now {}{}", before.name, at + 1, before.items.size(),
                     before.items[at].text, after.items[at].text,
                     different > 1 ? fmt::format(", and {} more", different - 1) : "");
}

// The outermost table of a fact that another study has not; "" where it has them all.
std::string missing_table(const Fact& fact, const Facts& other) {
  const auto table = std::ranges::find_if(
      fact.tables, [&](const std::string& each) { return !other.tables.contains(each); });
  return table == fact.tables.end() ? "" : *table;
}

// What both have, in the order of the first.
std::vector<std::string> common_members(const Sequence& of, const Sequence& with) {
  std::vector<std::string> common;
  std::ranges::copy_if(of.members, std::back_inserter(common), [&](const std::string& each) {
    return std::ranges::find(with.members, each) != with.members.end();
  });
  return common;
}

// "" where what both have is in the same order.
std::string change_of_order(const Sequence& before, const Sequence& after) {
  const auto was = common_members(before, after), is = common_members(after, before);
  const auto [first, now] = std::ranges::mismatch(was, is);
  return first == was.end() ? ""
                            : fmt::format("the order of {}: {} is now before {}", before.name, *now, *first);
}

Facts facts_of(const TomlValue& document, Labels labels = Labels::left_out) {
  return FactReading(labels).read(document);
}

}  // namespace

namespace {

// is_same: of two facts of one name.
template <class IsSame>
std::vector<std::string> changes_of_facts(const Facts& before, const Facts& after, const IsSame& same) {
  std::vector<std::string> changes;
  const auto tell = [&](const std::string& line) {  // a table that is new or gone is reported once
    if (std::ranges::find(changes, line) == changes.end()) changes.push_back(line);
  };
  for (const Fact& fact : before.list) {
    const Fact* found = after.find(fact.name);
    if (found && same(fact, *found)) continue;
    const std::string table = found ? "" : missing_table(fact, after);
    if (found)
      tell(change_of(fact, *found));
    else
      tell(table.empty() ? fmt::format("{}: {}, now gone", fact.name, text_of(fact)) : table + ": gone");
  }
  for (const Fact& fact : after.list) {
    if (before.find(fact.name)) continue;
    const std::string table = missing_table(fact, before);
    tell(table.empty() ? fmt::format("{}: new, {}", fact.name, text_of(fact)) : table + ": new");
  }
  for (const Sequence& sequence : before.sequences) {
    const auto found = std::ranges::find(after.sequences, sequence.name, &Sequence::name);
    const std::string change = found == after.sequences.end() ? "" : change_of_order(sequence, *found);
    if (!change.empty()) tell(change);
  }
  return changes;
}

}  // namespace

std::vector<std::string> document_changes(const TomlValue& kept, const TomlValue& now) {
  return changes_of_facts(facts_of(kept), facts_of(now),
                          [](const Fact& a, const Fact& b) { return is_same(a, b); });
}

std::vector<std::string> word_changes(const TomlValue& kept, const TomlValue& now) {
  const auto is_written_the_same = [](const Fact& a, const Fact& b) {
    return a.is_list == b.is_list && std::ranges::equal(a.items, b.items, {}, &Item::text, &Item::text);
  };
  return changes_of_facts(facts_of(kept, Labels::read), facts_of(now, Labels::read), is_written_the_same);
}

std::vector<std::string> rounding_changes(const TomlValue& kept, const TomlValue& now) {
  const Facts before = facts_of(kept), after = facts_of(now);
  std::vector<std::string> changes;
  for (const Fact& fact : before.list) {
    const Fact* found = after.find(fact.name);
    if (!found || !is_same(fact, *found)) continue;
    const auto is_exact = [](const Item& one, const Item& other) { return one.si == other.si; };
    if (!std::ranges::equal(fact.items, found->items, is_exact))
      changes.push_back(change_of_unit(fact.name, text_of(fact), text_of(*found)));
  }
  return changes;
}

std::string change_of_unit(const std::string& name, const std::string& before, const std::string& after) {
  return fmt::format("{}: {}, now {}: the same apart from rounding", name, before, after);
}

}  // namespace frahm::studies
