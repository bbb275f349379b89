// An identification of stops and static friction from simulated measurements of its own system.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/end_to_end/runs.hpp"

namespace identify_stops_test {
namespace {

// A machine on a guide that holds harder than it rubs, between buffers.
const std::string kSystem = R"(
[[mass]]
name = "machine"
mass = 2.0
[[element]]
name = "spring"
type = "spring"
between = ["ground", "machine"]
stiffness = "k"
[[element]]
name = "guide"
type = "coulomb"
between = ["ground", "machine"]
force = "F"
static_force = "F_s"
[[element]]
name = "buffers"
type = "gap"
between = ["ground", "machine"]
clearance = "D"
stiffness = "k_b"
damping = "c_b"
[excitation]
frequency = 16
[[excitation.force]]
on = "machine"
amplitude = 14
phase = -1.5
)";

const std::vector<std::string> kNames = {"k", "F", "F_s", "D", "k_b", "c_b"};
const std::map<std::string, double> kTruth{{"k", 800.0},  {"F", 2.0},      {"F_s", 4.0},
                                           {"D", 0.0083}, {"k_b", 6000.0}, {"c_b", 9.0}};
const std::map<std::string, double> kOff{{"k", 1.05}, {"F", 0.8},   {"F_s", 1.2},
                                         {"D", 1.1},  {"k_b", 0.8}, {"c_b", 1.4}};

std::string parameters(bool off) {
  std::string text = "[parameters]\n";
  for (const std::string& name : kNames)
    text += name + " = " + std::to_string(kTruth.at(name) * (off ? kOff.at(name) : 1.0)) + "\n";
  return text;
}

// Runs the identification of a record with this noise.
std::map<std::string, std::vector<double>> identify(const runs::Folder& folder, const std::string& noise) {
  const std::string heading = "[study]\nschema = 1\nkind = ";
  const std::string motion = folder.write("motion.toml", heading + "\"transient\"\n" + parameters(false) +
                                                             kSystem + "[transient]\nduration = 4\n");
  std::vector<std::string> measure{"export", motion, "--data", folder / "motion.csv", "--rate", "400 Hz"};
  if (!noise.empty()) measure.insert(measure.end(), {"--noise", noise});
  const runs::Outcome measured = runs::frahm(measure);
  INFO(measured.err);
  REQUIRE(measured.code == 0);
  std::string text = heading + "\"identify\"\n" + parameters(true) + kSystem +
                     "[identify]\nmethod = \"grey_box\"\n[[identify.record]]\nfile = \"motion.csv\"\n";
  for (const std::string& name : kNames)
    text += "[[identify.parameter]]\nparameter = \"" + name + "\"\nlower = 0\n";
  const runs::Outcome found =
      runs::frahm({"run", folder.write("model.toml", text), "-o", folder / "model.h5"});
  INFO(found.out << found.err);
  REQUIRE(found.code == 0);
  std::map<std::string, std::vector<double>> columns;
  const frahm::results::MapReader reader(folder / "model.h5");
  for (const auto& column : reader.columns("identification")) columns[column.variable.name] = column.values;
  return columns;
}

TEST_CASE("Clearance, buffers, static and kinetic friction are found in their own motion without noise") {
  constexpr double kFound = 1e-8;  // relative
  const runs::Folder folder;
  const auto found = identify(folder, "");
  for (const auto& [name, value] : kTruth) {
    INFO(name << " off by " << found.at(name)[0] / value - 1.0);
    CHECK(std::abs(found.at(name)[0] / value - 1.0) < kFound);
  }
}

TEST_CASE("With noise they are found within four standard errors, which are small") {
  const runs::Folder folder;
  const auto found = identify(folder, "0.02 mm");
  for (const auto& [name, value] : kTruth) {
    const double error = found.at(name + "_standard_error")[0];
    INFO(name << " off by " << (found.at(name)[0] - value) / error << " standard errors of " << error);
    CHECK(std::abs(found.at(name)[0] - value) < 4.0 * error);
    CHECK(error < 0.1 * value);
  }
}

}  // namespace
}  // namespace identify_stops_test
