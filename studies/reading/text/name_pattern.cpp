#include "studies/reading/text/name_pattern.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>

#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

// With FNM_PATHNAME a star stops at slashes; ours stops at underscores.
std::string as_path(std::string name) {
  std::replace(name.begin(), name.end(), '_', '/');
  return name;
}

}  // namespace

bool is_pattern(const std::string& text) {
  return text.find('*') != std::string::npos;
}

bool matches(const std::string& name_or_pattern, const std::string& name) {
  return fnmatch(as_path(name_or_pattern).c_str(), as_path(name).c_str(), FNM_PATHNAME) == 0;
}

std::vector<std::string> matching(std::span<const std::string> names_or_patterns,
                                  std::span<const std::string> names) {
  std::vector<std::string> found;
  for (const std::string& each : names_or_patterns) {
    for (const std::string& name : names)
      if (matches(each, name) && std::ranges::find(found, name) == found.end()) found.push_back(name);
  }
  return found;
}

std::string hint_of_unmatched(const std::string& name_or_pattern, std::span<const std::string> names) {
  if (!is_pattern(name_or_pattern)) return suggestion(name_or_pattern, names);
  const std::string rule = "; \"*\" stands for letters and digits and stops at \"_\"";
  const auto beyond = std::ranges::find_if(
      names, [&](const std::string& name) { return fnmatch(name_or_pattern.c_str(), name.c_str(), 0) == 0; });
  if (beyond == names.end()) return rule + suggestion(name_or_pattern, names);
  // As many more as the name has underscores more.
  std::string longer = name_or_pattern;
  for (auto more = std::ranges::count(*beyond, '_') - std::ranges::count(longer, '_'); more > 0; --more)
    longer.insert(longer.rfind('*') + 1, "_*");
  return matches(longer, *beyond) ? fmt::format("{}: \"{}\" is matched by \"{}\"", rule, *beyond, longer)
                                  : rule;
}

}  // namespace frahm::studies
