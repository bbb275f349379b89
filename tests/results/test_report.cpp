#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "results/map_writer.hpp"
#include "results/report/page_data.hpp"
#include "results/report/page_numbers.hpp"
#include "results/report/report_page.hpp"
#include "sample.hpp"
#include "temporary_directory.hpp"

namespace test_report {
using namespace frahm::results;

namespace {

using Json = nlohmann::json;

std::set<std::string> names_in(const Json& list) {
  std::set<std::string> names;
  for (const Json& item : list) names.insert(item["name"]);
  return names;
}

Json data_of_sample(const std::vector<std::string>& variables) {
  const TemporaryDirectory directory;
  sample::write(directory / "sample.h5");
  return Json::parse(
      page_data(MapReader(directory / "sample.h5"), {.file = "sample.h5", .variables = variables}));
}

TEST_CASE("a page has the axes, the variables asked for, and the names of the others") {
  const MapLayout layout = sample::layout();
  const std::string first = layout.variables.front().name;
  const Json data = data_of_sample({first});
  CHECK(data["title"] == layout.title);
  REQUIRE(data["map"]["axes"].size() == layout.axes.size());
  CHECK(data["map"]["axes"][0]["coordinates"][0]["values"] == layout.axes[0].coordinates[0].values);
  CHECK(names_in(data["map"]["variables"]) == std::set<std::string>{first});
  CHECK(data["map"]["left_out"].size() == layout.variables.size() - 1);
  CHECK(data["provenance"]["study"] == sample::study_text());
}

TEST_CASE("a page has every group of the file but the provenance, those in /page by their own names") {
  const TemporaryDirectory directory;
  sample::write(directory / "sample.h5");
  const MapReader result(directory / "sample.h5");
  const Json data = Json::parse(page_data(result, {.file = "sample.h5"}));
  for (const std::string& group : result.groups())
    CHECK(data["groups"].contains(group) == (group != "provenance" && !group.starts_with("page")));
  CHECK(names_in(data["groups"]["crank"]["columns"]) == std::set<std::string>{"angle"});
  CHECK(data["groups"]["crank"]["texts"]["of"] == "main");
}

TEST_CASE("a page knows from /page the parameters of the study and the axis of samples") {
  const TemporaryDirectory directory;
  sample::write(directory / "sample.h5");
  const MapReader result(directory / "sample.h5");
  const Json map = Json::parse(page_data(result, {.file = "sample.h5"}))["map"];
  CHECK(map["parameters"] == Json{"k", "c"});
  CHECK(map["samples"] == 0);
  using Names = std::vector<std::string>;
  CHECK(page_list(result, "parameters") == Names{"k", "c"});
  CHECK(page_list(result, "none") == Names{});
  CHECK_FALSE(page_list(result, "no such text"));
}

TEST_CASE("of a file without /page the axes stand for the parameters") {
  const TemporaryDirectory directory;
  MapWriter writer(directory / "early.h5", sample::layout());
  writer.write_texts("provenance", {{"study", ""}});
  writer.finish();
  const MapReader result(directory / "early.h5");
  const Json map = Json::parse(page_data(result, {.file = "early.h5"}))["map"];
  CHECK(map["parameters"] == Json{"design", "omega"});
  CHECK_FALSE(map.contains("samples"));
  CHECK_FALSE(page_list(result, "parameters"));
}

TEST_CASE("a variable that the map does not have is refused by name") {
  CHECK_THROWS_WITH(data_of_sample({"velocity"}), Catch::Contains("no quantity \"velocity\""));
}

TEST_CASE("no text of a study can end the element that holds the page's data") {
  const TemporaryDirectory directory;
  MapLayout layout = sample::layout();
  layout.title = "</script><!-- <script>";
  MapWriter writer(directory / "hostile.h5", layout);
  writer.write_texts("provenance", {{"study", "title = \"</script>\""}});
  writer.finish();
  const std::string data = page_data(MapReader(directory / "hostile.h5"), {.file = "<b>.h5"});
  CHECK(data.find('<') == std::string::npos);
  CHECK(Json::parse(data)["title"] == layout.title);
}

TEST_CASE("variables of the same levels are carried once") {
  const TemporaryDirectory directory;
  MapLayout layout = sample::layout();
  layout.variables.resize(1);
  layout.variables.push_back(layout.variables.front());
  layout.variables.back().name = "twin";
  MapWriter writer(directory / "twins.h5", layout);
  writer.write_texts("provenance", {{"study", ""}});
  writer.finish();
  const std::string first = layout.variables.front().name;
  const Json data = Json::parse(
      page_data(MapReader(directory / "twins.h5"), {.file = "twins.h5", .variables = {first, "twin"}}));
  CHECK(data["map"]["variables"][1]["levels_of"] == first);
  CHECK_FALSE(data["map"]["variables"][1].contains("levels"));
}

PackedLevels packed(const std::vector<double>& values, Spacing spacing = Spacing::six_digits) {
  return pack_levels(values, {.size = values.size(), .stride = 1}, spacing);
}

TEST_CASE("levels have six digits of each value where none is negative, else of the range") {
  const double none = std::numeric_limits<double>::quiet_NaN(),
               endless = std::numeric_limits<double>::infinity();
  const PackedLevels of_each = packed({1e-9, none, 5.0, endless, 0.0});
  CHECK(of_each.logarithmic);
  CHECK(of_each.low == 1e-9);
  CHECK(of_each.step == millionth);
  const PackedLevels of_range = packed({-1.0, none, 1.0});
  CHECK_FALSE(of_range.logarithmic);
  CHECK(of_range.low == -1.0);
  CHECK(of_range.step ==
        Approx(millionth).epsilon(1e-12));  // a power of ten, at most a millionth of the range
  CHECK(packed({-0.4, 0.599}).step == Approx(1e-7).epsilon(1e-12));
}

TEST_CASE("levels of whole numbers, of nothing and of one number") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(packed({1.0, 4.0}, Spacing::whole).step == 1.0);
  CHECK(packed({none, none}).step == 0.0);
  CHECK(packed({0.0, 0.0}).step == 0.0);
  CHECK(packed({-7.0, -7.0}).step == 0.0);
}

TEST_CASE("levels over all that a double can hold: coarser, so that their differences stay within 32 bits") {
  const PackedLevels widest = packed({1e-300, 1.0, 1e300});
  CHECK(widest.step == Approx(600.0 * std::log(10.0) / 5e8));
  CHECK(widest.step > millionth);
}

TEST_CASE("the page stands around its data") {
  if (!has_report_page()) {
    CHECK_THROWS_AS(report_page("a", "{}"), std::logic_error);
    return;
  }
  const std::string page = report_page("<i> & co", "{\"format\":1}");
  CHECK(page.starts_with("<!doctype html>"));
  CHECK(page.find("<title>&lt;i> &amp; co</title>") != std::string::npos);
  CHECK(page.find("id=\"data\">{\"format\":1}</script>") != std::string::npos);
  CHECK(figure_script().size() > 10'000);
}

}  // namespace
}  // namespace test_report
