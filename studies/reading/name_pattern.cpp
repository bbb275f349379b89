#include "studies/reading/name_pattern.hpp"

#include <fnmatch.h>

namespace frahm::studies {

bool is_pattern(const std::string& text) {
  return text.find('*') != std::string::npos;
}

bool matches(const std::string& name_or_pattern, const std::string& name) {
  return fnmatch(name_or_pattern.c_str(), name.c_str(), 0) == 0;
}

}  // namespace frahm::studies
