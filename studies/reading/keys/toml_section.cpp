#include "studies/reading/keys/toml_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "studies/reading/keys/key_groups.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t longest_label = 40;  // bytes of a name shown in a message

[[noreturn]] void fail_at(Rule rule, const StudySource& source, const TomlValue& value,
                          const std::string& where, std::string_view message) {
  throw source.error_at(rule, value.position, "{}: {}", where, message);
}

std::string key_of(const std::string& where, std::string_view key) {
  return fmt::format("{}: {}", where, key);
}

std::vector<std::string> quoted(const std::vector<std::string>& words) {
  std::vector<std::string> result;
  for (const std::string& word : words) result.push_back(fmt::format("\"{}\"", word));
  return result;
}

// In place of a number a text with the index of a `repeat` that is missing, or one with too many digits to be
// a whole number here, is right for the schema.
Rule wrong_type_of(const TomlValue& value) {
  const auto* text = value.as<std::string>();
  const auto* number = value.as<double>();
  const bool is_repeated = text && text->starts_with('{');
  const bool is_whole = number && std::trunc(*number) == *number;
  return is_repeated || is_whole ? rules::beyond_schema(rules::wrong_type) : rules::wrong_type;
}

// Why a key of a section is not one of this form of it, in words; "" where no form has it.
std::string why_of_another_form(std::string_view section, std::string_view name, std::string_view form) {
  const auto all = study_keys();
  const auto key = std::ranges::find_if(
      all, [&](const StudyKey& each) { return each.section == section && each.key == name; });
  if (key == all.end()) return "";
  const std::vector<std::string> owners = separated(key->owners.of);
  if (*key->owners.decider)
    return fmt::format("; it belongs to {} = {}", key->owners.decider, listed(quoted(owners), " or "));
  // What tells that the section is of a form that has the key, and of this one.
  std::vector<std::string> with, without;
  bool needs_none = false;
  for (const SectionForm& each : section_forms()) {
    if (each.section != section) continue;
    const bool has_it = is_one_of(each.form, key->owners.of);
    if (!has_it && each.form != form) continue;
    needs_none = needs_none || (has_it && *each.marks == '\0');
    for (const std::string& mark : separated(each.marks)) {
      const bool is_path = mark.find('.') != std::string::npos;
      (has_it ? with : without).push_back(is_path ? written_section(mark) : fmt::format("\"{}\"", mark));
    }
  }
  return needs_none ? fmt::format("; it does not go with {}", listed(without, " or "))
                    : fmt::format("; it goes with {}", listed(with, " or "));
}

}  // namespace

const TomlEntry* find_entry(const TomlValue& table, std::string_view key) {
  const auto* entries = table.as<TomlTable>();
  if (!entries) return nullptr;
  const auto entry = std::find_if(entries->begin(), entries->end(), [&](auto& e) { return e.key == key; });
  return entry == entries->end() ? nullptr : &*entry;
}

bool is_given(const StudyKey& key, const TomlValue& table) {
  const TomlEntry* entry = find_entry(table, key.key);
  const auto* list = entry ? entry->value.as<TomlArray>() : nullptr;
  return entry && !(key.form == KeyForm::tables && list && list->empty());
}

TomlSection::TomlSection(const StudySource& source, const TomlValue& table, std::string where,
                         std::string_view section, std::string_view form)
    : source_(&source), table_(&table), where_(std::move(where)), section_(section), form_(form) {
  const auto* entries = table.as<TomlTable>();
  if (!entries)
    fail_at(rules::wrong_type, source, table, where_,
            fmt::format("expected a table, found {}", described(table)));
  const std::vector<std::string> keys = keys_of(section_, form_);
  for (const TomlEntry& entry : *entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    const std::string elsewhere = why_of_another_form(section_, entry.key, form_);
    throw source.error_at(rules::unknown_key, entry.position, "{}: unknown key \"{}\"{}", where_, entry.key,
                          elsewhere.empty() ? suggestion(entry.key, keys) : elsewhere);
  }
  require_keys(form_);
  check_groups(form_);
}

const TomlValue* TomlSection::find(std::string_view key) const {
  const TomlEntry* entry = find_entry(*table_, key);
  return entry ? &entry->value : nullptr;
}

const TomlValue& TomlSection::require(std::string_view key) const {
  const TomlValue* value = find(key);
  if (!value) fail_here(rules::missing_key_of_table, "the key \"{}\" is missing", key);
  return *value;
}

std::string TomlSection::text(std::string_view key) const {
  return read_text(*source_, key_of(where_, key), require(key));
}

std::string TomlSection::text_or(std::string_view key, std::string otherwise) const {
  return find(key) ? text(key) : std::move(otherwise);
}

