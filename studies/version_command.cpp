#include "studies/version_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <string_view>
#include <thread>

// Set by build_facts.cmake; a test holds that they are.
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

// Whether this CPU has the instructions the program was compiled with.
std::string cpu_text() {
#ifdef FRAHM_CPU
  const bool suits = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return fmt::format("built for {}; this one {} AVX2 and FMA", FRAHM_CPU, suits ? "has" : "LACKS");
#else
  return "built for any of this kind";
#endif
}

}  // namespace

BuildFacts build_facts() {
  return {FRAHM_VERSION, FRAHM_COMMIT, FRAHM_COMPILER, FRAHM_FLAGS, split(FRAHM_LIBRARIES, '|')};
}

int version_command(bool verbose, std::ostream& out) {
  const BuildFacts facts = build_facts();
  fmt::print(out, "frahm {}\n", facts.version);
  if (!verbose) return 0;
  fmt::print(out, "commit     {}\n", facts.commit);
  fmt::print(out, "compiler   {}\n", facts.compiler);
  fmt::print(out, "flags      {}\n", facts.flags);
  fmt::print(out, "CPU        {}\n", cpu_text());
  fmt::print(out, "threads    {} (processors this process may use)\n", std::thread::hardware_concurrency());
  fmt::print(out, "libraries  {}\n", fmt::join(facts.libraries, "\n           "));
  return 0;
}

}  // namespace frahm::studies
