#include "studies/program/version_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <string>
#include <thread>

#include "engine/mpi.hpp"
#include "studies/provenance/build_facts.hpp"

namespace frahm::studies {
namespace {

// Whether this CPU has the instructions the program was compiled with.
std::string cpu_text() {
#ifdef FRAHM_CPU
  const bool suits = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return fmt::format("built for {}; this one {} AVX2 and FMA", FRAHM_CPU, suits ? "has" : "LACKS");
#else
  return "built for any processor of this kind";
#endif
}

}  // namespace

int version_command(bool verbose, std::ostream& out) {
  const BuildFacts facts = build_facts();
  fmt::print(out, "frahm {}\n", facts.version);
  if (!verbose) return 0;
  fmt::print(out, "commit     {}\n", facts.commit);
  fmt::print(out, "compiler   {}\n", facts.compiler);
  fmt::print(out, "flags      {}\n", facts.flags);
  fmt::print(out, "CPU        {}\n", cpu_text());
  fmt::print(out, "threads    {} (processors this process may use)\n", std::thread::hardware_concurrency());
  const std::string mpi = engine::mpi_library();
  fmt::print(out, "ranks      {}\n", mpi.empty() ? "none: built without MPI" : mpi);
  fmt::print(out, "libraries  {}\n", fmt::join(facts.libraries, "\n           "));
  return 0;
}

}  // namespace frahm::studies
