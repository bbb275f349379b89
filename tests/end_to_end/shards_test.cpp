// Shards of one output, and making its file of their logs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/file.hpp"
#include "engine/log_format.hpp"
#include "engine/tile_index.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/studies/small_studies.hpp"

namespace shards_test {
namespace {

using runs::Folder, runs::frahm;
using small_studies::axis, small_studies::oscillator;
using Names = std::vector<std::string>;

const std::string of_many_tiles = oscillator() + axis("f", 0, 1, 30) + axis("r", 0.2, 2, 101);

runs::Outcome run(const std::string& study, const std::string& output, const Names& more = {}) {
  Names arguments{"run", study, "-o", output, "--threads", "1", "--progress", "none"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return frahm(arguments);
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("shards are kept apart, merged when all are there, and give what one run gives") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles);
  CHECK(run(study, folder / "one.h5").code == 0);
  const std::string parts = folder / "parts.h5";
  CHECK(run(study, parts, {"--shard", "0/3"}).code == 0);
  CHECK(run(study, parts, {"--shard", "2/3"}).code == 0);
  CHECK_FALSE(std::filesystem::exists(parts));
  const auto status = frahm({"status", parts});
  CHECK_THAT(status.out, Catch::Contains("unfinished") && Catch::Contains("of 3030 done") &&
                             Catch::Contains("at work                nobody\n") &&
                             Catch::Contains("missing tasks          1 of 3: --array=1\n"));

  const auto early = frahm({"merge", parts});
  CHECK(early.code == 6);
  CHECK_THAT(early.err, Catch::Contains("tiles are in no shard log yet") && Catch::Contains("--array=1"));
  CHECK(frahm({"merge", parts, "--partial"}).code == 0);
  CHECK(runs::read_map(parts)["status"] != runs::read_map(folder / "one.h5")["status"]);

  std::filesystem::remove(parts);
  CHECK(run(study, parts, {"--shard", "1/3"}).code == 0);
  folder.write("parts.h5", "my thesis");
  CHECK_THAT(frahm({"merge", parts}).err, Catch::Contains("is not a result of frahm"));
  CHECK(text_of(parts) == "my thesis");
  std::filesystem::remove(parts);
  CHECK(frahm({"merge", parts}).code == 0);
  const runs::Map one = runs::read_map(folder / "one.h5"), merged = runs::read_map(parts);
  CHECK(one["main_peak"] == merged["main_peak"]);
  CHECK(one["status"] == merged["status"]);
  CHECK(folder.names() == Names{"one.h5", "parts.h5", "small.toml"});
}

TEST_CASE("a second merge says that all is done, and removes what a killed one has left") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles);
  const std::string parts = folder / "parts.h5";
  const std::string left = parts + ".shard-1-of-2.frahm-log", kept = folder / "kept";
  CHECK(run(study, parts, {"--shard", "0/2"}).code == 0);
  CHECK(run(study, parts, {"--shard", "1/2"}).code == 0);
  std::filesystem::copy_file(left, kept);
  CHECK(frahm({"merge", parts}).code == 0);
  const std::string bytes = text_of(parts);
  const auto again = frahm({"merge", parts});
  CHECK(again.code == 0);
  CHECK_THAT(again.out, Catch::Contains("parts.h5 is finished already; nothing is left to merge"));
  CHECK(frahm({"merge", parts, left}).code == 0);  // named, as the first time
  std::filesystem::copy_file(kept, left);
  CHECK(frahm({"merge", parts}).code == 0);
  CHECK(text_of(parts) == bytes);
  CHECK(folder.names() == Names{"kept", "parts.h5", "small.toml"});
  CHECK(frahm({"merge", folder / "none.h5"}).code == 6);
}

TEST_CASE("merge does not replace the result of another study") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles), result = folder / "small.h5";
  CHECK(run(study, result).code == 0);
  const std::string bytes = text_of(result);
  const std::string others = folder / "others.h5";
  for (const std::string shard : {"0/2", "1/2"})
    CHECK(run(study, others, {"--shard", shard, "--set", "zeta=0.2"}).code == 0);
  const std::vector<std::filesystem::path> logs = ::frahm::engine::find_logs(others);
  REQUIRE(logs.size() == 2);
  for (const bool partial : {false, true}) {
    Names arguments{"merge", result, logs[0].string(), logs[1].string()};
    if (partial) arguments.emplace_back("--partial");
    const auto outcome = frahm(arguments);
    CHECK(outcome.code == 5);
    CHECK_THAT(outcome.err,
               Catch::Contains("another system") && Catch::Contains("name another file to make"));
    CHECK(text_of(result) == bytes);
  }
  CHECK(frahm({"merge", others}).code == 0);  // nothing of it was lost
}

