// Every variable of a result, of each kind of study, is a word that frahm explain knows.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "results/map_reader.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/studies/small_tunings.hpp"

namespace explained_results_test {
namespace {

using runs::Folder, runs::frahm;
using Names = std::set<std::string>;

// Runs the study and checks the names in its result.  own: names that the study gives: of parameters.
void check_explained(const Folder& folder, const std::string& study, const Names& own) {
  const std::string result = folder / "result.h5";
  const auto run = frahm({"run", study, "-o", result, "--fresh", "--threads", "1", "--progress", "none"});
  INFO(study << ": " << run.err);
  REQUIRE((run.code == 0 || run.code == 3 || run.code == 7));
  const ::frahm::results::MapReader reader(result);
  Names names;
  for (const auto& variable : reader.layout().variables) names.insert(variable.name);
  for (const std::string& group : reader.groups()) {
    for (const auto& column : reader.columns(group)) names.insert(column.variable.name);
  }
  CHECK(names.size() > 5);  // a half-power identification has six
  for (const std::string& name : names) {
    if (own.contains(name)) continue;
    const auto explained = frahm({"explain", name});
    INFO(name << ": " << explained.err);
    CHECK(explained.code == 0);
  }
}

TEST_CASE("every variable of the results of the starting studies is explained") {
  const Folder folder;
  REQUIRE(frahm({"new", "decay", folder / "decay.toml"}).code == 0);
  REQUIRE(
      frahm({"export", folder / "decay.toml", "--data", folder / "measured.csv", "--noise", "0.5%"}).code ==
      0);
  for (const char* kind : {"sweep", "decay", "transient", "identify", "tune"}) {
    const std::string study = folder / (std::string(kind) + ".toml");
    if (std::string(kind) != "decay") REQUIRE(frahm({"new", kind, study}).code == 0);
    check_explained(folder, study, {"k", "F", "x0", "k_a", "c_a", "speed"});
  }
}

TEST_CASE("every variable of what a map can have beside its points is explained") {
  const Folder folder;
  using small_studies::axis;
  const std::string output =
      "[output]\nquantities = \"all\"\nborders = true\nbranches = true\nresonances = [\"main\"]\n"
      "orbits = [{ f = 0.2, r = 0.5 }]\n[compare]\nlaw = \"arctan\"\nslope = 100\n";
  check_explained(folder,
                  folder.write("map.toml", small_studies::oscillator() + axis("f", 0.1, 0.3, 3) +
                                               axis("r", 0.3, 1.5, 7) + output),
                  {"f", "r"});
  const std::string samples =
      "[[axis]]\nsamples = 8\nof = [{ parameter = \"f\", distribution = \"uniform\", lower = 0.1, upper = "
      "0.2 "
      "}]\n";
  check_explained(
      folder, folder.write("samples.toml", small_studies::oscillator() + samples + axis("r", 0.3, 1.5, 7)),
      {"f", "r"});
}

TEST_CASE("every variable of a trade-off with a schedule and a column is explained") {
  const Folder folder;
  using namespace small_tunings;
  const std::string front = "trade_off = { quantity = \"tmd_peak\", values = [12, 15] }\n";
  const std::string schedule = "schedule = { knots = 3 }\nrule = \"0.9\"\n";
  const std::string column =
      "[[column]]\nname = \"gear\"\nvalue = \"2*f\"\nupper = 2.2\n"
      "[[constraint]]\nquantity = \"main_rms\"\nupper = 20\n";
  check_explained(
      folder,
      folder.write("front.toml", heading + absorber + minimax + front + of_f + schedule + of_zeta + column),
      {"r", "f", "f_0", "f_1", "f_2", "zeta", "gear"});
}

// Those alone that need no result of another: together they have every method of the studies.
TEST_CASE("every estimate and row of the methods of identification is explained") {
  const Folder folder;
  const std::filesystem::path studies = std::filesystem::path(FRAHM_SOURCE_DIR) / "studies/identification";
  for (const auto& entry : std::filesystem::directory_iterator(studies)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("identify_") || entry.path().extension() != ".toml") continue;
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    if (text.find(".h5\"") != std::string::npos) continue;
    Names own;
    for (const std::string& parameter : ::frahm::studies::read_study(entry.path()).parameters.names()) {
      own.insert(parameter);
    }
    check_explained(folder, entry.path(), own);
  }
}

}  // namespace
}  // namespace explained_results_test
