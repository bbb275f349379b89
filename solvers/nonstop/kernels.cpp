#include <algorithm>
#include <array>

#include "solvers/nonstop/kernel.hpp"

namespace frahm::periodic::nonstop {

#if defined(__x86_64__)
Solve solve_portable, solve_v2, solve_v3, solve_v4;

std::span<const Kernel> kernels() {
  __builtin_cpu_init();
  static const std::array<Kernel, 4> all{
      Kernel{"portable", true, solve_portable},
      Kernel{"x86-64-v2", __builtin_cpu_supports("sse4.2") != 0, solve_v2},
      Kernel{
          "x86-64-v3",
          __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"),
          solve_v3},
      Kernel{"x86-64-v4",
             __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                 __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                 __builtin_cpu_supports("avx512vl"),
             solve_v4}};
  return all;
}
#else
Solve solve_portable;

std::span<const Kernel> kernels() {
  static const std::array<Kernel, 1> all{Kernel{"portable", true, solve_portable}};
  return all;
}
#endif

const Kernel& fastest_kernel() {
  const auto all = kernels();
  return *std::find_if(all.rbegin(), all.rend() - 1, [](const Kernel& kernel) { return kernel.runs_here; });
}

}  // namespace frahm::periodic::nonstop
