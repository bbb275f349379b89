// What stands in the place of an output, and what is left there.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/end_to_end/small_runs.hpp"
#include "tests/study_path.hpp"

namespace places_of_outputs_test {
namespace {

using runs::Folder, runs::frahm, runs::Names, runs::provenance, runs::run, runs::small, runs::text_of;

TEST_CASE("an output that cannot be written ends with code 6 and leaves nothing") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small);
  const auto outcome = run(study, folder / "no-folder/small.h5");
  CHECK(outcome.code == 6);
  CHECK_THAT(outcome.err, Catch::Contains("no-folder"));
  CHECK(folder.names() == Names{"small.toml"});
}

TEST_CASE("a finished run is not repeated, and a file of another study is not overwritten") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), output = folder / "small.h5";
  CHECK(run(study, output).code == 0);
  const auto again = run(study, output);
  CHECK(again.code == 0);
  CHECK_THAT(again.out, Catch::Contains("computed already"));
  // What an assembly leaves that was killed when its file was in place.
  folder.write("small.h5.frahm-lock", "process 4711");
  CHECK(run(study, output).code == 0);
  CHECK(folder.names() == Names{"small.h5", "small.toml"});
  const auto other = run(study, output, {"--set", "zeta=0.1"});
  CHECK(other.code == 5);
  CHECK_THAT(other.err, Catch::Contains("another system") && Catch::Contains("--fresh"));
  CHECK(run(study, output, {"--set", "zeta=0.1", "--fresh"}).code == 0);
  CHECK(provenance(output, "overrides") == "zeta=0.1");
  CHECK(folder.names() == Names{"small.h5", "small.toml"});
}

TEST_CASE(
    "what is no result is not overwritten, --fresh or not: a foreign file, the study, a folder, a device") {
  const std::string decay = text_of(study_path("lecture_free_vibration_friction"));
  for (const std::string& text : {small, decay}) {
    const Folder folder;
    const std::string study = folder.write("small.toml", text);
    const std::string thesis = folder.write("thesis.h5", "my thesis"), empty = folder.write("empty.h5", "");
    const std::string link = folder / "link.h5";
    std::filesystem::create_symlink(study, link);
    for (const Names& more : {Names{}, Names{"--fresh"}}) {
      const auto refused = run(study, thesis, more);
      CHECK(refused.code == 6);
      CHECK_THAT(refused.err, Catch::Contains("is not a result of frahm; name another file with -o"));
      CHECK(run(study, empty, more).code == 6);
      const auto itself = run(study, link, more);
      CHECK(itself.code == 6);
      CHECK_THAT(itself.err, Catch::Contains("is the study itself"));
      CHECK(run(study, study, more).code == 6);
      CHECK_THAT(run(study, "/dev/null", more).err, Catch::Contains("is not a regular file"));
      CHECK(run(study, folder / ".", more).code == 6);
    }
    CHECK(text_of(thesis) == "my thesis");
    CHECK(text_of(study) == text);
    CHECK(std::filesystem::is_symlink(link));
    CHECK(folder.names() == Names{"empty.h5", "link.h5", "small.toml", "thesis.h5"});
  }
}

TEST_CASE("a branch replaces itself alone, any other result only when asked") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), map = folder / "small.h5";
  REQUIRE(run(study, map).code == 0);
  const std::string before = text_of(map);
  const auto branch = [&](const std::string& output, const Names& more = {}) {
    Names arguments{"branch", study, "--along", "r", "-o", output, "--progress", "none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return frahm(arguments);
  };
  const auto refused = branch(map);  // of the same study
  CHECK(refused.code == 5);
  CHECK_THAT(refused.err, Catch::Contains("same physics for other points") &&
                              Catch::Contains("\n  a sweep, now a branch\n") && Catch::Contains("--fresh"));
  CHECK(text_of(map) == before);

  const std::string output = folder / "branch.h5";
  CHECK(branch(output).code == 0);
  CHECK(branch(output).code == 0);
  for (const auto& [option, value, told] :
       {std::array{"--at", "f=0.5", "\n  begun at f = 0.2, r = 0.2, now begun at f = 0.5, r = 0.2\n"},
        std::array{"--to", "1.5", "\n  along r from 0.2 to 2, now along r from 0.2 to 1.5\n"},
        std::array{"--set", "zeta=0.1", "\n  parameter zeta: 0.05, now 0.1\n"},
        std::array{
            "--multiple", "2",
            "\n  period: that of the response found first, now period: 2 times that of the excitation\n"},
        std::array{"--steps", "100",
                   "\n  at most 2000 points each way, now at most 100 points each way\n"}}) {
    INFO(option);
    const auto other = branch(output, {option, value});
    CHECK(other.code == 5);
    CHECK_THAT(other.err, Catch::Contains(told) && !Catch::Contains("nothing in the study"));
  }
  const auto other_result = run(study, output);  // the map of the same study is another result too
  CHECK(other_result.code == 5);
  CHECK_THAT(other_result.err, Catch::Contains("\n  a branch, now a sweep\n"));
  CHECK(frahm({"run", study, "-o", folder / "new.h5", "--from", output}).code == 2);
  CHECK(branch(output, {"--at", "f=0.5", "--fresh"}).code == 0);
  CHECK(branch(output, {"--at", "f=0.5"}).code == 0);
  CHECK(branch(folder / "branch.csv", {"--fresh"}).code == 2);
  CHECK(folder.names() == Names{"branch.h5", "small.h5", "small.toml"});
}

