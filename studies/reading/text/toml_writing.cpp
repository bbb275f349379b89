#include "studies/reading/text/toml_writing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace frahm::studies {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += fmt::format("\\{}", c);
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else {
      result += c;
    }
  }
  result += '"';
  return result;
}

std::string key_text(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? key : in_quotes(key);
}

// The text between the brackets of an array or of a table.
template <class Items, class Text>
std::string joined(const Items& items, const Text& text) {
  std::string result;
  for (const auto& item : items) {
    if (!result.empty()) result += ", ";
    result += text(item);
  }
  return result;
}

bool is_array_of_tables(const TomlValue& value) {
  const auto* array = value.as<TomlArray>();
  return array && !array->empty() && std::all_of(array->begin(), array->end(), [](const TomlValue& item) {
           return item.as<TomlTable>() != nullptr;
         });
}

void write_table(const std::string& path, const TomlTable& table, bool nested, std::string& text);

void write_arrays(const std::string& path, const TomlValue& value, std::string& text) {
  for (const TomlValue& item : *value.as<TomlArray>()) {
    text += fmt::format("\n[[{}]]\n", path);
    write_table(path, *item.as<TomlTable>(), true, text);
  }
}

// nested: below a heading already, where a table is written in line.
void write_table(const std::string& path, const TomlTable& table, bool nested, std::string& text) {
  const auto below = [&](const std::string& key) {
    return path.empty() ? key_text(key) : path + "." + key_text(key);
  };
  const bool deep = path.find('.') != std::string::npos;
  const auto has_heading = [&](const TomlValue& value) {
    return (!nested && value.as<TomlTable>()) || (!deep && is_array_of_tables(value));
  };
  for (const TomlEntry& entry : table) {
    if (!has_heading(entry.value))
      text += fmt::format("{} = {}\n", key_text(entry.key), toml_in_line(entry.value));
  }
  for (const TomlEntry& entry : table) {
    if (!has_heading(entry.value)) continue;
    if (entry.value.as<TomlArray>()) {
      write_arrays(below(entry.key), entry.value, text);
    } else {
      text += fmt::format("\n[{}]\n", below(entry.key));
      write_table(below(entry.key), *entry.value.as<TomlTable>(), true, text);
    }
  }
}

}  // namespace

// Numbers in their shortest form that reads back exactly.
std::string toml_in_line(const TomlValue& value) {
  if (const auto* flag = value.as<bool>()) return *flag ? "true" : "false";
  if (const auto* whole = value.as<std::int64_t>()) return fmt::format("{}", *whole);
  if (const auto* number = value.as<double>()) return fmt::format("{}", *number);
  if (const auto* text = value.as<std::string>()) return in_quotes(*text);
  if (const auto* array = value.as<TomlArray>()) return fmt::format("[{}]", joined(*array, toml_in_line));
  const auto entry = [](const TomlEntry& each) {
    return fmt::format("{} = {}", key_text(each.key), toml_in_line(each.value));
  };
  return fmt::format("{{ {} }}", joined(*value.as<TomlTable>(), entry));
}

std::string toml_text(const TomlValue& root) {
  std::string text;
  write_table("", *root.as<TomlTable>(), false, text);
  return text;
}

}  // namespace frahm::studies