std::string TomlSection::identifier(std::string_view key) const {
  return read_identifier(*source_, key_of(where_, key), require(key));
}

std::optional<double> TomlSection::default_of_absent(std::string_view key) const {
  return find(key) ? std::nullopt : study_key(section_, key).by_default;
}

bool TomlSection::boolean(std::string_view key) const {
  if (const auto number = default_of_absent(key)) return *number != 0.0;
  const TomlValue& value = require(key);
  if (!value.as<bool>()) fail(rules::wrong_type, key, "expected true or false, found {}", described(value));
  return *value.as<bool>();
}

double TomlSection::number(std::string_view key) const {
  if (const auto number = default_of_absent(key)) return *number;
  const double number = read_number(*source_, key_of(where_, key), require(key));
  check_limits(key, number, "");
  return number;
}

// 181.0 is one too, as in JSON Schema.
static std::optional<std::int64_t> whole_number(const TomlValue& value) {
  constexpr double largest = 9007199254740992.0;  // 2^53
  if (const auto* integer = value.as<std::int64_t>()) return *integer;
  const auto* number = value.as<double>();
  if (!number || std::trunc(*number) != *number || std::abs(*number) > largest) return std::nullopt;
  return static_cast<std::int64_t>(*number);
}

std::int64_t TomlSection::integer(std::string_view key) const {
  if (const auto number = default_of_absent(key)) return static_cast<std::int64_t>(*number);
  const TomlValue& value = require(key);
  const auto integer = whole_number(value);
  if (!integer) fail(wrong_type_of(value), key, "expected a whole number, found {}", described(value));
  check_limits(key, static_cast<double>(*integer), "a whole number ");
  return *integer;
}

const Limits& TomlSection::limits(std::string_view key) const {
  return study_key(section_, key).limits;
}

void TomlSection::check_limits(std::string_view key, double number, std::string_view kind) const {
  if (limits(key).hold(number)) return;
  const StudyKey& row = study_key(section_, key);
  const std::vector<std::string> words = quoted(words_of(row));
  fail(rules::out_of_range, key, "{} is out of range: {}{} ({})", number, limits(key).text(kind),
       words.empty() ? "" : ", or " + listed(words, " or "), row.meaning);
}

void TomlSection::require_keys(std::string_view form) const {
  for (const StudyKey& key : study_keys()) {
    if (key.section != section_ || !needs(key, form) || is_given(key, *table_)) continue;
    if (key.form == KeyForm::tables)
      fail_here(rules::missing_section, "needs {} ({})", written_section(section_ + "." + key.key),
                key.meaning);
    fail_here(rules::missing_key_of_table, "the key \"{}\" is missing ({})", key.key, key.meaning);
  }
}

std::string TomlSection::choice(std::string_view key, std::string_view otherwise,
                                std::string_view besides) const {
  const std::vector<std::string> words = words_of(study_key(section_, key), form_);
  if (!find(key)) return otherwise.empty() ? words.front() : std::string(otherwise);
  const std::string word = text(key);
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    fail(rules::not_a_choice, key, "\"{}\" is not possible here; write {}{}", word,
         listed(quoted(words), besides.empty() ? " or " : ", "), besides);
  }
  return word;
}

std::size_t TomlSection::place_of(std::string_view key, std::string_view word) const {
  const std::vector<std::string> words = words_of(study_key(section_, key));
  return static_cast<std::size_t>(std::find(words.begin(), words.end(), word) - words.begin());
}

void TomlSection::keep_to(std::string_view form) const {
  for (const TomlEntry& entry : *table_->as<TomlTable>()) {
    const StudyKey& key = study_key(section_, entry.key);
    if (has(key, form)) continue;
    fail(rules::key_without_use, entry.key, "belongs to {} = {}, not to \"{}\"", key.owners.decider,
         listed(quoted(separated(key.owners.of)), " or "), form);
  }
  require_keys(form);
  check_groups(form);
}

void TomlSection::check_groups(std::string_view form) const {
  for (const KeyGroup& group : key_groups()) {
    const bool is_of_every_form = *group.of.of == '\0';
    if (group.section == section_ && (is_of_every_form || is_one_of(form, group.of.of))) check_group(group);
  }
}

