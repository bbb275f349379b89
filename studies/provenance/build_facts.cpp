#include "studies/provenance/build_facts.hpp"

#include <string_view>

// Set by build_facts.cmake; a test checks this.
#ifndef FRAHM_VERSION
#define FRAHM_VERSION "unknown"
#define FRAHM_COMMIT "unknown"
#define FRAHM_COMPILER "unknown"
#define FRAHM_FLAGS "unknown"
#define FRAHM_LIBRARIES ""
#endif

namespace frahm::studies {
namespace {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (bool more = !text.empty(); more;) {
    const std::size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    more = end != std::string_view::npos;
    if (more) text.remove_prefix(end + 1);
  }
  return parts;
}

}  // namespace

BuildFacts build_facts() {
  return {FRAHM_VERSION, FRAHM_COMMIT, FRAHM_COMPILER, FRAHM_FLAGS, split(FRAHM_LIBRARIES, '|')};
}

}  // namespace frahm::studies
