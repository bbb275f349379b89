// rig_decay_*.toml and lecture_free_vibration*.toml: whole runs against the closed-form recursion.
#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "tests/end_to_end/motion_file.hpp"
#include "tests/known_answers/free_oscillator.hpp"
#include "tests/study_path.hpp"

namespace decay_test {
namespace {

using frahm::transient::FreeOscillator;
constexpr double kExact = 1e-12;  // of times, and of displacements relative to the first

void check_against_recursion(const std::string& study, const std::string& node,
                             const FreeOscillator& oscillator, double x_0, std::size_t turning_points) {
  const runs::MotionFile file(study_path(study), "decay");
  INFO(study);
  const auto expected = oscillator.turning_points(x_0, 100000);
  CHECK(expected.size() == turning_points + 1);
  const auto& extrema = file[node + "_extremum"];
  const auto& times = file[node + "_extremum_time"];
  REQUIRE(extrema.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK_THAT(extrema[i], Catch::WithinAbs(expected[i], kExact * std::abs(x_0)));
    CHECK_THAT(times[i], Catch::WithinAbs(static_cast<double>(i) * oscillator.half_period(), kExact * 20.0));
  }
  const double stop = static_cast<double>(turning_points) * oscillator.half_period();
  CHECK_THAT(file["stop_time"][0], Catch::WithinRel(stop, kExact));
  CHECK_THAT(file[node + "_rest"][0], Catch::WithinAbs(expected.back(), kExact * std::abs(x_0)));
  CHECK(file["time"].back() == file["duration"][0]);
  CHECK_THAT(file[node + "_displacement"].back(), Catch::WithinAbs(expected.back(), kExact * std::abs(x_0)));
}

FreeOscillator oscillator_of(double m, double k, double c, double F) {
  return {.m = m, .k = k, .zeta = c / (2.0 * std::sqrt(k * m)), .x_f = F / k};
}

TEST_CASE("rig_decay_main.toml: 81 turning points, at rest after 10.774 s") {
  check_against_recursion("rig_decay_main", "main", oscillator_of(102.66, 7.0 * 8181.0, 1.7688, 10.1270),
                          0.03, 81);
}

TEST_CASE("rig_decay_tmd.toml: 11 turning points, at rest after 1.1806 s") {
  check_against_recursion("rig_decay_tmd", "tmd", oscillator_of(12.82, 10985.1, 0.0095, 15.0109), 0.03, 11);
}

TEST_CASE("rig_decay_inerter_low.toml and _high.toml: 7 turning points each, with m + I") {
  check_against_recursion("rig_decay_inerter_low", "tmd",
                          oscillator_of(12.82 + 4.72, 10985.1, 28.7792, 15.0109), 0.03, 7);
  check_against_recursion("rig_decay_inerter_high", "tmd",
                          oscillator_of(12.82 + 12.9, 10985.1, 32.7203, 15.0109), 0.03, 7);
}

TEST_CASE("lecture_free_vibration_friction.toml: each cycle loses 4 F/k and the mass stops off centre") {
  check_against_recursion("lecture_free_vibration_friction", "mass", oscillator_of(2.0, 800.0, 0.0, 2.0),
                          0.052, 10);
  const runs::MotionFile file(study_path("lecture_free_vibration_friction"), "decay");
  CHECK_THAT(file["mass_rest"][0], Catch::WithinAbs(0.002, kExact));
  CHECK_THAT(file["mass_extremum"][0] - file["mass_extremum"][2], Catch::WithinAbs(0.010, kExact));
}

TEST_CASE(
    "lecture_free_vibration.toml: the logarithmic decrement, and no overshoot from critical damping on") {
  const std::string study = study_path("lecture_free_vibration");
  const runs::MotionFile under(study, "decay");
  const double expected = 2.0 * std::numbers::pi * 0.1 / std::sqrt(1.0 - 0.01);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK_THAT(under["mass_log_decrement"][i], Catch::WithinAbs(expected, 1e-11));
  }
  CHECK(std::isnan(under["stop_time"][0]));
  for (const char* zeta : {"zeta=1", "zeta=2"}) {
    const runs::MotionFile over(study, "decay", {"--set", zeta});
    const auto& x = over["mass_displacement"];
    CHECK(over["mass_extremum"].size() == 1);
    CHECK(*std::min_element(x.begin(), x.end()) > 0.0);
  }
}

std::string one_mass(const std::string& more) {
  return "[study]\nschema = 1\nkind = \"decay\"\n[parameters]\nc = 0.4\n[[mass]]\nname = \"a\"\nmass = 1\n"
         "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"a\"]\nstiffness = 4\n"
         "[[element]]\nname = \"damper\"\ntype = \"damper\"\nbetween = [\"ground\", \"a\"]\ndamping = \"c\"\n"
         "[[initial]]\nnode = \"a\"\ndisplacement = 0.1\n" +
         more;
}

TEST_CASE("The table of a decay says how it ends: what is left, cut off, at rest from the start") {
  const runs::Folder folder;
  const std::string file = folder / "decay.h5";
  const std::string cut = folder.write("cut.toml", one_mass("[decay]\nduration = 0.5\n"));
  const auto out = [&](const std::string& study, const std::string& set) {
    const runs::Outcome outcome = runs::frahm({"run", study, "-o", file, "--fresh", "--set", set});
    INFO(outcome.err);
    CHECK(outcome.code == 0);
    return outcome.out;
  };
  const std::string short_one = out(cut, "c=0.4");
  CHECK_THAT(short_one, Catch::Contains("after 0.5 s") && Catch::Contains("is 0.9") &&
                            Catch::Contains("1 extremum,") && !Catch::Contains("1e-06"));
  const std::string whole = folder.write("whole.toml", one_mass(""));
  CHECK_THAT(out(whole, "c=0.4"),
             Catch::Contains("never stops; after") && Catch::Contains("e-07 of the initial one"));
  CHECK_THAT(out(whole, "c=40000"),
             Catch::Contains("still moving after") && Catch::Contains("give [decay] a duration"));
  const std::string still =
      folder.write("still.toml", runs::replaced(one_mass(""), "displacement = 0.1", "displacement = 0"));
  CHECK_THAT(out(still, "c=0.4"), Catch::Contains("at rest from the start"));
}

TEST_CASE("A time budget stops a motion with code 4 and leaves no file") {
  const runs::Folder folder;
  const std::string study = folder.write("stiff.toml", one_mass("[decay]\nduration = 100\n"));
  const runs::Outcome outcome =
      runs::frahm({"run", study, "-o", folder / "decay.h5", "--set", "c=40000", "--time-budget", "0.01s"});
  CHECK(outcome.code == 4);
  CHECK_THAT(outcome.err, Catch::Contains("time budget") && Catch::Contains("nothing is kept"));
  CHECK(folder.names() == std::vector<std::string>{"stiff.toml"});
}

TEST_CASE("SIGTERM stops a motion with code 4 and leaves no file") {
  const runs::Folder folder;
  // Some seconds of work, which the signal comes into.
  const std::string study = folder.write("stiff.toml", one_mass("[decay]\nduration = 80\n"));
  const std::string command = "timeout --preserve-status -s TERM 0.5 " FRAHM_PROGRAM " run " + study +
                              " -o " + (folder / "decay.h5") + " --set c=100000 2> " + (folder / "said");
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 4);
  CHECK(folder.names() == std::vector<std::string>{"said", "stiff.toml"});
}

