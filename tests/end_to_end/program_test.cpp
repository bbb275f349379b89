// Exit codes, messages and what is left behind.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/end_to_end/small_runs.hpp"
#include "tests/study_path.hpp"

namespace program_test {
namespace {

using runs::Folder, runs::frahm, runs::Names, runs::provenance, runs::run, runs::small, runs::text_of;
using small_studies::axis, small_studies::oscillator;

TEST_CASE("check tells what the histories of listed orbits take") {
  // 512 instants of time, two states and an acceleration, three forces, slip and its rate: 9 numbers, 3
  // times.
  CHECK_THAT(frahm({"check", study_path("regime_map")}).out,
             Catch::Contains("orbits  the histories of 3, about a second more, 111 kB before compression"));
}

TEST_CASE("check tells the size of the file that a run then makes") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), result = folder / "small.h5";
  const std::string told = frahm({"check", study}).out, before = "\nfile    about ";
  const std::size_t at = told.find(before);
  REQUIRE(at != std::string::npos);
  CHECK(told.substr(told.find(' ', at + before.size()), 4) == " kB ");
  const double kilobytes = std::stod(told.substr(at + before.size()));
  REQUIRE(run(study, result).code == 0);
  const double made = 1e-3 * static_cast<double>(std::filesystem::file_size(result));
  CHECK(kilobytes > 0.5 * made);
  CHECK(kilobytes < 2.0 * made);
}

TEST_CASE("a rerun that is refused names what has changed") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), result = folder / "small.h5";
  CHECK(run(study, result).code == 0);
  const auto err_of = [&](const std::string& passage, const std::string& by) {
    folder.write("small.toml", runs::replaced(small, passage, by));
    const auto outcome = run(study, result);
    CHECK(outcome.code == 5);
    return outcome.err;
  };
  CHECK_THAT(err_of("mass = 1", "mass = 2"), Catch::Contains("mass \"main\": mass: 1, now 2"));
  CHECK_THAT(err_of("zeta = 0.05", "zeta = 0.06"), Catch::Contains("parameter zeta: 0.05, now 0.06"));
}

TEST_CASE("a study error is told with its place and leaves no file") {
  const Folder folder;
  const std::string study = folder.write("wrong.toml", small + "[output]\nquantities = [\"main_peek\"]\n");
  const auto outcome = run(study, folder / "wrong.h5");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.err, Catch::Contains("wrong.toml:") && Catch::Contains("did you mean \"main_peak\""));
  CHECK(folder.names() == Names{"wrong.toml"});
}

TEST_CASE("a result that was cut off is called damaged, and --fresh computes it again") {
  const Folder folder;
  const std::string map = folder.write("small.toml", small), output = folder / "small.h5";
  const std::string decay =
      folder.write("decay.toml", text_of(study_path("lecture_free_vibration_friction")));
  for (const std::string& study : {map, decay}) {
    REQUIRE(run(study, output, {"--fresh"}).code == 0);
    const std::string whole = text_of(output);
    folder.write("small.h5", whole.substr(0, whole.size() / 2));
    const auto refused = run(study, output);
    CHECK(refused.code == 6);
    CHECK_THAT(refused.err, Catch::Contains("small.h5: is a result that is damaged or has a later version") &&
                                Catch::Contains("--fresh computes it again"));
    CHECK(run(study, output, {"--fresh"}).code == 0);
    CHECK(text_of(output).size() > whole.size() / 2);
    CHECK(frahm({"status", output}).code == 0);
  }
}

TEST_CASE("a map none of whose points has a system is refused, some of them are told by check") {
  const Folder folder;
  const std::string with_mass = runs::replaced(small, "mass = 1", "mass = \"M\"");
  const auto study_of = [&](const std::string& value, const std::string& more) {
    return folder.write(
        "small.toml",
        runs::replaced(with_mass, "[parameters]\n", "[parameters]\nM = " + value + "\n") + more);
  };
  std::string study = study_of("0", "");
  for (const char* command : {"check", "run"}) {
    const auto outcome = frahm({command, study});
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err,
               Catch::Contains("no point of the map can be computed, the first, f=0,r=0.2: the mass matrix"));
  }
  study = study_of("1", small_studies::axis_of("M", "[0, 1, 2]"));
  const auto some = frahm({"check", study});
  CHECK(some.code == 0);
  CHECK_THAT(some.out, Catch::Contains("the first at f=0,r=0.2,M=0: the mass matrix"));
  CHECK(folder.names() == Names{"small.toml"});
}

