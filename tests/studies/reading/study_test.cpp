#include "studies/reading/study/study.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "studies/map/grid.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/study_path.hpp"

namespace study_test {
namespace {

using namespace frahm::studies;
using namespace frahm::mechanics;

constexpr double rounding = 1e-14;  // a few roundings of double arithmetic
const std::string studies = FRAHM_SOURCE_DIR "/studies/";

// A small study, into which tests put what they are about.
const std::string heading = "[study]\nschema = 1\nkind = \"sweep\"\n";
const std::string oscillator =
    "[[mass]]\nname = \"main\"\nmass = 2\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = 8\n"
    "[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"main\"\namplitude = 1\n";

std::string complaint_about(const std::string& text) {
  try {
    parse_study(text, "study.toml");
  } catch (const StudyError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("every study of the project is read") {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(studies)) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path().string());
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    // What an earlier run is to leave beside the study is not there yet.
    const bool of_a_chain = text.str().find(".h5\"") != std::string::npos;
    CHECK_NOTHROW(parse_study(text.str(), entry.path(), of_a_chain ? DataFiles::leave : DataFiles::read));
    ++count;
  }
  CHECK(count >= 7);
}

TEST_CASE("the rig atlas is the network and the grid of its file") {
  const Study rig = read_study(study_path("rig_atlas"));
  CHECK_FALSE(rig.dimensionless);
  CHECK(rig.network.masses == std::vector<std::string>{"main", "tmd"});
  CHECK(rig.network.prescribed == std::vector<std::string>{"exciter"});
  REQUIRE(rig.network.elements.size() == 8);
  CHECK(rig.network.elements[1].name == "drive");
  CHECK(rig.network.elements[1].along[0].node == Node{NodeKind::prescribed, 0});
  CHECK(rig.network.elements[1].along[1].node == Node{NodeKind::mass, 0});
  CHECK(rig.network.elements[6].type == ElementType::inerter);
  REQUIRE(rig.network.excitations.size() == 1);
  CHECK(rig.network.excitations[0].kind == ExcitationKind::motion);
  CHECK(rig.network.reference_order == 1);

  REQUIRE(rig.map()->dimensions.size() == 3);
  CHECK(rig.map()->dimensions[0].name == "I");
  CHECK(rig.map()->dimensions[0].size == 42);
  CHECK(rig.map()->dimensions[1].size == 31);
  CHECK(rig.map()->dimensions[2].size == 401);
  CHECK(rig.sweep()->frequency_dimension == std::size_t{2});
  CHECK(rig.map()->axes[0].unit == "kg");
  CHECK(rig.map()->axes[0].values.back() == 12.9);
  CHECK(rig.map()->axes[2].unit == "rpm");
  CHECK(rig.map()->axes[2].values[1] == 150.5);
  CHECK_THAT(rig.map()->axes[2].si_values[0], Catch::WithinRel(5.0 * std::numbers::pi, rounding));
}

TEST_CASE("the rig atlas has the published values at 250 rpm and I = 6.36 kg") {
  const Study rig = read_study(study_path("rig_atlas"));
  auto parameters = rig.parameters.nominal();
  frahm::mechanics::NetworkValues values;
  evaluate(rig.values, rig.parameters, parameters, values);
  CHECK_THAT(values.omega, Catch::WithinRel(26.179938779914945, rounding));
  CHECK(values.mass == std::vector<double>{102.66, 12.82});
  CHECK_THAT(values.element[0], Catch::WithinRel(49086.0, rounding));
  CHECK_THAT(values.element[2], Catch::WithinRel(0.0419 * 8181.0 * 0.02955, rounding));
  CHECK_THAT(values.element[5], Catch::WithinRel(26.5104 + 0.4811 * 6.36, rounding));
  CHECK_THAT(values.excitation[0].amplitude, Catch::WithinRel(0.02955, rounding));
  CHECK_THAT(values.excitation[0].phase, Catch::WithinRel(-std::numbers::pi / 2.0, rounding));
}

TEST_CASE("derived coordinates lie along their dimension") {
  const Study rig = read_study(study_path("rig_atlas"));
  REQUIRE(rig.map()->coordinates.size() == 2);
  CHECK(rig.map()->coordinates[0].dimension == 2);
  const auto ratios = coordinate_values(rig, rig.map()->coordinates[0]);
  REQUIRE(ratios.size() == 401);
  const double natural = std::sqrt(7.0 * 8181.0 / 102.66);
  CHECK_THAT(ratios[0], Catch::WithinRel(5.0 * std::numbers::pi / natural, rounding));
  CHECK_THAT(coordinate_values(rig, rig.map()->coordinates[1])[41],
             Catch::WithinRel(12.9 / 102.66, rounding));
}

TEST_CASE("a study of two frequencies has its orders and the lowest as reference") {
  const Study study = read_study(study_path("cheng_zu"));
  REQUIRE(study.network.excitations.size() == 2);
  CHECK(study.network.excitations[0].order == 1);
  CHECK(study.network.excitations[1].order == 3);
  CHECK(study.network.reference_order == 1);
  CHECK(read_study(study_path("cheng_zu_even")).network.excitations[1].order == 2);
}

TEST_CASE("a support's motion given by its velocity or acceleration is that of its displacement") {
  const auto excitation_of = [](const std::string& motion) {
    const Study study = parse_study(
        heading +
            "[parameters]\nomega = { value = 3, unit = \"rad/s\" }\na0 = { value = 0.1, unit = \"m/s^2\" }\n"
            "[[mass]]\nname = \"main\"\nmass = 2\n"
            "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"quake\", \"main\"]\nstiffness = "
            "8\n"
            "[excitation]\nfrequency = \"omega\"\n[[excitation.motion]]\nnode = \"quake\"\n" +
            motion + "\n[[axis]]\nparameter = \"omega\"\nunit = \"rad/s\"\nfrom = 1\nto = 5\npoints = 5\n",
        "motion.toml");
    frahm::mechanics::NetworkValues values;
    std::vector<double> parameters = study.parameters.nominal();
    evaluate(study.values, study.parameters, parameters, values);
    return values.excitation.at(0);
  };
  constexpr double pi = std::numbers::pi;
  const auto of_velocity = excitation_of("velocity = { value = 0.6, unit = \"cm/s\" }\norder = 2");
  CHECK(of_velocity.amplitude == Approx(0.006 / (2 * 3)).epsilon(rounding));
  CHECK(of_velocity.phase == Approx(-pi / 2).epsilon(rounding));
  const auto of_acceleration = excitation_of("acceleration = \"2*a0\"\nphase = 0.3");
  CHECK(of_acceleration.amplitude == Approx(0.2 / (3 * 3)).epsilon(rounding));
  CHECK(of_acceleration.phase == Approx(0.3 + pi).epsilon(rounding));
}

TEST_CASE("an axis runs linearly, by ratios or over given values, ends exact") {
  const Study study =
      parse_study(heading + "[parameters]\nomega = 1\na = 1\nb = 1\n" + oscillator +
                      "[[axis]]\nparameter = \"a\"\nfrom = 0.1\nto = 0.7\npoints = 4\n"
                      "[[axis]]\nparameter = \"b\"\nfrom = 1\nto = 1000\npoints = 4\nspacing = \"log\"\n"
                      "[[axis]]\nparameter = \"omega\"\nunit = \"Hz\"\nvalues = [3, 1, 2]\n",
                  "study.toml");
  CHECK(study.map()->axes[0].values.front() == 0.1);
  CHECK(study.map()->axes[0].values.back() == 0.7);
  CHECK_THAT(study.map()->axes[0].values[1], Catch::WithinRel(0.3, rounding));
  CHECK_THAT(study.map()->axes[1].values[2], Catch::WithinRel(100.0, rounding));
  CHECK(study.map()->axes[1].values[3] == 1000.0);
  CHECK(study.map()->axes[1].unit.empty());
  CHECK(study.map()->axes[2].values == std::vector<double>{3, 1, 2});
  CHECK_THAT(study.map()->axes[2].si_values[1], Catch::WithinRel(2.0 * std::numbers::pi, rounding));
}

TEST_CASE("zipped axes share a dimension and are placed together") {
  const Study study = parse_study(heading + "[parameters]\nomega = 1\na = 1\nb = 1\n" + oscillator +
                                      "[[axis]]\nparameter = \"a\"\nvalues = [1, 1, 3]\nzip = \"pair\"\n"
                                      "[[axis]]\nparameter = \"omega\"\nvalues = [4, 5]\n"
                                      "[[axis]]\nparameter = \"b\"\nvalues = [7, 8, 9]\nzip = \"pair\"\n",
                                  "study.toml");
  REQUIRE(study.map()->dimensions.size() == 2);
  CHECK(study.map()->dimensions[0].name == "pair");
  CHECK(study.map()->dimensions[0].axes == std::vector<std::size_t>{0, 2});
  auto parameters = study.parameters.nominal();
  set_along(*study.sweep(), 0, 2, parameters);
  CHECK(parameters == std::vector<double>{1, 3, 9});
}

TEST_CASE("the frequency dimension is one along which the matrices stay the same, if there is one") {
  const auto study = [](const std::string& frequency, const std::string& mass) {
    return parse_study(
        heading + "[parameters]\nr = 1\nw = 2\n[[mass]]\nname = \"main\"\nmass = \"" + mass + "\"\n" +
            "[[element]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\n"
            "stiffness = 8\n[excitation]\nfrequency = \"" +
            frequency +
            "\"\n[[excitation.force]]\n"
            "on = \"main\"\namplitude = 1\n[[axis]]\nparameter = \"r\"\nvalues = [1, 2]\n[[axis]]\n"
            "parameter = \"w\"\nvalues = [1, 2]\n",
        "study.toml");
  };
  CHECK(study("r*w", "1").sweep()->frequency_dimension == std::size_t{1});
  CHECK(study("r*w", "w^2").sweep()->frequency_dimension == std::size_t{0});
  CHECK(study("r*w", "r*w").sweep()->frequency_dimension == std::size_t{1});
  CHECK_FALSE(study("3", "w").sweep()->frequency_dimension);
}

TEST_CASE("Hz are cycles in everything the frequency depends on, and refused where they could be either") {
  const std::string axis = "[[axis]]\nparameter = \"r\"\nvalues = [1]\n";
  const std::string text =
      heading + "[parameters]\nr = 1\nf0 = { value = 2, unit = \"Hz\" }\nomega = \"r*f0\"\n";
  const Study study = parse_study(text + oscillator + axis, "study.toml");
  CHECK_THAT(study.parameters.nominal()[2], Catch::WithinRel(4.0 * std::numbers::pi, rounding));
  CHECK_THAT(
      complaint_about(heading + "[parameters]\nr = 1\nomega = \"r\"\nf0 = { value = 2, unit = \"Hz\" }\n" +
                      oscillator + axis),
      Catch::Contains("may count cycles or radians"));
}

TEST_CASE("a schedule is read from a table beside the study and refused outside it") {
  const auto folder = std::filesystem::temp_directory_path() / "frahm_study_file_test";
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "schedule.csv") << "omega,I\n15,4\n35,12\n";
  const auto study = [&](const std::string& to) {
    return parse_study(heading +
                           "[parameters]\nomega = 20\nI = { table = \"schedule.csv\", of = \"omega\" }\n" +
                           oscillator +
                           "[[element]]\nname = \"inerter\"\ntype = \"inerter\"\n"
                           "between = [\"ground\", \"main\"]\ninertance = \"I\"\n"
                           "[[axis]]\nparameter = \"omega\"\nfrom = 15\nto = " +
                           to + "\npoints = 3\n",
                       folder / "study.toml");
  };
  const Study inside = study("35");
  CHECK(inside.parameters.nominal() == std::vector<double>{20, 6});
  CHECK_THROWS_WITH(study("40"), Catch::Contains("it covers omega from 15 rad/s to 35 rad/s, here 40 rad/s"));
  // 100 rpm = 10.5 rad/s, 300 rpm = 31.4 rad/s; 20 rad/s = 191 rpm.
  std::ofstream(folder / "schedule.csv") << "omega [rpm],I [g]\n100,4000\n300,12000\n";
  const double rpm = std::numbers::pi / 30.0;
  CHECK_THAT(study("30").parameters.nominal()[1],
             Catch::WithinRel(4.0 + 8.0 * (20.0 / rpm - 100.0) / 200.0, rounding));
  std::ofstream(folder / "schedule.csv") << "omega [mm],I [g]\n100,4000\n300,12000\n";
  CHECK_THROWS_WITH(study("30"), Catch::Contains("schedule.csv: its column of \"omega\""));
  std::filesystem::remove_all(folder);
}

