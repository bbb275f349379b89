#include "studies/reading/text/toml_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "studies/reading/text/toml_scan.hpp"

// toml++ 3.3 asserts on some malformed input ([.x]) before it reports it: without the assertion it reports
// it. The library as packaged has the assertions compiled in, so its headers are used alone.
#define TOML_ASSERT(condition) static_cast<void>(0)
#undef TOML_HEADER_ONLY
#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

namespace frahm::studies {
namespace {

constexpr std::size_t longest_quote = 40;  // bytes of a text shown in a message

Position position_of(const toml::source_region& region) {
  return {region.begin.line, region.begin.column};
}

TomlValue converted(const toml::node& node);

TomlTable converted_table(const toml::table& table) {
  TomlTable entries;
  for (const auto& [key, node] : table) {
    entries.push_back({std::string(key.str()), position_of(key.source()), converted(node)});
  }
  std::sort(entries.begin(), entries.end(), [](auto& a, auto& b) { return a.position < b.position; });
  return entries;
}

TomlValue converted(const toml::node& node) {
  TomlValue value{position_of(node.source()), TomlDate{}};
  if (const auto* boolean = node.as_boolean()) value.content = boolean->get();
  if (const auto* integer = node.as_integer()) value.content = integer->get();
  if (const auto* real = node.as_floating_point()) value.content = real->get();
  if (const auto* text = node.as_string()) value.content = text->get();
  if (const auto* array = node.as_array()) {
    TomlArray items;
    for (const auto& item : *array) items.push_back(converted(item));
    value.content = std::move(items);
  }
  if (const auto* table = node.as_table()) value.content = converted_table(*table);
  return value;
}

// "Error while parsing key-value pair: expected ..." -> "expected ..."
std::string_view without_preamble(std::string_view description) {
  if (!description.starts_with("Error while parsing")) return description;
  const std::size_t colon = description.find(": ");
  return colon == std::string_view::npos ? description : description.substr(colon + 2);
}

// What the library says, in a study's words where its own are of its inside.
std::string plain(std::string_view description) {
  const std::string text(without_preamble(description));
  const std::size_t open = text.find('\''), close = text.rfind('\'');
  const std::string quoted = open < close ? text.substr(open + 1, close - open - 1) : "";
  if (text.starts_with("cannot redefine existing"))
    return fmt::format("\"{}\" is already given", quoted.substr(0, quoted.find('\'')));
  if (text.find("could not be interpreted as a value") != std::string::npos)
    return fmt::format("\"{}\" is not a value: a number too large, or a text without quotes", quoted);
  return text;
}

}  // namespace

std::string described(const TomlValue& value) {
  if (const auto* boolean = value.as<bool>()) return *boolean ? "true" : "false";
  if (const auto* integer = value.as<std::int64_t>()) return fmt::format("the number {}", *integer);
  if (const auto* real = value.as<double>()) return fmt::format("the number {}", *real);
  if (const auto* text = value.as<std::string>()) {
    return text->size() > longest_quote ? "a long text" : fmt::format("the text \"{}\"", *text);
  }
  if (value.as<TomlArray>()) return "an array";
  return value.as<TomlTable>() ? "a table" : "a date or time";
}

TomlValue read_toml(const StudySource& source) {
  scan_before_toml(source);
  try {
    return {{1, 1}, converted_table(toml::parse(source.text))};
  } catch (const toml::parse_error& error) {
    throw source.error_at(rules::not_toml, position_of(error.source()), "not valid TOML: {}",
                          plain(error.description()));
  }
}

}  // namespace frahm::studies
