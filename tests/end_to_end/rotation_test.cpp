// Motions of a rotor: in rad, by the same closed forms as a mass on a rubbing guide.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "tests/end_to_end/motion_file.hpp"

namespace rotation_test {
namespace {

constexpr double k = 8.0, T = 0.4, natural = 20.0;  // [N m/rad], [N m], sqrt(k/J) [rad/s], J = 0.02 kg m2

std::string rotor(const std::string& kind, const std::string& more) {
  return "[study]\nschema = 1\nkind = \"" + kind +
         "\"\n[[mass]]\nname = \"rotor\"\ninertia = { value = 200, unit = \"kg cm2\" }\n"
         "[[element]]\nname = \"shaft\"\ntype = \"spring\"\nbetween = [\"ground\", \"rotor\"]\n"
         "stiffness = { value = 8, unit = \"N m/rad\" }\n"
         "[[element]]\nname = \"bearing\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"rotor\"]\n"
         "force = { value = 400, unit = \"N mm\" }\n" +
         more;
}

TEST_CASE("a rotor that swings out loses 4 T/k of its angle a turn and rests where the bearing holds it") {
  const runs::Folder folder;
  const std::string study = folder.write(
      "rotor.toml",
      rotor("decay", "[[initial]]\nnode = \"rotor\"\ndisplacement = { value = 30, unit = \"degree\" }\n"));
  const runs::MotionFile file(study, "decay");
  const auto& extrema = file["rotor_extremum"];
  const double first = std::numbers::pi / 6.0, step = 2.0 * T / k;
  for (std::size_t i = 0; i < extrema.size(); ++i) {
    const double expected = (i % 2 == 0 ? 1.0 : -1.0) * (first - step * static_cast<double>(i));
    CHECK_THAT(extrema[i], Catch::WithinAbs(expected, 1e-12));
  }
  REQUIRE(extrema.size() == 6);  // 0.5236 rad less 5 times 0.1 is within T/k = 0.05 of the middle
  CHECK_THAT(file["stop_time"][0], Catch::WithinRel(5.0 * std::numbers::pi / natural, 1e-12));
  const runs::Outcome told = runs::frahm({"run", study, "-o", folder / "told.h5"});
  CHECK_THAT(told.out, Catch::Contains("extremum [rad]") && !Catch::Contains("[m]"));
}

TEST_CASE("a torque suddenly applied turns a rotor twice as far as it holds, less the bearing's friction") {
  const runs::Folder folder;
  const std::string study = folder.write(
      "rotor.toml", rotor("transient",
                          "[excitation]\nfrequency = 1\n[[excitation.force]]\non = \"rotor\"\norder = 0\n"
                          "amplitude = { value = 2, unit = \"N m\" }\n[transient]\nduration = 2\n"));
  const runs::MotionFile file(study, "transient");
  CHECK_THAT(file["rotor_peak"][0], Catch::WithinRel(2.0 * (2.0 - T) / k, 1e-12));
  CHECK_THAT(file["rotor_peak_time"][0], Catch::WithinRel(std::numbers::pi / natural, 1e-12));
  const runs::Outcome told = runs::frahm({"run", study, "-o", folder / "told.h5"});
  CHECK_THAT(told.out, Catch::Contains("peak [rad]") && !Catch::Contains("[m]"));
  const std::string table = folder / "data.csv";
  const runs::Outcome data = runs::frahm({"export", study, "--data", table, "--columns",
                                          "rotor_displacement,rotor_velocity", "--noise", "0.1 degree"});
  CHECK(data.code != 0);  // an angle is no noise of an angular velocity
  CHECK_THAT(data.err, Catch::Contains("an angular frequency"));
  REQUIRE(runs::frahm({"export", study, "--data", table, "--noise", "0.1 degree"}).code == 0);
  std::stringstream text;
  text << std::ifstream(table).rdbuf();
  CHECK_THAT(text.str(), Catch::Contains("rotor_displacement [rad]"));
}

}  // namespace
}  // namespace rotation_test