TEST_CASE("quantities keep their places and orbits are in the units of their axes") {
  const Study study =
      parse_study(heading + "[parameters]\nomega = { value = 60, unit = \"rpm\" }\nI = 1\n" + oscillator +
                      "[[axis]]\nparameter = \"omega\"\nunit = \"Hz\"\nvalues = [1, 2]\n"
                      "[output]\nquantities = [\"main_peak\", \"status\"]\nprecision = \"single\"\n"
                      "orbits = [{ omega = 2, I = 6 }, { omega = { value = 60, unit = \"rpm\" } }]\n",
                  "study.toml");
  CHECK(study.map()->output.quantities == OutputChoice::Quantities::listed);
  CHECK(study.map()->output.precision == Precision::single);
  CHECK_FALSE(study.sweep()->general_path);
  REQUIRE(study.map()->output.names.size() == 2);
  const auto& name = study.map()->output.names[1];
  CHECK_THAT(study.source.error_at(frahm::studies::rules::not_text, name.position, "{}", name.text).what(),
             Catch::StartsWith("study.toml:25:28: status\n"));
  REQUIRE(study.map()->output.histories.size() == 2);
  CHECK_THAT(study.map()->output.histories[0].at[0].value,
             Catch::WithinRel(4.0 * std::numbers::pi, rounding));
  CHECK(study.map()->output.histories[0].at[1].value == 6.0);
  CHECK_THAT(study.map()->output.histories[1].at[0].value,
             Catch::WithinRel(2.0 * std::numbers::pi, rounding));
}

