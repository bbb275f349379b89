#include "studies/program/check_command.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "studies/map/map_sample.hpp"
#include "studies/map/statistics_group.hpp"
#include "studies/program/memory_use.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/settings.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "studies/tuning/tuning_sample.hpp"
#include "tests/results/temporary_directory.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/studies/small_tunings.hpp"
#include "tests/study_path.hpp"

namespace check_command_test {
namespace {

using frahm::studies::check_command;
using frahm::studies::MapPlan;
using frahm::studies::MemoryUse;
using frahm::studies::plan_map;
using frahm::studies::read_study_with;
using frahm::studies::sample_map;
using frahm::studies::statistics_memory;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? -1 : std::stoi(text.substr(at + words.size()));
}

TEST_CASE("Checking the rig atlas tells its size, its array of tasks and its modes") {
  std::ostringstream out;
  CHECK(check_command({.study = study_path("rig_atlas"), .set = {"K=8000 N/m"}, .threads = 2}, out) == 0);
  const std::string text = out.str();
  INFO(text);
  CHECK(has(text, "rig_atlas.toml is a valid study: Tuned mass damper with inerter: the rig"));
  CHECK(has(text, "points  522102 = 42 I x 31 FP x 401 omega\n"));
  CHECK(has(text, "on 2 threads of this machine"));
  const int tasks = number_after(text, "As an array of ");  // fewer on a faster machine
  CHECK(has(text, fmt::format("  sbatch --array=0-{} --cpus-per-task=1 --wrap 'frahm run ", tasks - 1)));
  // Quoted twice, so that the shell that submits leaves the variable to the task.
  CHECK(has(text, fmt::format(" -o rig_atlas.h5 --set '\\''K=8000 N/m'\\'' --shard $SLURM_ARRAY_TASK_ID/{} "
                              "--threads 1'\n",
                              tasks)));
  CHECK(has(text, "frahm merge rig_atlas.h5 "));
  CHECK(has(text, "At the first point of the grid, I=4.72 kg,FP=0,omega=150 rpm:\n"));
  CHECK(has(text, "shape of main, tmd\n"));
  CHECK(has(text, "With all friction stuck nothing moves."));
}

TEST_CASE("the frequencies of a run-up are told in the study's unit, wherever it stands") {
  std::ostringstream of_parameter;
  check_command({.study = study_path("run_up"), .threads = 1}, of_parameter);
  CHECK_THAT(of_parameter.str(), Catch::Contains(" at 100 rpm, running to 1000 rpm at 100 rpm a second\n"));
  const TemporaryDirectory folder;
  std::ofstream(folder / "study.toml")
      << "[study]\nschema = 1\nkind = \"transient\"\n[[mass]]\nname = \"m\"\nmass = 1\n"
         "[[element]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\nstiffness = 4e4\n"
         "[excitation]\nfrequency = { value = 10, unit = \"Hz\" }\n"
         "[[excitation.force]]\non = \"m\"\namplitude = 1\n[transient]\nduration = 2\n";
  std::ostringstream of_value;
  check_command({.study = folder / "study.toml", .threads = 1}, of_value);
  CHECK_THAT(of_value.str(), Catch::Contains("transient  2 s at 10 Hz\n"));
}

TEST_CASE("a modal damping ratio above that of critical damping is noted, as 2 may mean 2 %") {
  const TemporaryDirectory folder;
  const auto checked = [&](const char* ratio) {
    std::ofstream(folder / "study.toml")
        << small_studies::building(2, 9, 5) << "[damping]\nmodal = " << ratio << '\n';
    std::ostringstream out;
    CHECK(check_command({.study = folder / "study.toml", .threads = 1}, out) == 0);
    return out.str();
  };
  CHECK(has(checked("2"), "note: [damping]: modal: a ratio of 2 is above 1 (critical damping)"));
  CHECK_FALSE(has(checked("0.02"), "note: [damping]"));
}

TEST_CASE("A simulation of ranks tells time, efficiency and losses of 1, 10, 100 ... ranks") {
  std::ostringstream out;
  CHECK(check_command({.study = study_path("rig_atlas"), .threads = 2, .simulate_ranks = 250}, out) == 0);
  const std::string text = out.str();
  INFO(text);
  CHECK(has(text, "On ranks of 2 threads each"));
  for (const char* row :
       {"\n      1        2 ", "\n     10       20 ", "\n    100      200 ", "\n    250      500 "})
    CHECK(has(text, row));
  CHECK(has(text, "Efficiency "));
  CHECK_THROWS_WITH(check_command({.study = study_path("tune_classical"), .simulate_ranks = 2}, out),
                    Catch::Contains("--simulate-ranks is for maps"));
  CHECK_THROWS_WITH(
      check_command({.study = study_path("rig_atlas"), .threads = 4096, .simulate_ranks = 100'000}, out),
      Catch::Contains("threads in total"));
}

TEST_CASE("A map of less than a second is predicted as that") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "small.toml";  // takes milliseconds, on a busy machine too
  std::ofstream(path) << small_studies::oscillator() << small_studies::axis("r", 0.2, 2, 100);
  std::ostringstream out;
  CHECK(check_command({.study = path, .threads = 1}, out) == 0);
  INFO(out.str());
  CHECK(has(out.str(), "\ntime    less than a second on 1 thread of this machine"));
  CHECK(has(out.str(), "\nmemory  about "));
}

TEST_CASE("The time of one motion is predicted from its steps") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "long.toml";
  const auto told = [&](const char* duration) {
    std::ofstream(path) << "[study]\nschema = 1\nkind = \"transient\"\nunits = \"dimensionless\"\n"
                           "[[mass]]\nname = \"m\"\nmass = 1\n"
                           "[[element]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\n"
                           "stiffness = 1\n[excitation]\nfrequency = 1\n"
                           "[[excitation.force]]\non = \"m\"\namplitude = 1\n[transient]\nduration = "
                        << duration;
    std::ostringstream out;
    check_command({.study = path, .threads = 1}, out);
    return out.str();
  };
  CHECK_THAT(told("100"), Catch::Contains("\ntime       less than a second\n"));
  CHECK_THAT(told("1e6"), Catch::Contains("\ntime       about "));
}

TEST_CASE("Of the first tile, if it takes seconds, at most three points are sampled, and count for it") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "dear.toml";
  std::ofstream(path) << small_studies::oscillator() << small_studies::axis("r", 0.2, 2, 4000)
                      << small_studies::axis("f", 0, 1, 4000);
  MapPlan plan = plan_map(read_study_with(path, {}), {});
  plan.grid.tile = plan.grid.chunk = plan.grid.shape;  // a minute's work
  const auto sample = sample_map(plan, 0.0);
  CHECK(sample.points <= 3);
  REQUIRE(sample.costs.size() == 1);
  CHECK(sample.costs[0].seconds > 2.0);
  CHECK(sample.stored_bytes <= sample.raw_bytes);
}