void TomlSection::check_group(const KeyGroup& group) const {
  std::vector<std::string> given, absent;
  for (const std::string& key : separated(group.keys))
    (is_given(study_key(section_, key), *table_) ? given : absent).push_back(key);
  // In the words of the group, if it has any.
  const auto sentence = [](const Sentence& own, const char* general, const std::string& key) {
    return fmt::format(fmt::runtime(*own.text ? own.text : general), key);
  };
  const auto refuse_too_many = [&] {
    if (given.size() < 2) return;
    fail(group.too_many.rule.value_or(rules::one_of_two_keys), given[1], "{}",
         sentence(group.too_many, "\"{}\" is already given; give only one of them", given[0]));
  };
  const auto refuse_none = [&] {
    if (!given.empty()) return;
    fail_here(group.missing.rule.value_or(rules::one_of_two_keys), "{}",
              sentence(group.missing, "needs {}", listed(quoted(absent), " or ")));
  };
  switch (group.rule) {
    case Together::one:
      refuse_none();
      return refuse_too_many();
    case Together::at_most_one:
      return refuse_too_many();
    case Together::at_least_one:
      return refuse_none();
    case Together::all_or_none:
      if (given.empty() || absent.empty()) return;
      fail_here(group.missing.rule.value_or(rules::missing_key_of_table), "{}",
                sentence(group.missing, "the key \"{}\" is missing", absent[0]));
    case Together::not_without:
      if (absent != std::vector{separated(group.keys).back()}) return;
      fail(group.missing.rule.value_or(rules::key_without_use), given[0], "{}",
           sentence(group.missing, "needs the key \"{}\"", absent[0]));
  }
}

std::string read_text(const StudySource& source, const std::string& where, const TomlValue& value) {
  const auto* text = value.as<std::string>();
  if (!text)
    fail_at(rules::wrong_type, source, value, where,
            fmt::format("expected a text, found {}", described(value)));
  if (text->empty()) fail_at(rules::empty, source, value, where, "the text is empty");
  const bool control = std::any_of(text->begin(), text->end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t';
  });
  if (control) fail_at(rules::not_text, source, value, where, "control characters are not allowed");
  return *text;
}

std::string read_identifier(const StudySource& source, const std::string& where, const TomlValue& value) {
  const std::string name = read_text(source, where, value);
  if (!is_identifier(name)) {
    // "{i}" of a `repeat` that is missing.
    const bool is_repeated = name.find('{') != std::string::npos;
    fail_at(is_repeated ? rules::beyond_schema(rules::not_a_name) : rules::not_a_name, source, value, where,
            fmt::format("\"{}\" is not a name: names are a letter followed by letters, digits and _", name));
  }
  return name;
}

bool is_number(const TomlValue& value) {
  return value.as<double>() || value.as<std::int64_t>();
}

double read_number(const StudySource& source, const std::string& where, const TomlValue& value) {
  if (const auto* integer = value.as<std::int64_t>()) return static_cast<double>(*integer);
  const auto* number = value.as<double>();
  if (!number)
    fail_at(wrong_type_of(value), source, value, where,
            fmt::format("expected a number, found {}", described(value)));
  if (!std::isfinite(*number))
    fail_at(rules::not_finite, source, value, where, fmt::format("{} is not a finite number", *number));
  return *number;
}

std::vector<std::size_t> read_places(const TomlSection& section, std::string_view key, const TomlArray& names,
                                     std::string_view what, const std::vector<std::string>& known) {
  const std::string where = fmt::format("{}: {}", section.where(), key);
  std::vector<std::size_t> places;
  for (const TomlValue& item : names) {
    const std::string name = read_text(section.source(), where, item);
    const auto refuse = [&](Rule rule, const std::string& text) {
      throw section.source().error_at(rule, item.position, "{}: {}", where, text);
    };
    const auto place = place_among(known, name);
    if (!place) refuse(rules::unknown_name, none_called(what, name, known));
    if (std::ranges::find(places, *place) != places.end())
      refuse(rules::given_twice, fmt::format("\"{}\" appears twice", name));
    places.push_back(*place);
  }
  return places;
}

std::vector<const TomlValue*> read_tables(const StudySource& source, const TomlValue& parent,
                                          const std::string& path) {
  std::vector<const TomlValue*> tables;
  const std::size_t dot = path.rfind('.');
  const TomlEntry* entry = find_entry(parent, dot == std::string::npos ? path : path.substr(dot + 1));
  if (!entry) return tables;
  const auto* array = entry->value.as<TomlArray>();
  if (!array) {
    throw source.error_at(rules::wrong_type, entry->position,
                          "write [[{}]] with two brackets, because there can be several; found {}", path,
                          described(entry->value));
  }
  for (const TomlValue& table : *array) tables.push_back(&table);
  return tables;
}

std::string label(const TomlValue& table, std::string_view kind, std::string_view naming_key,
                  std::string_view path, std::size_t number) {
  const TomlEntry* entry = find_entry(table, naming_key);
  const auto* name = entry ? entry->value.as<std::string>() : nullptr;
  if (!name || name->empty() || name->size() > longest_label)
    return fmt::format("[[{}]] {}", path, table.number > 0 ? table.number : number);
  return fmt::format("{} \"{}\"", kind, *name);
}

}  // namespace frahm::studies
