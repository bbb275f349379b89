#include "studies/program/verify_command.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <limits>
#include <sstream>

#include "studies/program/verify_cases.hpp"

namespace verify_command_test {
namespace {

using frahm::studies::verify_command;
using frahm::studies::VerifyCase;

TEST_CASE("All classical cases pass, within five seconds") {
  const auto start = std::chrono::steady_clock::now();
  std::ostringstream out;
  const int code = verify_command(out);
  [[maybe_unused]] const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  INFO(out.str());
  CHECK(code == 0);
  CHECK(out.str().find("FAIL") == std::string::npos);
#ifdef NDEBUG
  CHECK(spent.count() < 5.0);
#endif
}

TEST_CASE("A classical case fails for a deviation, a missing value, a wrong regime, or without points") {
  VerifyCase good{"amplitude", 1e-9};
  CHECK_FALSE(good.passes());
  good.compare(2.0 + 1e-10, 2.0);
  good.expect(true);
  CHECK(good.passes());

  VerifyCase far = good, missing = good, wrong = good;
  far.compare(2.0 + 1e-8, 2.0);
  CHECK_FALSE(far.passes());
  missing.compare(std::numeric_limits<double>::quiet_NaN(), 2.0);
  CHECK_FALSE(missing.passes());
  wrong.expect(false);
  CHECK_FALSE(wrong.passes());
}

}  // namespace
}  // namespace verify_command_test