TEST_CASE("a log of another study among those merged is named, with what to do") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles), a = folder / "a.h5",
                    b = folder / "b.h5";
  CHECK(run(study, a, {"--shard", "0/2"}).code == 0);
  CHECK(run(study, b, {"--shard", "1/2", "--set", "zeta=0.2"}).code == 0);
  const std::string foreign = ::frahm::engine::find_logs(b).front().string();
  const auto outcome = frahm({"merge", a, ::frahm::engine::find_logs(a).front().string(), foreign});
  CHECK(outcome.code == 5);
  CHECK_THAT(outcome.err, Catch::Contains("leave " + foreign + " out, or remove it"));
}

TEST_CASE("shards made afresh are refused where a file stands that they would not replace") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles), result = folder / "small.h5";
  CHECK(run(study, result).code == 0);
  const auto outcome = run(study, result, {"--shard", "0/2", "--fresh"});
  CHECK(outcome.code == 6);
  CHECK_THAT(outcome.err, Catch::Contains("small.h5") && Catch::Contains("remove it first"));
  std::filesystem::remove(result);
  CHECK(run(study, result, {"--shard", "0/2", "--fresh"}).code == 0);
}

TEST_CASE("a file made beside a shard still at work is made, and the shard's log is left and told of") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles), result = folder / "small.h5";
  CHECK(run(study, result, {"--shard", "0/2"}).code == 0);
  const auto log = ::frahm::engine::find_logs(result).front();
  {
    const auto held = ::frahm::engine::open_locked(log, ::frahm::engine::owner_offset);
    const auto outcome = run(study, result);
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.err,
               Catch::Contains("one log remains: " + log.string()) && Catch::Contains("in use by"));
    CHECK(std::filesystem::exists(log));
  }
  CHECK(run(study, result).code == 0);  // everything is computed already
  CHECK(folder.names() == Names{"small.h5", "small.toml"});
}

TEST_CASE("a refused run leaves the note of the study that its logs belong to") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles), result = folder / "small.h5";
  CHECK(run(study, result, {"--shard", "0/2"}).code == 0);
  const Names before = folder.names();
  const std::string others = folder / "others.h5";
  CHECK(run(study, others, {"--shard", "1/2", "--set", "zeta=0.2"}).code == 0);
  const std::string foreign = result + ".shard-1-of-2.frahm-log";
  std::filesystem::rename(::frahm::engine::find_logs(others).front(), foreign);
  CHECK(run(study, result).code == 5);
  std::filesystem::remove(foreign);
  for (const std::string& name : before) CHECK(std::filesystem::exists(folder / name));
  CHECK(run(study, result, {"--shard", "1/2"}).code == 0);
  CHECK(frahm({"merge", result}).code == 0);
}

TEST_CASE("status tells the tasks of every number of shards, and tiles where the study's note is gone") {
  const Folder folder;
  const std::string study = folder.write("small.toml", of_many_tiles);
  const std::string parts = folder / "parts.h5";
  CHECK(run(study, parts, {"--shard", "0/2"}).code == 0);
  CHECK(run(study, parts, {"--shard", "1/4"}).code == 0);
  const auto two = frahm({"status", parts});
  CHECK_THAT(two.out, Catch::Contains("missing tasks          1 of 2: --array=1\n") &&
                          Catch::Contains("missing tasks          1 of 4: --array=3\n") &&
                          Catch::Contains("each of these arrays alone completes the rest"));
  for (const std::string& name : folder.names()) {
    if (name.ends_with(".frahm-study")) std::filesystem::remove(folder / name);
  }
  const auto without = frahm({"status", parts});
  CHECK(without.code == 0);
  CHECK_THAT(without.out, Catch::Contains("points                 unknown: ") && Catch::Contains("tiles ") &&
                              Catch::Contains("--array=3"));
  folder.write("parts.h5.shard-2-of-4.frahm-log", std::string(300, 'x'));
  const auto damaged = frahm({"status", parts});
  CHECK(damaged.code == 6);
  CHECK_THAT(damaged.out, Catch::Contains("--array=3") && Catch::Contains("unreadable log") &&
                              Catch::Contains("not a shard log"));
}

TEST_CASE("the state of a log that ends in its header is a state, on standard output") {
  const Folder folder;
  folder.write("cut.h5.shard-0-of-1.frahm-log", std::string("FRAHMLOG"));
  const auto cut = frahm({"status", folder / "cut.h5"});
  CHECK(cut.code == 0);
  CHECK(cut.err.empty());
  CHECK_THAT(cut.out, Catch::Contains("empty log") && Catch::Contains("it ends in its header"));
}

}  // namespace
}  // namespace shards_test