TEST_CASE("A run takes the memory of a sample once for each thread") {
  const MemoryUse use;
  const std::vector<char> sample(64'000'000, 'a');
  const volatile char* held = sample.data();  // a compiler may leave out memory that nobody reads
  CHECK(held[0] == 'a');
  const double one = use.of_run(1), three = use.of_run(3);
  const auto of_sample = 0.9 * static_cast<double>(sample.size());  // its pages, but for what lay free before
  CHECK(one > of_sample);
  CHECK(three - one > 2.0 * of_sample);
}

TEST_CASE("Statistics hold the samples of as many quantities as fit into 64 MB a thread") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "scatter.toml";
  const auto memory = [&](int samples, const std::string& quantities) {
    std::ofstream(path) << small_studies::oscillator() << "[[axis]]\nsamples = " << samples
                        << "\n[[axis.of]]\nparameter = \"k\"\ndistribution = \"normal\"\nmean = 1\n"
                           "deviation = 0.01\n[output]\nquantities = "
                        << quantities << "\n";
    return statistics_memory(plan_map(read_study_with(path, {}), {}));
  };
  constexpr double number = 8.0;             // bytes
  constexpr double of_scatter = 5 + 3 * 3;   // numbers: mean, deviation, count and the usual three quantiles
  constexpr double most = 64 * 1024 * 1024;  // bytes
  CHECK(memory(1000, "[\"main_peak\"]") == number * (1000 + of_scatter));
  CHECK(memory(1000, "[\"main_peak\", \"main_mean\"]") == number * 2 * (1000 + of_scatter));
  // Ten quantities of a million samples, of which eight fit.
  const double many =
      memory(1'000'000,
             "[\"main_peak\", \"main_mean\", \"main_rms\", \"main_amplitude\", \"spring_stroke\", "
             "\"spring_force_peak\", \"damper_stroke\", \"damper_force_peak\", \"friction_stroke\", "
             "\"friction_force_peak\"]");
  CHECK(many == number * (8 * 1e6 + 10 * of_scatter));
  CHECK(many < most);
  CHECK(memory(1000, "[\"status\"]") == 0.0);
}

