#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

namespace concurrent_solves_test {
// Solves in several threads of a process of its own, which a crash would end.
namespace {

struct Outcome {
  int exit_code = -1;
  std::string text;
  bool ended_well() const { return exit_code == 0 && text == "solves that differ: 0\n"; }
};

Outcome run(const std::string& arguments) {
  Outcome outcome;
  std::string command = FRAHM_CONCURRENT_SOLVES " ";
  command += arguments;
  command += " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char line[256];
  while (std::fgets(line, sizeof line, pipe) != nullptr) outcome.text += line;
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

TEST_CASE("solves in several threads end, and give the bits of solves alone", "[slow]") {
  for (const std::string load : {"2 5", "4 3"}) {
    const Outcome outcome = run(load);
    INFO("threads and solves " << load << ", exit code " << outcome.exit_code << "\n" << outcome.text);
    CHECK(outcome.ended_well());
  }
}

TEST_CASE("a process that ends with exit code 0 before its work is done is told from one that ends well") {
  const Outcome outcome = run("--ends-early");
  CHECK(outcome.exit_code == 0);
  CHECK_FALSE(outcome.ended_well());
}

}  // namespace
}  // namespace concurrent_solves_test
