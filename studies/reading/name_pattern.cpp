#include "studies/reading/name_pattern.hpp"

#include <fnmatch.h>

#include <algorithm>

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

}  // namespace frahm::studies
