#include "studies/program/option_values.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "studies/reading/text/study_source.hpp"

namespace option_values_test {
namespace {

using namespace frahm::studies;

using Environment = std::map<std::string, std::string>;

frahm::engine::Shard shard_in(const Environment& environment) {
  return shard_of_array_task([&](const char* name) -> const char* {
    const auto found = environment.find(name);
    return found == environment.end() ? nullptr : found->second.c_str();
  });
}

TEST_CASE("a shard is given as i/n, counted from 0") {
  CHECK(shard_of("3/16").index == 3);
  CHECK(shard_of("3/16").count == 16);
  for (const char* wrong : {"", "3", "16/16", "-1/4", "1/", "/4", "1/4x", "a/b", "0/0"}) {
    INFO(wrong);
    CHECK_THROWS_AS(shard_of(wrong), StudyError);
  }
}

TEST_CASE("an array task of Slurm takes its own share") {
  CHECK(shard_in({}).count == 1);
  const Environment task{{"SLURM_ARRAY_TASK_ID", "7"},
                         {"SLURM_ARRAY_TASK_COUNT", "4"},
                         {"SLURM_ARRAY_TASK_MIN", "1"},
                         {"SLURM_ARRAY_TASK_STEP", "2"}};
  CHECK(shard_in(task).index == 3);
  CHECK(shard_in(task).count == 4);
}

// As Slurm 22.05 sets it for each task of `--array=...`.
Environment array_of(const std::string& id, const std::string& count, const std::string& first,
                     const std::string& last, const std::string& step) {
  return {{"SLURM_ARRAY_TASK_ID", id},
          {"SLURM_ARRAY_TASK_COUNT", count},
          {"SLURM_ARRAY_TASK_MIN", first},
          {"SLURM_ARRAY_TASK_MAX", last},
          {"SLURM_ARRAY_TASK_STEP", step}};
}

TEST_CASE("evenly spaced array tasks are numbered from 0 on") {
  CHECK(shard_in(array_of("9", "3", "1", "9", "4")).index == 2);  // --array=1-9:4
  CHECK(shard_in(array_of("9", "3", "1", "9", "4")).count == 3);
  CHECK(shard_in(array_of("5", "4", "2", "5", "1")).index == 3);  // --array=2-5%2
  CHECK(shard_in(array_of("7", "1", "7", "7", "1")).count == 1);  // --array=7
}

TEST_CASE("array tasks that are not evenly spaced are refused in every task") {
  for (const char* id : {"1", "3"}) {
    CHECK_THROWS_WITH(shard_in(array_of(id, "2", "1", "3", "1")), Catch::Contains("--shard"));
  }
  for (const char* id : {"1", "3", "4"}) {
    CHECK_THROWS_WITH(shard_in(array_of(id, "3", "1", "4", "1")), Catch::Contains("--shard"));
  }
  for (const char* id : {"0", "2", "8", "10"}) {  // --array=0-8:4,2,10
    CHECK_THROWS_WITH(shard_in(array_of(id, "5", "0", "10", "4")), Catch::Contains("--shard"));
  }
  CHECK_THROWS_AS(shard_in(array_of("0", "0", "0", "0", "1")), StudyError);
}

TEST_CASE("array tasks that are no shares of one work are refused") {
  const Environment gap{
      {"SLURM_ARRAY_TASK_ID", "9"}, {"SLURM_ARRAY_TASK_COUNT", "2"}, {"SLURM_ARRAY_TASK_MIN", "0"}};
  CHECK_THROWS_WITH(shard_in(gap), Catch::Contains("array task 9") && Catch::Contains("--shard"));
  CHECK_THROWS_AS(shard_in({{"SLURM_ARRAY_TASK_ID", "x"}}), StudyError);
}

TEST_CASE("a time budget has a unit") {
  CHECK(time_span_of("--time-budget", "90s").count() == 90.0);
  CHECK(time_span_of("--time-budget", "50m").count() == 3000.0);
  CHECK(time_span_of("--time-budget", "1.5h").count() == 5400.0);
  CHECK(time_span_of("--time-budget", "2d").count() == 172800.0);
  for (const char* wrong : {"", "50", "m", "-1s", "0s", "5 m", "1e400s", "infs", "nans"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(time_span_of("--time-budget", wrong), Catch::Contains("--time-budget"));
  }
}

TEST_CASE("a value that is not possible is told in our words, with the nearest word or those there are") {
  const std::vector<std::string> words{"fastest", "general"};
  CHECK(problem_of_word("general", words).empty());
  CHECK(problem_of_word("genral", words) == "\"genral\" is not possible; did you mean \"general\"?");
  CHECK(problem_of_word("x", words) == "\"x\" is not possible; known: fastest, general");
  CHECK(problem_of_whole_number("4096", 0, 4096).empty());
  for (const char* wrong : {"", "x", "4097", "-1", "1.5", "1x"})
    CHECK(problem_of_whole_number(wrong, 0, 4096) ==
          "\"" + std::string(wrong) + "\" is not a whole number from 0 to 4096");
  CHECK(problem_of_number_above_zero("0.5").empty());
  for (const char* wrong : {"", "x", "0", "-1", "nan", "inf"})
    CHECK_FALSE(problem_of_number_above_zero(wrong).empty());
}

}  // namespace
}  // namespace option_values_test
