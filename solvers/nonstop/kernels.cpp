#include <algorithm>

#include "solvers/nonstop/kernel.hpp"

namespace frahm::periodic::nonstop {

#if defined(__x86_64__)
#if !defined(FRAHM_KERNELS_FROM_V3)
Solve solve_portable, solve_v2;
#endif
Solve solve_v3, solve_v4;

namespace {

bool has_v3() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
}

bool has_v4() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}

}  // namespace

std::span<const Kernel> kernels() {
  __builtin_cpu_init();
  static const Kernel all[] = {
#if !defined(FRAHM_KERNELS_FROM_V3)
    {"portable", true, solve_portable},
    {"x86-64-v2", __builtin_cpu_supports("sse4.2") != 0, solve_v2},
#endif
    {"x86-64-v3", has_v3(), solve_v3},
    {"x86-64-v4", has_v4(), solve_v4}
  };
  return all;
}
#else
Solve solve_portable;

std::span<const Kernel> kernels() {
  static const Kernel all[] = {{"portable", true, solve_portable}};
  return all;
}
#endif

const Kernel& fastest_kernel() {
  const auto all = kernels();
  return *std::find_if(all.rbegin(), all.rend() - 1, [](const Kernel& kernel) { return kernel.runs_here; });
}

}  // namespace frahm::periodic::nonstop
