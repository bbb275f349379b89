// What a run writes of its study for the page.
#include "studies/page/page_groups.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/studies/small_tunings.hpp"

namespace page_groups_test {
namespace {

using namespace frahm::studies;
namespace results = frahm::results;
using Names = std::vector<std::string>;
using Groups = std::vector<results::GroupContent>;

// Of a map with these quantities.
Groups groups_of(const std::string& text, const Names& quantities = {}, const Names& axes = {}) {
  results::MapLayout layout;
  for (const std::string& name : axes) layout.axes.push_back({.name = name, .size = 1});
  for (const std::string& name : quantities) layout.variables.push_back({.name = name, .unit = "1"});
  return page_groups(parse_study(text, "study.toml"), layout);
}

Names paths_of(const Groups& groups) {
  Names paths;
  for (const results::GroupContent& group : groups) paths.push_back(group.path);
  return paths;
}

std::string text_of(const results::GroupContent& group, const std::string& name) {
  const auto found = std::ranges::find(group.texts, name, &results::Text::first);
  return found == group.texts.end() ? "no " + name : found->second;
}

double number_of(const results::GroupContent& group, const std::string& name) {
  for (const results::Column& column : group.columns)
    if (column.variable.name == name) return column.values.at(0);
  throw std::out_of_range("no " + name);
}

const std::string map =
    small_studies::oscillator() + small_studies::axis("f", 0.1, 1, 2) + small_studies::axis("r", 0.2, 2, 3);
const Names recorded{"main_rms", "main_peak", "status", "spring_stroke", "continuum"};

TEST_CASE("of a map its parameters, and the marked quantities, or all where no number is marked") {
  const Groups groups = groups_of(map, recorded, {"f", "r"});
  CHECK(paths_of(groups) == Names{"page"});
  CHECK(text_of(groups[0], "parameters") == "f,r");
  CHECK(text_of(groups[0], "shown") == "main_peak,status,spring_stroke");
  CHECK(text_of(groups[0], "always_shown") == "continuum");
  CHECK(text_of(groups[0], "samples") == "no samples");
  CHECK(text_of(groups_of(map, {"main_rms", "continuum"}, {"f", "r"})[0], "shown") == "main_rms,continuum");
}

TEST_CASE("[report] chooses the quantities of a map, by patterns too, and its headline comes first") {
  const auto shown = [](const std::string& report) {
    return text_of(groups_of(map + "[report]\n" + report, recorded, {"f", "r"})[0], "shown");
  };
  CHECK(shown("headline = \"spring\"\n") == "spring_stroke,main_peak,status");
  CHECK(shown("quantities = [\"status\", \"main_*\"]\n") == "status,main_rms,main_peak");
  CHECK(shown("quantities = [\"status\"]\nheadline = \"main\"\n") == "main_peak,status");
}

TEST_CASE("the differences of a comparison are shown, and the other one of two responses") {
  const Names compared{"main_peak", "main_peak_compared", "main_peak_difference", "status_compared"};
  const auto shown = [&](const std::string& text, const std::string& compare) {
    return text_of(groups_of(text + "[compare]\n" + compare, compared, {"f", "r"})[0], "shown");
  };
  CHECK(shown(map, "law = \"arctan\"\nslope = 100\n") == "main_peak,main_peak_difference");
  std::string several = map;  // with static friction there may be several responses
  several.insert(several.find("[excitation]"), "static_force = 2\n");
  CHECK(shown(several, "show = \"smallest\"\n") ==
        "main_peak,main_peak_compared,main_peak_difference,status_compared");
}

TEST_CASE("of a map with samples the axis along which they lie; none of it of another result") {
  const std::string study =
      small_studies::oscillator() + small_studies::axis("r", 0.3, 1.5, 7) +
      "[[axis]]\nsamples = 8\nof = [{ parameter = \"f\", distribution = \"uniform\", lower = 0.1, upper = "
      "0.2 }]\n";
  CHECK(text_of(groups_of(study, recorded, {"r", "draw"})[0], "samples") == "draw");
  CHECK(text_of(groups_of(study, recorded, {"r", "draw"})[0], "parameters") == "r,f");
  CHECK(groups_of(study)[0].texts.empty());
}

TEST_CASE("what a map always shows is what its profile is drawn from") {
  const Groups groups =
      groups_of(small_studies::building(2, 1, 2) + "[report]\nprofile = \"all\"\n",
                {"floor2_peak", "continuum", "floor1_peak", "spring1_stroke", "floor1_rms"}, {"r"});
  CHECK(paths_of(groups) == Names{"page", "page/profile"});
  CHECK(text_of(groups[0], "always_shown") == "continuum,floor1_peak,floor2_peak,spring1_stroke");
}

TEST_CASE("of a motion whether it can end, its period and its signals") {
  const std::string begin =
      "[study]\nschema = 1\nkind = \"transient\"\n[[mass]]\nname = \"m\"\nmass = 1\n"
      "[[element]]\nname = \"k\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\nstiffness = 4\n"
      "[[element]]\nname = \"joint\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"m\"]\nforce = 1\n"
      "[[output.signal]]\nname = \"twice\"\nalong = { m = 2 }\n";
  const Groups groups = groups_of(begin +
                                  "[excitation]\nfrequency = { value = 60, unit = \"rpm\" }\n"
                                  "[[excitation.force]]\non = \"m\"\namplitude = 1\n"
                                  "[transient]\nduration = 1\n");
  REQUIRE(paths_of(groups) == Names{"page", "page/study"});
  CHECK(number_of(groups[1], "rubbing_elements") == 1.0);
  CHECK(number_of(groups[1], "hysteretic_elements") == 0.0);
  CHECK(number_of(groups[1], "given_duration") == 1.0);
  CHECK(number_of(groups[1], "excitation_frequency") == Approx(2.0 * 3.14159265358979).epsilon(1e-14));
  CHECK(number_of(groups[1], "frequency_unit") == Approx(3.14159265358979 / 30.0).epsilon(1e-14));
  CHECK(text_of(groups[1], "signals") == "twice");
}

TEST_CASE("of a tuning the excitation for which it holds, and where in the band a limit does") {
  using namespace small_tunings;
  CHECK(paths_of(groups_of(classical)) == Names{"page"});
  const std::string friction =
      "[[element]]\nname = \"joint\"\ntype = \"coulomb\"\nbetween = [\"main\", \"tmd\"]\nforce = 0.01\n";
  const std::string limit =
      "[[constraint]]\nquantity = \"tmd_peak\"\nupper = 50\nband = { from = 0.8, to = 1.1 }\n";
  const Groups groups = groups_of(heading + absorber + friction + minimax + of_f + of_zeta + limit);
  REQUIRE(paths_of(groups) == Names{"page", "page/study"});
  CHECK(text_of(groups[1], "excitation") == "force on main, 1");
  CHECK(number_of(groups[1], "tmd_peak_band_from") == 0.8);
  CHECK(number_of(groups[1], "tmd_peak_band_to") == 1.1);
  const std::string scenarios =
      "[[scenario]]\nname = \"one\"\nset = { P = 1 }\n[[scenario]]\nname = \"two\"\nset = { P = 2 }\n";
  const Groups several = groups_of(heading + absorber + friction + minimax + of_f + of_zeta + scenarios);
  CHECK(text_of(several.at(1), "excitation_two") == "force on main, 2");
}

}  // namespace
}  // namespace page_groups_test
