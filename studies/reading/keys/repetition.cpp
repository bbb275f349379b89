#include "studies/reading/keys/repetition.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

constexpr std::string_view key_of_repetition = "repeat";
constexpr std::size_t most_tables = 10'000;  // of a document

struct Index {
  std::string name;
  std::int64_t from = 0, to = 0, step = 1;
  std::int64_t value = 0;
};
using Indices = std::vector<Index>;

class Repetition {
 public:
  explicit Repetition(const StudySource& source) : source_(source) {}

  // section: by which the table of keys calls the value.
  void write_out(TomlValue& value, const std::string& section = "") {
    if (auto* table = std::get_if<TomlTable>(&value.content)) {
      for (TomlEntry& entry : *table) write_out(entry.value, inner(section, entry.key));
    } else if (auto* list = std::get_if<TomlArray>(&value.content)) {
      write_out(*list, section);
    }
  }

 private:
  static std::string inner(const std::string& section, const std::string& key) {
    return section.empty() ? key : section + "." + key;
  }

  void write_out(TomlArray& list, const std::string& section) {
    TomlArray result;
    for (TomlValue& value : list) {
      const TomlEntry* repeat = value.as<TomlTable>() ? find_entry(value, key_of_repetition) : nullptr;
      if (!repeat) {
        write_out(value, section);
        result.push_back(std::move(value));
        continue;
      }
      Indices indices = indices_of(repeat->value);
      do {
        if (++tables_ > most_tables)
          throw source_.error_at(rules::too_large, repeat->value.position,
                                 "repeat: the study has more than {} repeated tables", most_tables);
        TomlValue copy = value;
        std::erase_if(std::get<TomlTable>(copy.content),
                      [](const TomlEntry& entry) { return entry.key == key_of_repetition; });
        replace(copy, section, indices);
        result.push_back(std::move(copy));
      } while (next(indices));
    }
    list = std::move(result);
  }

  Indices indices_of(const TomlValue& repeat) const {
    const auto* table = repeat.as<TomlTable>();
    if (!table || table->empty())
      throw source_.error_at(rules::wrong_type, repeat.position,
                             "repeat: {}; expected an index and its range, as in repeat = {{ i = [1, 60] }}",
                             described(repeat));
    Indices indices;
    for (const TomlEntry& entry : *table) indices.push_back(index_of(entry));
    return indices;
  }

  Index index_of(const TomlEntry& entry) const {
    const auto* range = entry.value.as<TomlArray>();
    const auto is_whole = [](const TomlValue& value) { return value.as<std::int64_t>() != nullptr; };
    if (!range || range->size() < 2 || range->size() > 3 || !std::ranges::all_of(*range, is_whole))
      throw source_.error_at(rules::wrong_type, entry.value.position,
                             "repeat: {}: expected the first and the last number, and a step if it is not 1: "
                             "[1, 60] or [3, 60, 3]",
                             entry.key);
    const auto number = [&](std::size_t i) { return *(*range)[i].as<std::int64_t>(); };
    Index index{entry.key, number(0), number(1), range->size() == 3 ? number(2) : 1, number(0)};
    constexpr std::int64_t largest = 1'000'000;
    const bool is_range = std::abs(index.from) <= largest && std::abs(index.to) <= largest &&
                          index.from <= index.to && index.step > 0 && index.step <= largest;
    if (!is_range)
      throw source_.error_at(
          rules::beyond_schema(rules::out_of_range), entry.value.position,
          "repeat: {}: {} to {} in steps of {} is not a range: numbers must rise and stay within a million",
          entry.key, index.from, index.to, index.step);
    return index;
  }

  static bool next(Indices& indices) {
    for (auto index = indices.rbegin(); index != indices.rend(); ++index) {
      index->value += index->step;
      if (index->value <= index->to) return true;
      index->value = index->from;
    }
    return false;
  }

  // In all texts and keys of a value.
  void replace(TomlValue& value, const std::string& section, const Indices& indices) const {
    if (auto* text = std::get_if<std::string>(&value.content)) {
      *text = replaced(*text, indices, value.position);
    } else if (auto* list = std::get_if<TomlArray>(&value.content)) {
      for (TomlValue& each : *list) replace(each, section, indices);
    } else if (auto* table = std::get_if<TomlTable>(&value.content)) {
      for (TomlEntry& entry : *table) {
        entry.key = replaced(entry.key, indices, entry.position);
        const std::optional<std::int64_t> number =
            takes_number(section, entry.key) ? index_alone(entry.value, indices) : std::nullopt;
        if (number)
          entry.value.content = *number;
        else
          replace(entry.value, inner(section, entry.key), indices);
      }
    }
  }

  // Whether the key's value is a plain number, which is no text: order = "{n}".
  static bool takes_number(std::string_view section, std::string_view key) {
    return std::ranges::any_of(study_keys(), [&](const StudyKey& each) {
      const auto is_number = [](KeyForm form) { return form == KeyForm::integer || form == KeyForm::number; };
      return section == each.section && key == each.key &&
             (is_number(each.form) || (each.has_other && is_number(each.other)));
    });
  }

  // The number of a text that is an index and nothing else.
  static std::optional<std::int64_t> index_alone(const TomlValue& value, const Indices& indices) {
    const auto* text = value.as<std::string>();
    if (!text || !text->starts_with('{') || !text->ends_with('}')) return std::nullopt;
    return number_of(text->substr(1, text->size() - 2), indices);
  }

  std::string replaced(const std::string& text, const Indices& indices, Position position) const {
    std::string result;
    std::size_t at = 0;
    for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', at)) {
      const std::size_t close = text.find('}', open);
      result += text.substr(at, open - at);
      const std::string inside = text.substr(open + 1, close == std::string::npos ? close : close - open - 1);
      const std::optional<std::int64_t> number = number_of(inside, indices);
      if (!number || close == std::string::npos) {
        std::vector<std::string> names;
        for (const Index& index : indices) names.push_back("{" + index.name + "}");
        throw source_.error_at(
            rules::unknown_name, position,
            "\"{}\": {{{}}} is not an index of this repeat; write {}, or add a whole number, as in {{{}-1}}",
            text, inside, listed(names, " or "), indices.front().name);
      }
      result += std::to_string(*number);
      at = close + 1;
    }
    return result + text.substr(at);
  }

  // "i", "i+2" or "i-1"
  static std::optional<std::int64_t> number_of(const std::string& text, const Indices& indices) {
    const std::size_t sign = text.find_first_of("+-");
    const auto index = std::ranges::find(indices, text.substr(0, sign), &Index::name);
    if (index == indices.end()) return std::nullopt;
    if (sign == std::string::npos) return index->value;
    const std::string_view digits = std::string_view(text).substr(sign + 1);
    std::uint32_t shift = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), shift);
    if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    return text[sign] == '+' ? index->value + shift : index->value - shift;
  }

  const StudySource& source_;
  std::size_t tables_ = 0;
};

}  // namespace

TomlValue with_repetitions(const StudySource& source, TomlValue document) {
  Repetition(source).write_out(document);
  return document;
}

}  // namespace frahm::studies
