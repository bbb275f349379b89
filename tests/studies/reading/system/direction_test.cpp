#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/system/direction_reading.hpp"
#include "tests/studies/temporary_folder.hpp"

namespace direction_test {
// Elements along combinations of coordinates, and masses that rotate, as studies give them.
namespace {

using namespace frahm::studies;
using namespace frahm::mechanics;

const Node ground{}, main_mass{NodeKind::mass, 0}, wheel{NodeKind::mass, 1};

std::string study_with(const std::string& along, const std::string& value = "stiffness = 3",
                       const std::string& type = "spring") {
  return "[study]\nschema = 1\nkind = \"sweep\"\n"
         "[parameters]\nomega = 20\nr = { value = 30, unit = \"mm\" }\nratio = { value = 3, unit = \"1\" "
         "}\nbare = 2\n"
         "arm = \"1.5*r\"\nfitted = \"0.5*r + 3.7*alpha\"\n"
         "alpha = { value = 60, unit = \"degree\" }\n"
         "[[mass]]\nname = \"main\"\nmass = 100\n[[mass]]\nname = \"wheel\"\ninertia = { value = 20, unit = "
         "\"kg cm2\" }\n"
         "[[element]]\nname = \"mount\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = "
         "5e4\n"
         "[[element]]\nname = \"shaft\"\ntype = \"spring\"\nbetween = [\"ground\", \"wheel\"]\n"
         "stiffness = { value = 40, unit = \"N m/rad\" }\n"
         "[[element]]\nname = \"rack\"\ntype = \"" +
         type + "\"\n" + along + "\n" + value +
         "\n[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"wheel\"\n"
         "amplitude = { value = 2, unit = \"N m\" }\n"
         "[[axis]]\nparameter = \"omega\"\nvalues = [10, 20]\n";
}

Element rack_of(const std::string& along, const std::string& value = "stiffness = 3") {
  return parse_study(study_with(along, value), "study.toml").network.elements[2];
}

TEST_CASE("factors are numbers, lengths in their units and expressions of parameters, in SI") {
  CHECK(rack_of("along = { main = 1, wheel = \"-r\", ground = -1 }").along ==
        Direction{{main_mass, 1.0}, {wheel, -30.0 * 1e-3}, {ground, -1.0}});
  CHECK(rack_of("along = { wheel = { value = 5, unit = \"cm\" }, main = \"2*cos(alpha)\" }").along ==
        Direction{{wheel, 5.0 * 0.01}, {main_mass, 2.0 * std::cos(60.0 * (std::numbers::pi / 180.0))}});
  CHECK(rack_of("along = { wheel = { value = 0.05, unit = \"m/rad\" }, main = 1 }").along[0].factor == 0.05);
}

TEST_CASE("an element is rotational where no length is among what it takes") {
  CHECK(rack_of("between = [\"ground\", \"wheel\"]").rotational);
  CHECK_FALSE(rack_of("between = [\"ground\", \"main\"]").rotational);
  CHECK(rack_of("along = { wheel = \"ratio\" }").rotational);
  CHECK(rack_of("along = { wheel = 0.5, ground = -1 }").rotational);
  CHECK(rack_of("along = { main = \"1/r\", wheel = -1 }").rotational);
  CHECK(rack_of("along = { main = { value = 2, unit = \"1/m\" }, wheel = \"ratio\" }").rotational);
  CHECK_FALSE(rack_of("along = { wheel = \"r\", ground = -1 }").rotational);
  CHECK_FALSE(rack_of("along = { main = 1, wheel = 0.5 }").rotational);  // 0.5 m, as in SI
  CHECK_FALSE(rack_of("along = { main = 1, wheel = \"r*bare\" }").rotational);
  CHECK_FALSE(rack_of("along = { main = \"ratio\", wheel = \"sqrt(r*r + r^2)\" }").rotational);
}

TEST_CASE("numbers in a factor are ratios as factors, and of the other's dimension as terms") {
  CHECK_FALSE(rack_of("along = { wheel = \"1.5*r\", ground = -1 }").rotational);
  CHECK_FALSE(rack_of("along = { wheel = \"1 + r\", ground = -1 }").rotational);  // 1 m, as in SI
  CHECK_FALSE(rack_of("along = { wheel = \"arm\", ground = -1 }").rotational);
  CHECK_FALSE(rack_of("along = { main = 1, wheel = \"cos(0.3)\" }").rotational);  // of a metre
  CHECK(rack_of("along = { wheel = \"1 + ratio\", ground = -1 }").rotational);
  CHECK(rack_of("along = { main = 1, wheel = \"1 + r\" }").along[1].factor == 1.0 + 30.0 * 1e-3);
  CHECK(rack_of("along = { main = \"1.5/r\", wheel = -1 }").rotational);
}

TEST_CASE("the ground takes a force of a rack, and a torque of a shaft") {
  CHECK(rack_of("between = [\"ground\", \"wheel\"]").twists_ground);
  CHECK_FALSE(rack_of("along = { main = 1, wheel = \"-r\", ground = -1 }").twists_ground);
  CHECK(rack_of("along = { main = 1, wheel = \"-r\", ground = \"r\" }").twists_ground);
  CHECK_FALSE(rack_of("along = { main = \"1/r\", wheel = -1, ground = \"-1/r\" }").twists_ground);
}

TEST_CASE("values of a rotational element are in N m/rad or N m, kg m2, N m s and N m") {
  const auto value_of = [](const std::string& value, const std::string& type) {
    const Study study =
        parse_study(study_with("between = [\"ground\", \"wheel\"]", value, type), "study.toml");
    return study.values.value(2).expression.evaluate(std::span<const double>());
  };
  CHECK(value_of("stiffness = { value = 7, unit = \"N m\" }", "spring") == 7.0);
  CHECK(value_of("stiffness = { value = 7, unit = \"N m/rad\" }", "spring") == 7.0);
  CHECK(value_of("damping = { value = 7, unit = \"N m s/rad\" }", "damper") == 7.0);
  CHECK(value_of("inertance = { value = 7, unit = \"kg m2\" }", "inerter") == 7.0);
  CHECK(value_of("force = { value = 7, unit = \"N m\" }", "coulomb") == 7.0);
  const Study study = parse_study(study_with("between = [\"ground\", \"wheel\"]"), "study.toml");
  CHECK(study.network.rotation == std::vector<bool>{false, true});
  CHECK(study.values.mass[1].expression.evaluate(std::span<const double>()) == Approx(20e-4));
  CHECK(study.values.amplitude[0].quantity == Quantity::torque);
}

TEST_CASE("a combination of two nodes by -1 and 1 is the element between them") {
  const Element written = rack_of("along = { ground = -1, main = 1 }");
  CHECK(written.along == rack_of("between = [\"ground\", \"main\"]").along);
}

TEST_CASE("a study is given other factors by --set, and not by --at") {
  TemporaryFolder folder;
  folder.write("study.toml", study_with("along = { main = 1, wheel = \"r\" }"));
  const Study study = read_study_with(folder / "study.toml", {"r=45 mm"});
  CHECK(study.network.elements[2].along[1].factor == Approx(0.045));
  CHECK_NOTHROW(parameters_at(study, {"r=45 mm"}));
  CHECK_THROWS_WITH(parameters_at(study, {"r=40 mm"}),
                    Catch::Contains("along: wheel") && Catch::Contains("--set"));
}

TEST_CASE("repeat stands for levers of every storey too") {
  std::string text = study_with("along = { \"main\" = 1, \"wheel\" = \"r*{i}\" }");
  text.replace(text.find("name = \"rack\""), 13, "repeat = { i = [1, 3] }\nname = \"rack{i}\"");
  const Study study = parse_study(text, "study.toml");
  REQUIRE(study.network.elements.size() == 5);
  CHECK(study.network.elements[4].along[1].factor == Approx(0.09));
}

}  // namespace
}  // namespace direction_test