TEST_CASE("logs of a stopped run are in the way of any other study, and discarded only when asked") {
  const Folder folder;
  const std::string map = folder.write("small.toml", small), output = folder / "small.h5";
  const std::string decay =
      folder.write("decay.toml", text_of(study_path("lecture_free_vibration_friction")));
  for (const Names& other :
       {Names{"run", decay, "-o", output, "--progress", "none"},
        Names{"branch", map, "--along", "r", "-o", output, "--progress", "none"},
        Names{"branch", map, "--along", "r", "--set", "zeta=0.1", "-o", output, "--progress", "none"}}) {
    INFO(other.front() << " " << other[1]);
    REQUIRE(run(map, output, {"--shard", "0/2"}).code == 0);
    const Names before = folder.names();
    const auto refused = frahm(other);
    CHECK(refused.code == 5);
    CHECK_THAT(refused.err, Catch::Contains("results of different studies are never mixed") &&
                                Catch::Contains("or discard this one with --fresh"));
    CHECK(folder.names() == before);
    Names asked = other;
    asked.emplace_back("--fresh");
    CHECK(frahm(asked).code == 0);
    CHECK(folder.names() == Names{"decay.toml", "small.h5", "small.toml"});
    std::filesystem::remove(output);
  }
}

TEST_CASE("a result has not the name of a study, nor a study that of a result") {
  const Folder folder;
  const std::string map = folder.write("small.toml", small);
  const std::string decay =
      folder.write("decay.toml", text_of(study_path("lecture_free_vibration_friction")));
  for (const std::string& study : {map, decay}) {
    const auto refused = run(study, folder / "q.toml");
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err,
               Catch::Contains("q.toml: has the name of a study; the name of this output must end in .h5"));
  }
  const auto refused = frahm({"new", "sweep", folder / "a.h5"});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Catch::Contains("a.h5: has the name of a result; name this study .toml"));
  CHECK(folder.names() == Names{"decay.toml", "small.toml"});
}

TEST_CASE("a folder given for a result is called one") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small);
  for (const Names& command :
       {Names{"status", folder / "."}, Names{"report", folder / ".", "-o", folder / "x.html"},
        Names{"export", folder / "."}, Names{"merge", folder / "."},
        Names{"export", folder / ".", "--sweep", folder / "x.toml"},
        Names{"export", folder / ".", "--study", folder / "x.toml"},
        Names{"export", folder / ".", "--data", folder / "x.csv"}}) {
    INFO(command.front());
    const auto outcome = frahm(command);
    CHECK(outcome.code == 6);
    CHECK_THAT(outcome.err, Catch::Contains("is a folder, not a result of frahm"));
  }
  const auto outcome = frahm({"export", study, "--sweep", folder / "x.toml"});
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.err, Catch::Contains("is a study") && Catch::Contains("frahm run " + study));
  CHECK(frahm({"status", folder / "none.toml"}).code == 6);  // no study, but nothing at all
  CHECK(folder.names() == Names{"small.toml"});
}

