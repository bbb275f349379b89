#include "studies/program/version_command.hpp"

#include <catch2/catch.hpp>
#include <regex>
#include <sstream>

#include "studies/provenance/build_facts.hpp"

namespace version_command_test {
namespace {

using frahm::studies::build_facts;
using frahm::studies::version_command;

TEST_CASE("The program knows how it was built") {
  const auto facts = build_facts();
  CHECK(std::regex_match(facts.version, std::regex(R"(\d+\.\d+\.\d+)")));
  CHECK(std::regex_match(facts.commit, std::regex("unknown|[0-9a-f]{40}(-dirty)?")));
  CHECK(std::regex_search(facts.compiler, std::regex(R"([A-Za-z]+ \d+\.\d+)")));
  REQUIRE(facts.libraries.size() == 15);
  for (const std::string& library : facts.libraries) {
    INFO(library);
    CHECK(std::regex_search(library, std::regex(R"(^\S.* \d+\.\d+)")));
  }
}

TEST_CASE("The version is a line of its own, and more is told when asked for") {
  std::ostringstream brief, verbose;
  CHECK(version_command(false, brief) == 0);
  CHECK(version_command(true, verbose) == 0);
  CHECK(brief.str() == "frahm " + build_facts().version + "\n");
  CHECK(verbose.str().starts_with(brief.str()));
  for (const char* part :
       {"commit ", "compiler ", "flags ", "CPU ", "threads ", "Eigen 3.", "SUNDIALS 6.", "HDF5 1."}) {
    INFO(part);
    CHECK(verbose.str().find(part) != std::string::npos);
  }
}

}  // namespace
}  // namespace version_command_test