TEST_CASE("A sample of a map is at least a tile and at most the map") {
  const MapPlan plan = plan_map(read_study_with(study_path("cheng_zu"), {}), {});
  const auto one = sample_map(plan, 0.0);
  CHECK(one.points == plan.grid.box(0).points());
  CHECK(one.seconds > 0.0);
  constexpr double long_enough = 600.0;
  const auto all = sample_map(plan, long_enough);
  CHECK(all.points == plan.grid.points());
  CHECK(all.stored_bytes > 0);
  CHECK(all.stored_bytes < all.raw_bytes);
  CHECK(all.failed == 0);
}

TEST_CASE("Checking a study of which nothing is computed ends like a run of failed points, and says why") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "slow.toml";
  std::ofstream(path) << small_studies::oscillator() << small_studies::axis_of("r", "[1e-8, 2e-8]");
  std::ostringstream out;
  CHECK(check_command({.study = path, .set = {}, .threads = 1}, out) == 3);
  const std::string text = out.str();
  INFO(text);
  CHECK(has(text, "slow.toml can be read, but none of the points tried has a response\n"));
  CHECK(has(text,
            "without a response: 2 of the 2 points tried, the first at r=1e-08: the excitation is too slow"));
}

// A node without mass has no inverse of its mass matrix, at any design.
TEST_CASE("Checking a tuning that finds no design says why, as a run does, and calls it not valid") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "tune.toml";
  std::ofstream(path) << small_tunings::heading << small_tunings::absorber
                      << "[[mass]]\nname = \"sensor\"\nmass = \"0*f\"\n"
                         "[[element]]\nname = \"link\"\ntype = \"damper\"\nbetween = [\"main\", \"sensor\"]\n"
                         "damping = 1e-3\n[[element]]\nname = \"weak\"\ntype = \"spring\"\n"
                         "between = [\"ground\", \"sensor\"]\nstiffness = 1e-4\n"
                         "[tune]\nobjective = \"variance\"\nquantity = \"sensor_rms\"\n"
                         "noise = { force_on = \"main\" }\n"
                      << small_tunings::of_f << small_tunings::of_zeta;
  std::ostringstream out;
  CHECK(check_command({.study = path, .threads = 1}, out) == 7);
  INFO(out.str());
  CHECK(!has(out.str(), "valid"));
  CHECK(has(out.str(),
            "tune.toml can be read, but its first start finds no design: the design has no variance: "
            "the mass matrix of the moving nodes is not positive definite"));
  CHECK(has(out.str(), "The design of the study has no modes: the mass matrix"));
}

