#include "studies/program/verify_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "studies/program/verify_cases.hpp"

namespace frahm::studies {

int verify_command(std::ostream& out) {
  constexpr int self_check_failed = 8;  // exit code
  const auto start = std::chrono::steady_clock::now();
  const std::vector<VerifyCase> cases = verify_cases();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;

  fmt::print(out, "The general path against closed forms, on this machine\n\n");
  fmt::print(out, "{:<62}{:>7}{:>12}{:>10}\n", "case", "points", "worst", "allowed");
  for (const VerifyCase& shown : cases) {
    fmt::print(out, "{:<62}{:>7}{:>12.2g}{:>10.0e}  {}", shown.name, shown.points, shown.worst, shown.allowed,
               shown.passes() ? "pass" : "FAIL");
    if (shown.wrong > 0) fmt::print(out, ": {} points of the wrong kind", shown.wrong);
    fmt::print(out, "\n");
  }
  const auto passed =
      std::count_if(cases.begin(), cases.end(), [](const VerifyCase& c) { return c.passes(); });
  const auto failed = static_cast<std::ptrdiff_t>(cases.size()) - passed;
  fmt::print(out, "\n{} of {} cases pass ({:.2f} s)\n", passed, cases.size(), spent.count());
  return failed == 0 ? 0 : self_check_failed;
}

}  // namespace frahm::studies
