#if defined(__x86_64__) && defined(FRAHM_CPU)

#include <unistd.h>

#include <string_view>

namespace {

// Runs before any other code of the program, which may use the instructions checked here. It is compiled for
// every x86-64 (studies/CMakeLists.txt), without a library that might not be.
__attribute__((constructor(101))) void check_cpu() {
  __builtin_cpu_init();
  if (std::string_view(FRAHM_CPU) != "x86-64-v3") return;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    return;
  constexpr std::string_view message =
      "frahm: this program was built for x86-64-v3 and this processor lacks AVX2, FMA or BMI2; build it with "
      "-DFRAHM_CPU= for any x86-64\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
  ::_exit(1);
}

}  // namespace

#endif