TEST_CASE("logs are told of and merged in a folder that was moved with its study and the table it reads") {
  const Folder first, moved;
  first.write("zeta.csv", "0,0.1\n1,0.2\n");
  const std::string study = first.write(
      "map.toml", runs::replaced(small, "zeta = 0.05", "zeta = { table = \"zeta.csv\", of = \"f\" }"));
  REQUIRE(run(study, first / "whole.h5").code == 0);
  for (const std::string shard : {"0/2", "1/2"})
    REQUIRE(run(study, first / "map.h5", {"--shard", shard}).code == 0);
  for (const std::string& name : first.names()) std::filesystem::rename(first / name, moved / name);
  const std::string output = moved / "map.h5";
  CHECK_THAT(frahm({"status", output}).out, Catch::Contains("155 of 155 done"));

  moved.write("zeta.csv", "0,0.1\n1,0.3\n");
  const auto another = frahm({"merge", output});
  CHECK(another.code == 6);
  CHECK_THAT(another.err, Catch::Contains("no longer matches the logs"));
  std::filesystem::remove(moved / "zeta.csv");
  const auto without = frahm({"merge", output});
  CHECK(without.code == 2);
  CHECK_THAT(without.err, Catch::Contains(first / "zeta.csv"));
  moved.write("zeta.csv", "0,0.1\n1,0.2\n");
  CHECK(frahm({"merge", output}).code == 0);
  CHECK(runs::read_map(output)["main_peak"] == runs::read_map(moved / "whole.h5")["main_peak"]);
}

TEST_CASE(
    "failed points end with code 3, are listed in the file, and come with the command that repeats them") {
  const Folder folder;
  const std::string study = folder.write(
      "soft.toml", oscillator("\"k\"") + small_studies::axis_of("k", "[-1, 1]") + axis("r", 0.5, 1, 3));
  const auto outcome = run(study, folder / "soft.h5");
  CHECK(outcome.code == 3);
  CHECK_THAT(outcome.err, Catch::Contains("3 points failed") && Catch::Contains("not positive definite") &&
                              Catch::Contains("frahm point " + study + " --at \"k=-1,r=0.5\""));
  CHECK_THAT(provenance(folder / "soft.h5", "failed_points"), Catch::StartsWith("k=-1,r=0.5: "));
  CHECK(run(study, folder / "soft.h5").code == 3);
  CHECK(frahm({"point", study, "--at", "k=-1,r=0.5"}).code == 3);
}

TEST_CASE("a time budget too short stops the run with code 4, and the next run ends it") {
  const Folder folder;
  const std::string study =
      folder.write("small.toml", oscillator() + axis("f", 0, 1, 1000) + axis("r", 0.2, 2, 401) +
                                     "[output]\npath = \"general\"\n");  // more than a second
  const auto first = run(study, folder / "small.h5", {"--time-budget", "0.2s"});
  CHECK(first.code == 4);
  CHECK_THAT(first.err, Catch::Contains("% is done"));
  CHECK_FALSE(std::filesystem::exists(folder / "small.h5"));
  CHECK(run(study, folder / "small.h5").code == 0);
  CHECK(folder.names() == Names{"small.h5", "small.toml"});
}

TEST_CASE("the map as CSV has a row a point, coordinates first") {
  const Folder folder;
  const std::string study =
      folder.write("small.toml", oscillator() + axis("f", 0, 1, 2) + axis("r", 0.5, 1, 3) +
                                     "[output]\nquantities = [\"main_peak\", \"status\"]\n");
  REQUIRE(run(study, folder / "small.h5").code == 0);
  const auto csv = frahm({"export", folder / "small.h5", "-o", "-"});
  CHECK(csv.code == 0);
  CHECK_THAT(csv.out, Catch::StartsWith("f,r,main_peak,status\n0,0.5,1.3"));
  CHECK(std::count(csv.out.begin(), csv.out.end(), '\n') == 7);
  CHECK(frahm({"export", folder / "small.h5"}).code == 0);
  std::ifstream file(folder / "small.csv");
  CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == csv.out);
  CHECK(frahm({"export", folder / "none.h5"}).code == 6);
}

TEST_CASE("the orbits that a study lists are kept sample by sample") {
  const Folder folder;
  const std::string study =
      folder.write("small.toml", small + "[output]\norbits = [{ r = 0.5, f = 0.2 }, { r = 1.5 }]\n");
  REQUIRE(run(study, folder / "small.h5").code == 0);
  const auto columns = ::frahm::results::MapReader(folder / "small.h5").columns("orbits");
  const auto values = [&](const std::string& name) {
    for (const auto& column : columns) {
      if (column.variable.name == name) return column.values;
    }
    return std::vector<double>{};
  };
  CHECK(values("r") == std::vector<double>{0.5, 1.5});
  CHECK(values("row_start") == std::vector<double>{0, 512});
  const auto x = values("main_displacement");
  REQUIRE(x.size() == 1024);
  CHECK_THAT(x[511], Catch::WithinAbs(x[0], 1e-12));
  CHECK(values("time").size() == 1024);
}

TEST_CASE("single precision halves the reals and leaves the counts") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small + "[output]\nprecision = \"single\"\n");
  REQUIRE(run(study, folder / "small.h5").code == 0);
  for (const auto& variable : runs::read_map(folder / "small.h5").layout.variables) {
    if (variable.name == "main_peak") CHECK(variable.type == ::frahm::results::Type::float32);
    if (variable.name == "friction_stops") CHECK(variable.type == ::frahm::results::Type::int32);
  }
}

TEST_CASE("status tells of a finished file what it holds, and of no file that there is none") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small);
  REQUIRE(run(study, folder / "small.h5").code == 0);
  CHECK_THAT(frahm({"status", folder / "small.h5"}).out,
             Catch::Contains("finished") && Catch::Contains("155") && Catch::Contains("fingerprint_physics"));
  CHECK(frahm({"status", folder / "none.h5"}).code == 6);
}

}  // namespace
}  // namespace program_test
