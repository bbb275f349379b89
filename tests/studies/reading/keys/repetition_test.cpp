#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/small_studies.hpp"

namespace repetition_test {
// repeat = { i = [1, 60] }: tables written once for many.
namespace {

using frahm::studies::parse_study;
using frahm::studies::Study;

std::vector<std::string> names_of_elements(const Study& study) {
  std::vector<std::string> names;
  for (const auto& element : study.network.elements) names.push_back(element.name);
  return names;
}

const std::string heading =
    "[study]\nschema = 1\nkind = \"sweep\"\nunits = \"dimensionless\"\n[parameters]\nr = 0.3\nk = 2\n";
const std::string ending =
    "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\nrepeat = { i = [1, 3] }\non = \"floor{i}\"\n"
    "amplitude = \"0.1*{i}\"\n" +
    small_studies::axis("r", 0.1, 0.2, 5);

TEST_CASE("a repeated table is read as if it were written out") {
  const Study study = parse_study(
      heading +
          "[[mass]]\nrepeat = { i = [1, 3] }\nname = \"floor{i}\"\nmass = \"1 + {i}\"\n"
          "[[element]]\nname = \"columns1\"\ntype = \"spring\"\nbetween = [\"ground\", \"floor1\"]\n"
          "stiffness = 1\n"
          "[[element]]\nrepeat = { i = [2, 3] }\nname = \"columns{i}\"\ntype = \"spring\"\n"
          "between = [\"floor{i-1}\", \"floor{i}\"]\nstiffness = \"k/{i+8}\"\n" +
          ending,
      "repeated.toml");
  CHECK(study.network.masses == std::vector<std::string>{"floor1", "floor2", "floor3"});
  CHECK(names_of_elements(study) == std::vector<std::string>{"columns1", "columns2", "columns3"});
  CHECK(study.network.elements[2].along[0].node.index == 1);
  CHECK(study.network.elements[2].along[1].node.index == 2);
  frahm::mechanics::NetworkValues values;
  std::vector<double> parameters = study.parameters.nominal();
  evaluate(study.values, study.parameters, parameters, values);
  CHECK(values.mass == std::vector<double>{2.0, 3.0, 4.0});
  CHECK(values.element == std::vector<double>{1.0, 2.0 / 10.0, 2.0 / 11.0});
  REQUIRE(values.excitation.size() == 3);
  CHECK(values.excitation[2].amplitude == Approx(0.3));
}

TEST_CASE("an index alone stands for a number where a key takes no text") {
  const Study study = parse_study(
      heading +
          "[[mass]]\nname = \"main\"\nmass = 1\n"
          "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = "
          "1\n"
          "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\nrepeat = { n = [1, 5, 2] }\non = \"main\"\n"
          "order = \"{n}\"\namplitude = \"1/{n}^2\"\n" +
          small_studies::axis("r", 0.1, 0.2, 5),
      "orders.toml");
  REQUIRE(study.network.excitations.size() == 3);
  CHECK(study.network.excitations[0].order == 1);
  CHECK(study.network.excitations[1].order == 3);
  CHECK(study.network.excitations[2].order == 5);
}

TEST_CASE("a repetition goes by steps, and over all combinations of several indices") {
  const Study study = parse_study(
      heading +
          "[[mass]]\nrepeat = { i = [1, 3, 2], side = [7, 8] }\nname = \"floor{i}{side}\"\nmass = 1\n"
          "[[element]]\nrepeat = { side = [7, 8], i = [1, 3, 2] }\nname = \"column{i}{side}\"\n"
          "type = \"spring\"\nbetween = [\"ground\", \"floor{i}{side}\"]\nstiffness = 1\n"
          "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\non = \"floor17\"\namplitude = 1\n" +
          small_studies::axis("r", 0.1, 0.2, 5),
      "steps.toml");
  CHECK(study.network.masses == std::vector<std::string>{"floor17", "floor18", "floor37", "floor38"});
  CHECK(names_of_elements(study) == std::vector<std::string>{"column17", "column37", "column18", "column38"});
}

TEST_CASE("twenty storeys fit on a page") {
  const Study study = frahm::studies::read_study(FRAHM_SOURCE_DIR "/studies/structures/twenty_storeys.toml");
  CHECK(study.network.masses.size() == 20);
  CHECK(study.network.elements.size() == 20 + 20 + 7);
  CHECK(std::count(study.source.text.begin(), study.source.text.end(), '\n') < 80);
}

}  // namespace
}  // namespace repetition_test