TEST_CASE("a folder that is not there is told by every command that writes a file") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), result = folder / "small.h5";
  REQUIRE(run(study, result).code == 0);
  const std::string nowhere = folder / "nowhere";
  for (const Names& command :
       {Names{"run", study, "-o", nowhere + "/x.h5"},
        Names{"run", study, "--shard", "0/2", "-o", nowhere + "/x.h5"}, Names{"merge", nowhere + "/x.h5"},
        Names{"export", result, "-o", nowhere + "/x.csv"}, Names{"report", result, "-o", nowhere + "/x.html"},
        Names{"new", "sweep", nowhere + "/x.toml"}, Names{"point", study, "--history", nowhere + "/x.csv"},
        Names{"branch", study, "--along", "r", "-o", nowhere + "/x.h5"},
        Names{"branch", study, "--along", "r", "-o", nowhere + "/x.csv"}}) {
    INFO(command.front());
    const auto outcome = frahm(command);
    CHECK(outcome.code == 6);
    CHECK_THAT(outcome.err, Catch::Contains("there is no folder " + nowhere));
    CHECK(outcome.out.empty());  // nothing was computed in vain
  }
  CHECK(folder.names() == Names{"small.h5", "small.toml"});
}

TEST_CASE("the texts of a group without numbers are exported, and replace no other file") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), result = folder / "small.h5";
  REQUIRE(run(study, result).code == 0);
  const auto texts = frahm({"export", result, "--group", "provenance", "-o", "-"});
  CHECK(texts.code == 0);
  CHECK_THAT(texts.out, Catch::StartsWith("name,text\n\"study\",\"[study]\n") &&
                            Catch::Contains("kind = \"\"sweep\"\"") &&
                            Catch::Contains("\n\"study_file\",\"small.toml\"\n"));
  for (const std::string& text : {std::string("my thesis\n"), std::string("\nmy thesis\n")}) {
    const std::string mine = folder.write("mine.csv", text);
    CHECK(frahm({"export", result, "--group", "provenance", "-o", mine}).code == 6);
    CHECK(text_of(mine) == text);
  }
}

TEST_CASE("a link is not replaced by an output, wherever it points") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), result = folder / "small.h5";
  REQUIRE(run(study, result).code == 0);
  const std::string before = text_of(result);
  const auto is_refused = [&](const std::string& link, const std::string& target, const Names& arguments) {
    INFO(arguments.front() << " " << link);
    std::filesystem::create_symlink(target, link);
    const auto refused = frahm(arguments);
    CHECK(refused.code == 6);
    CHECK_THAT(refused.err, Catch::Contains(link + ": is a link"));
    CHECK(std::filesystem::read_symlink(link) == target);
    std::filesystem::remove(link);
  };
  const std::string link = folder / "link.h5", table = folder / "link.csv", page = folder / "link.html";
  for (const std::string& target : {folder / "nowhere", result}) {
    is_refused(link, target, {"run", study, "-o", link, "--progress", "none"});
    is_refused(link, target, {"run", study, "-o", link, "--progress", "none", "--fresh"});
  }
  is_refused(table, folder / "nowhere", {"export", result, "-o", table});
  is_refused(page, folder / "nowhere", {"report", result, "-o", page});
  CHECK(text_of(result) == before);
  CHECK(folder.names() == Names{"small.h5", "small.toml"});
}

TEST_CASE("a run refused for a foreign log leaves nothing, and a file named as its note stays as it is") {
  const Folder folder, other;
  const std::string study = folder.write("small.toml", small), output = folder / "small.h5";
  folder.write("small.h5.mine.frahm-log",
               "a log of something else, longer than the header of a log of frahm is");
  CHECK(run(study, output).code == 6);
  CHECK(folder.names() == Names{"small.h5.mine.frahm-log", "small.toml"});

  REQUIRE(run(study, other / "small.h5", {"--shard", "0/2"}).code == 0);
  const Names there = other.names();
  const auto note =
      std::ranges::find_if(there, [](const auto& name) { return name.ends_with(".frahm-study"); });
  REQUIRE(note != there.end());
  std::filesystem::remove(folder / "small.h5.mine.frahm-log");
  folder.write(*note, "my thesis");
  for (const Names& more : {Names{}, Names{"--fresh"}}) {
    const auto refused = run(study, output, more);
    CHECK(refused.code == 6);
    CHECK_THAT(refused.err, Catch::Contains(*note) && Catch::Contains("is not a note of frahm"));
  }
  CHECK(text_of(folder / *note) == "my thesis");
  CHECK(folder.names() == Names{*note, "small.toml"});
}

}  // namespace
}  // namespace places_of_outputs_test