TEST_CASE("a study begins with a byte order mark or has Windows line ends and is read all the same") {
  std::string text = "\xEF\xBB\xBF" + heading + "[parameters]\nomega = 1\n" + oscillator +
                     "[[axis]]\nparameter = \"omega\"\nvalues = [1]\n";
  CHECK(complaint_about(text) == "none");
  for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.replace(i, 1, "\r\n");
  CHECK(complaint_about(text) == "none");
}

TEST_CASE("a file that cannot be read is an error that names it") {
  CHECK_THROWS_WITH(read_study("no_such_study.toml"),
                    Catch::StartsWith("no_such_study.toml: cannot be read"));
  CHECK_THROWS_WITH(read_study(studies), Catch::Contains("it is a directory"));
}

TEST_CASE("parts of a study cut off anywhere are read or refused, never a crash") {
  const Study rig = read_study(study_path("rig_atlas"));
  const std::string& text = rig.source.text;
  std::size_t refused = 0;
  for (std::size_t length = 0; length < text.size(); length += 7) {
    refused += complaint_about(text.substr(0, length)) != "none";
  }
  CHECK(refused > 200);
}

TEST_CASE("more friction elements than a flag can name have no borders") {
  const auto study = [](int elements) {
    std::string text =
        "[study]\nschema = 1\nkind = \"sweep\"\nunits = \"dimensionless\"\n[parameters]\nr = 1\n"
        "[[mass]]\nname = \"main\"\nmass = 1\n[[element]]\nname = \"spring\"\ntype = \"spring\"\n"
        "between = [\"ground\", \"main\"]\nstiffness = 1\n";
    for (int i = 0; i < elements; ++i)
      text += "[[element]]\nname = \"guide_" + std::to_string(i) +
              "\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"main\"]\nforce = 0.01\n";
    return text +
           "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\non = \"main\"\namplitude = 1\n"
           "[[axis]]\nparameter = \"r\"\nvalues = [0.5, 2]\n[output]\nborders = true\n";
  };
  CHECK(complaint_about(study(127)) == "none");
  CHECK_THAT(complaint_about(study(128)),
             Catch::Contains("borders: there are 128 coulomb elements; at most 127"));
}

}  // namespace
}  // namespace study_test
