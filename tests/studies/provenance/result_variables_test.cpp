// The table of the variables of results: the only place of their meanings.
#include "studies/provenance/result_variables.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace result_variables_test {
namespace {

using namespace frahm::studies;

std::string file_format() {
  std::ifstream file(std::string(FRAHM_SOURCE_DIR) + "/results/FORMAT.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

// "*_detuning" as the document writes it: `<p>_detuning`.
std::regex written(const std::string& name) {
  const std::string any_name = "(<[^>`]+>(_<[^>`]+>)*|[A-Za-z0-9]+)";
  return std::regex("`" + std::regex_replace(name, std::regex("\\*"), any_name) + "`");
}

// What FORMAT.md does not list by name: the estimates of the methods, and the data.
bool is_listed_elsewhere(const ResultVariable& row) {
  const std::string of = row.of, meaning = row.meaning;
  return meaning.starts_with("estimate:") || of.starts_with("data");
}

TEST_CASE("every variable of results has one row, and stands in FORMAT.md") {
  const std::string document = file_format();
  REQUIRE(document.size() > 10'000);
  std::set<std::string> names;
  for (const ResultVariable& row : result_variables()) {
    INFO(row.name);
    CHECK(names.insert(row.name).second);
    CHECK((is_listed_elsewhere(row) || std::regex_search(document, written(row.name))));
  }
  CHECK_FALSE(std::regex_search(document, written("*_no_such_variable")));
}

TEST_CASE("a name and a meaning take what the study gives in place of stars and braces") {
  const Named detuning("*_detuning", "k2");
  CHECK(detuning.name() == "k2_detuning");
  CHECK(detuning.meaning() == "relative rise of the objective when k2 changes by `change`");
  const Named share("*_share_*", {"main_peak", "a*b"}, {"F", "largest displacement of main"});
  CHECK(share.name() == "main_peak_share_a*b");
  CHECK(share.meaning() == "share of F in the first-order variance of largest displacement of main");
  CHECK(Named("trade_off").meaning() == "limit of the second quantity to which the optimum belongs");
  CHECK_THROWS_AS(Named("*_detunning", "k2"), std::logic_error);
}

}  // namespace
}  // namespace result_variables_test
