#include "studies/reading/text/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace frahm::studies {
namespace {

constexpr std::size_t most_names_listed = 12;  // a longer list hides what it should show
constexpr std::size_t longest_compared = 64;   // bounds the work on hostile input

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Edits (insert, delete, replace, swap of neighbours) that turn one word into the other, case ignored.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = previous[j - 1] + (lower(a[i - 1]) != lower(b[j - 1]));
      current[j] = std::min({replaced, previous[j] + 1, current[j - 1] + 1});
      const bool swapped =
          i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) current[j] = std::min(current[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

}  // namespace

std::string suggestion(std::string_view found, std::span<const std::string> valid) {
  if (valid.empty() || found.size() > longest_compared) return "";
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, found.size() / 3) + 1;
  for (const std::string& name : valid) {
    const std::size_t distance = edit_distance(found, name);
    // A one-letter name is one edit from every other: only its other case is near.
    const bool alike = distance < std::max(found.size(), name.size());
    if (alike && distance < least) {
      least = distance;
      nearest = &name;
    }
  }
  if (nearest) return fmt::format("; did you mean \"{}\"?", *nearest);
  if (valid.size() > most_names_listed) return "";
  return "; known: " + listed(valid, ", ");
}

std::string none_called(std::string_view what, std::string_view found, std::span<const std::string> valid) {
  return fmt::format("no {} is called \"{}\"{}", what, found, suggestion(found, valid));
}

std::optional<std::size_t> place_among(std::span<const std::string> names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

bool is_identifier(std::string_view name) {
  return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), [](char c) {
    return is_letter(c) || is_digit(c) || c == '_';
  });
}

std::string listed(std::span<const std::string> words, std::string_view last_joint) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last_joint : std::string_view(", ");
    text += words[i];
  }
  return text;
}

}  // namespace frahm::studies
