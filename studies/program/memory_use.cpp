#include "studies/program/memory_use.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace frahm::studies {
namespace {

// That the process holds now [bytes]; 0 where the system does not tell.
double memory_now() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;  // pages
  file >> total >> resident;
  return file ? resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) : 0.0;
}

// That it has held at its most [bytes].
double most_memory() {
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  constexpr double kB = 1024.0;
  return static_cast<double>(use.ru_maxrss) * kB;
}

}  // namespace

MemoryUse::MemoryUse() : before_(memory_now()) {}

double MemoryUse::of_run(int threads) const {
  return before_ + threads * std::max(0.0, most_memory() - before_);
}

}  // namespace frahm::studies