TEST_CASE("A decay's file is exported, summed up, recomputed for its study and refused to another") {
  const runs::Folder folder;
  const std::string study = study_path("lecture_free_vibration_friction"), file = folder / "decay.h5";
  const runs::Outcome first = runs::frahm({"run", study, "-o", file});
  CHECK(first.code == 0);
  CHECK_THAT(first.out, Catch::Contains("comes to rest at 1.570796327 s"));
  // From 52 mm to 2 mm, 10 mm a cycle: five cycles of 800/2 (52^2 - 2^2) 1e-6 J in all.
  CHECK_THAT(first.out, Catch::Contains("lost in") && Catch::Contains("1.08  100.00 %"));
  CHECK(runs::frahm({"run", study, "-o", file}).code == 0);
  const runs::Outcome other = runs::frahm({"run", study, "-o", file, "--set", "F=3 N"});
  CHECK(other.code == 5);
  CHECK_THAT(other.err, Catch::Contains("is the result of another system") && !Catch::Contains("tiles"));
  CHECK(runs::frahm({"run", study_path("lecture_free_vibration"), "-o", file}).code == 5);
  CHECK_THAT(runs::frahm({"status", file}).out, Catch::Contains("stop_time"));
  const runs::Outcome table = runs::frahm({"export", file, "-o", "-"});
  CHECK_THAT(table.out, Catch::StartsWith("mass_extremum_time [s],") || Catch::StartsWith("time [s],"));
  CHECK(std::count(table.out.begin(), table.out.end(), '\n') == 502);
  const runs::Outcome check = runs::frahm({"check", study});
  CHECK(check.code == 0);
  CHECK_THAT(check.out, Catch::Contains("free vibration") && Catch::Contains("Undamped modes"));
  const runs::Outcome point = runs::frahm({"point", study});
  CHECK(point.code == 2);
  CHECK_THAT(point.err, Catch::Contains("no periodic response"));
  CHECK(runs::frahm({"run", study, "-o", file, "--shard", "0/2"}).code == 2);
}

}  // namespace
}  // namespace decay_test
