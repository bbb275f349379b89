// shaken_frame.toml: a map of motions, against single motions and what the study expects.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "tests/end_to_end/motion_file.hpp"
#include "tests/end_to_end/runs.hpp"

namespace shaken_frame_test {
namespace {

// The study with few points and all digits.
std::string small_map() {
  return runs::replaced(runs::reduced("shaken_frame", {{"F", 5}, {"omega", 3}}), "[output]\n",
                        "[output]\nprecision = \"full\"\n");
}

// Its motion alone: without axes and what is recorded along them.
std::string one_motion() {
  const std::string text = small_map();
  const std::size_t axes = text.find("[[axis]]"), signal = text.find("[[output.signal]]"),
                    report = text.find("[report]");
  return text.substr(0, axes) + text.substr(signal, report - signal);
}

TEST_CASE("shaken_frame.toml: every point is its single motion run with --set, to the last digit") {
  const runs::Map map = runs::run_study(small_map());
  const runs::Folder folder;
  const std::string study = folder.write("one.toml", one_motion());
  const auto& F = map.coordinate("F");
  const auto& omega = map.coordinate("omega");
  for (const std::size_t i : {0, 2, 4}) {
    for (const std::size_t j : {0, 1}) {
      const std::string at = std::to_string(F[i]) + " kN", rate = std::to_string(omega[j]) + " rad/s";
      INFO("F = " << at << ", omega = " << rate);
      const runs::MotionFile one(study, "transient", {"--set", "F=" + at, "--set", "omega=" + rate});
      const std::size_t place = 3 * i + j;
      for (const std::string name : {"floor1_peak", "floor10_peak", "brace5_energy_share", "energy_balance"})
        CHECK(map[name][place] == one[name][0]);
      CHECK(map["status"][place] == 1.0);
      // A slip for each release that the single motion tells.
      const auto& releases = one["brace5_release"];
      const auto slips = std::ranges::count_if(releases, [](double t) { return t > 0.0; });
      CHECK(map["brace5_slips"][place] == static_cast<double>(slips));
      CHECK(std::abs(map["floor10_residual"][place] - one["floor10_displacement"].back()) <=
            1e-12 * map["floor10_peak"][place]);
    }
  }
}

TEST_CASE(
    "shaken_frame.toml: at resonance one slip force is best, and the highest damper sticks where it is "
    "strong") {
  const runs::Map map = runs::run_study(runs::reduced("shaken_frame", {{"omega", 3}}));
  const std::size_t forces = map.coordinate("F").size();
  std::vector<double> roof;
  for (std::size_t i = 0; i < forces; ++i) roof.push_back(map["floor10_peak"][3 * i + 1]);
  const auto best = std::ranges::min_element(roof);
  CHECK(best != roof.begin());
  CHECK(best != roof.end() - 1);
  CHECK(*best < 0.8 * roof.front());
  CHECK(map["brace7_slips"][3 * (forces - 1)] == 0.0);
}

TEST_CASE("shaken_frame.toml: a history is that of the single motion, and status and check tell of motions") {
  const runs::Folder folder;
  const std::string study = folder.write("map.toml", small_map());
  const runs::Outcome run = runs::frahm({"run", study, "-o", folder / "map.h5", "--progress", "none"});
  REQUIRE(run.code == 0);
  CHECK_THAT(run.out, Catch::Contains("15 motions"));
  const frahm::results::MapReader file(folder / "map.h5");
  CHECK(file.has_group("histories"));
  const runs::Outcome check = runs::frahm({"check", study});
  CHECK(check.code == 0);
  CHECK_THAT(check.out, Catch::Contains("motions/s"));
  CHECK(runs::frahm({"status", folder / "map.h5"}).code == 0);
}

TEST_CASE("shaken_frame.toml: a point is told as its motion is, with its history") {
  const runs::Folder folder;
  const std::string study = folder.write("map.toml", small_map());
  const std::string history = folder / "history.csv";
  const runs::Outcome point =
      runs::frahm({"point", study, "--at", "F=160 kN,omega=6.5 rad/s", "--history", history});
  REQUIRE(point.code == 0);
  CHECK_THAT(point.out, Catch::Contains("floor10") && Catch::Contains("the energies balance"));
  CHECK(std::filesystem::file_size(history) > 100'000);
  CHECK(runs::frahm({"point", study, "--at", "F=160 kN", "--json"}).code != 0);
}

}  // namespace
}  // namespace shaken_frame_test