TEST_CASE("Checking an identification refuses what a run refuses") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "decay.toml";
  std::ofstream(folder / "peaks.csv") << "extremum [mm],extremum_time [s]\n5.08,0\n4.064,1.4\n3.251,2.8\n";
  std::ofstream(path) << "[study]\nschema = 1\nkind = \"identify\"\nunits = \"SI\"\n[identify]\n"
                         "method = \"log_decrement\"\n[[identify.record]]\nfile = \"peaks.csv\"\n";
  std::ostringstream out;
  CHECK_THROWS_WITH(check_command({.study = path, .threads = 1}, out),
                    Catch::Contains("maxima and minima must come in turn"));
  CHECK(out.str().empty());
}

TEST_CASE("Checking a large building shows twelve modes at eight floors, and all of them when asked") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "building.toml";
  std::ofstream(path) << small_studies::building(15, 20, 3);
  std::ostringstream excerpt, whole;
  CHECK(check_command({.study = path, .threads = 1}, excerpt) == 0);
  CHECK(check_command({.study = path, .threads = 1, .all = true}, whole) == 0);
  INFO(excerpt.str());
  CHECK(has(excerpt.str(), "shape of floor1, floor3, floor5, floor7, floor9, floor11, floor13, floor15\n"));
  CHECK(has(excerpt.str(), "\n    12 "));
  CHECK(!has(excerpt.str(), "\n    13 "));
  CHECK(has(excerpt.str(), "\n  12 of 15 modes, at 8 of 15 masses; --all shows all\n"));
  CHECK(has(whole.str(), "shape of floor1, floor2, floor3, "));
  CHECK(has(whole.str(), "\n    15 "));
  CHECK(!has(whole.str(), "--all"));
}

TEST_CASE("Checking a tuning tells the time of its starts on these threads", "[timed]") {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "tune.toml";
  std::string text = small_tunings::classical;
  std::ofstream(path) << text.insert(text.find("[tune]\n") + 7, "start = 5\n");
  std::ostringstream out;
  CHECK(check_command({.study = path, .threads = 8}, out) == 0);
  INFO(out.str());
  CHECK(has(out.str(), "starts                5\n"));
  CHECK(has(out.str(), " on 5 threads of this machine (the first start took 0."));
}

TEST_CASE("A start of a tuning that does not end within its sample is predicted by a range of responses") {
  const auto plan = frahm::studies::plan_tuning(read_study_with(study_path("tune_rig_schedule"), {}), {});
  const auto sample = frahm::studies::sample_tuning(plan, 0.05);
  CHECK(!sample.is_whole);
  CHECK(sample.seconds < 0.5);  // stops are asked for at every response
  CHECK(sample.responses > 0);
  // `frahm run` tells that it takes 24,550 of them.
  CHECK(sample.least_responses < 24'550);
  CHECK(sample.most_responses > 24'550);
  const double each = sample.seconds / static_cast<double>(sample.responses);
  CHECK(sample.most_seconds == Approx(each * sample.most_responses));
  const auto whole = frahm::studies::sample_tuning(plan, 600.0);
  CHECK(whole.is_whole);
  CHECK(whole.least_seconds == whole.seconds);
  CHECK(whole.assessment_seconds > 0.0);
}

TEST_CASE("Points that fail in a sample are counted and the first is named") {
  MapPlan plan = plan_map(read_study_with(study_path("den_hartog"), {}), {});
  // A negative stiffness is no study; a map may meet one all the same, through a table or an expression.
  plan.study.values.elements[0][0].expression = frahm::studies::Expression(-1.0);
  const auto sample = sample_map(plan, 0.0);
  CHECK(sample.failed == sample.points);
  CHECK(has(sample.failed_at, "zeta=0,f=0"));
  CHECK(has(sample.reason, "definite"));
}

}  // namespace
}  // namespace check_command_test
