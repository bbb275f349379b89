// Exit codes, messages and what is left behind.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <sstream>

#include "results/map_reader.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/study_path.hpp"

namespace {

using runs::Folder;
using runs::frahm;
using runs::text_of;
using small_studies::axis;
using small_studies::oscillator;
using Names = std::vector<std::string>;

const std::string small = oscillator() + axis("f", 0, 1, 5) + axis("r", 0.2, 2, 31);

runs::Outcome run(const std::string& study, const std::string& output, const Names& more = {}) {
  Names arguments{"run", study, "-o", output, "--threads", "1", "--progress", "none"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return frahm(arguments);
}

std::string provenance(const std::string& path, const std::string& name) {
  for (const auto& [key, text] : ::frahm::results::MapReader(path).texts("provenance")) {
    if (key == name) return text;
  }
  return "none";
}

TEST_CASE("wrong usage ends with code 2 and says what is wrong") {
  CHECK(frahm({}).code == 2);
  CHECK(frahm({"walk"}).code == 2);
  CHECK(frahm({"run"}).code == 2);
  CHECK(frahm({"run", "no-such-study.toml"}).code == 2);
  CHECK_THAT(frahm({"run", "no-such-study.toml"}).err, Catch::Contains("no-such-study.toml"));
  const Folder folder;
  const std::string study = folder.write("small.toml", small);
  for (const Names& wrong :
       {Names{"--shard", "4/4"}, Names{"--time-budget", "50"}, Names{"--threads", "-1"}, Names{"--shard", ""},
        Names{"--time-budget", ""}, Names{"--from", ""}, Names{"--set", "q=1"}, Names{"--set", "f=0.5"},
        Names{"--progress", "loud"}, Names{"--colour"}}) {
    INFO(wrong.front());
    const auto outcome = run(study, folder / "small.h5", wrong);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_FALSE(outcome.err.empty());
  }
  CHECK(folder.names() == Names{"small.toml"});
}

// The first line of what a wrong command line is told.
std::string complaint(const Names& arguments) {
  const auto outcome = frahm(arguments);
  CHECK(outcome.code == 2);
  return outcome.err.substr(0, outcome.err.find('\n'));
}

TEST_CASE("a wrong value of an option is one line in our words, with what is possible") {
  CHECK(complaint({"run", "s.toml", "--progress", "foo"}) ==
        "frahm run: --progress: \"foo\" is not possible; known: auto, plain, json, none");
  CHECK(complaint({"point", "s.toml", "--path", "genral"}) ==
        "frahm point: --path: \"genral\" is not possible; did you mean \"general\"?");
  CHECK(complaint({"completion", "bsh"}) ==
        "frahm completion: SHELL: \"bsh\" is not possible; did you mean \"bash\"?");
  CHECK(complaint({"run", "s.toml", "--threads", "x"}) ==
        "frahm run: --threads: \"x\" is no whole number from 0 to 4096");
  CHECK(complaint({"export", "s.toml", "--rate", "1", "--rate", "2"}) ==
        "frahm export: --rate is given 2 times, and can be given once");
  CHECK(complaint({"run", "s.toml", "-o"}) == "frahm run: --output lacks its value, FILE");
  CHECK(complaint({"run", "s.toml", "--thread", "2"}) ==
        "frahm run: unknown option --thread; did you mean \"--threads\"?");
  CHECK(complaint({"rnu"}) == "frahm: unknown command \"rnu\"; did you mean \"run\"?");
}

TEST_CASE("frahm help is frahm --help, of a command and of a kind of study too") {
  CHECK(frahm({"help"}).out == frahm({"--help"}).out);
  CHECK(frahm({"help", "run"}).out == frahm({"run", "--help"}).out);
  CHECK(frahm({"help", "tune"}).out == frahm({"tune", "--help"}).out);
  CHECK(frahm({"help", "run"}).code == 0);
  CHECK(complaint({"help", "rnu"}) == "frahm: help: unknown command \"rnu\"; did you mean \"run\"?");
  CHECK(complaint({"help", "tnue"}) == "frahm: help: unknown command \"tnue\"; did you mean \"tune\"?");
}

TEST_CASE("a quantity or group that a result has not gets the nearest that it has") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), result = folder / "small.h5";
  REQUIRE(run(study, result).code == 0);
  const auto page = frahm({"report", result, "--quantities", "main_peek"});
  CHECK(page.code == 2);
  CHECK_THAT(page.err, Catch::Contains("no quantity \"main_peek\"; did you mean \"main_peak\"?"));
  const auto table = frahm({"export", result, "--group", "mods"});
  CHECK(table.code == 2);
  CHECK_THAT(table.err, Catch::Contains("has no group \"mods\"; did you mean \"modes\"?"));
}

// Those that the help of the program lists.
Names commands_of_help() {
  std::istringstream help(frahm({"--help"}).out);
  Names commands;
  std::string line;
  while (std::getline(help, line) && line != "Commands:") {
  }
  while (std::getline(help, line) && !line.empty()) {
    std::istringstream words(line);
    words >> commands.emplace_back();
  }
  return commands;
}

int occurrences(const std::string& text, const std::string& passage) {
  int count = 0;
  for (std::size_t at = text.find(passage); at != std::string::npos; at = text.find(passage, at + 1)) ++count;
  return count;
}

TEST_CASE("help teaches by examples, for each command") {
  CHECK(frahm({"--help"}).code == 0);
  const auto commands = commands_of_help();
  CHECK(commands.size() >= 13);
  for (const std::string& command : commands) {
    INFO(command);
    const auto help = frahm({command, "--help"});
    CHECK(help.code == 0);
    const std::string examples = help.out.substr(std::min(help.out.find("Examples"), help.out.size()));
    CHECK(occurrences(examples, "frahm " + command) >= 2);
    for (const char* noise : {"TEXT", "REQUIRED", " INT", "->", "Needs:"})
      CHECK_FALSE(help.out.find(noise) != std::string::npos);
  }
}

TEST_CASE("help about a kind of study, which is no command, tells how it is computed") {
  for (const std::string kind : {"sweep", "tune", "identify", "decay", "transient"}) {
    const auto help = frahm({kind, "--help"});
    CHECK(help.code == 0);
    CHECK_THAT(help.out, Catch::Contains("frahm new " + kind) &&
                             Catch::Contains("frahm run " + kind + ".toml") &&
                             Catch::Contains("Usage: frahm run"));
  }
}

TEST_CASE("an unknown word of the command line gets the nearest one") {
  CHECK_THAT(frahm({"chek", "a.toml"}).err, Catch::Contains("did you mean \"check\""));
  CHECK_THAT(frahm({"run", "--fressh", "a.toml"}).err, Catch::Contains("did you mean \"--fresh\""));
  CHECK_THAT(frahm({"run", "--threds=2", "a.toml"}).err, Catch::Contains("did you mean \"--threads\""));
  CHECK_THAT(frahm({"run", "a.toml", "b.toml"}).err,
             Catch::Contains("b.toml") && Catch::Contains("too many"));
  CHECK_THAT(frahm({"tune", "a.toml"}).err, Catch::Contains("frahm run computes"));
  CHECK_THAT(frahm({"new", "tun"}).err, Catch::Contains("did you mean \"tune\""));
  CHECK_THAT(frahm({"explain", "stifness"}).err, Catch::Contains("did you mean \"stiffness\""));
}

TEST_CASE("a new study of each kind runs as it is") {
  const Folder folder;
  for (const std::string kind : {"sweep", "tune", "decay", "transient"}) {
    INFO(kind);
    const std::string study = folder / (kind + ".toml");
    CHECK(frahm({"new", kind, study}).code == 0);
    CHECK(frahm({"check", study}).code == 0);
    CHECK(frahm({"run", study, "-o", folder / (kind + ".h5"), "--progress", "none"}).code == 0);
  }
  const std::string model = folder / "identify.toml";
  CHECK(frahm({"export", folder / "decay.toml", "--data", folder / "measured.csv", "--noise", "0.5%"}).code ==
        0);
  CHECK(frahm({"new", "identify", model}).code == 0);
  const auto found = frahm({"run", model, "-o", folder / "identify.h5", "--progress", "none"});
  INFO(found.err);
  CHECK(found.code == 0);
  // A study that is there is not replaced.
  CHECK(frahm({"new", "sweep", model}).code == 6);
}

TEST_CASE("check tells what the histories of listed orbits take") {
  // 512 instants of time, two states and an acceleration, three forces, slip and its rate: 9 numbers, 3
  // times.
  CHECK_THAT(frahm({"check", study_path("regime_map")}).out,
             Catch::Contains("orbits  the histories of 3, about a second more, 111 kB before compression"));
}

TEST_CASE("words of studies and results are explained and so are the exit codes") {
  CHECK_THAT(frahm({"explain", "machine_peak"}).out, Catch::Contains("[m]") && Catch::Contains("largest"));
  CHECK_THAT(frahm({"explain", "stiffness"}).out, Catch::Contains("[[element]]") && Catch::Contains("N/m"));
  CHECK_THAT(frahm({"explain", "[[element]]"}).out, Catch::Contains("spring"));
  CHECK_THAT(frahm({"explain", "grazing"}).out, Catch::Contains("status"));
  for (int code = 0; code <= 8; ++code)
    CHECK_THAT(frahm({"explain", std::to_string(code)}).out, Catch::Contains("exit code"));
  CHECK(frahm({"explain", "nothing_of_ours"}).code == 2);
}

TEST_CASE("a result given for a study and a study for a result are recognised") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), result = folder / "small.h5";
  CHECK(run(study, result).code == 0);
  for (const char* command : {"run", "check", "point"}) {
    const auto outcome = frahm({command, result});
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err, Catch::Contains("is a result"));
  }
  for (const char* command : {"status", "report", "export"}) {
    const auto outcome = frahm({command, study});
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err, Catch::Contains("is a study"));
  }
}

TEST_CASE("a study without one motion or response has no measurements to export") {
  const Folder folder;
  const std::string study = study_path("tune_slip_force");  // over records
  const auto outcome = frahm({"export", study, "--data", folder / "measured.csv"});
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.err, Catch::Contains("a tuning over records has no periodic response"));
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
      CHECK_THAT(refused.err, Catch::Contains("is not a result of frahm; give another -o"));
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
                                Catch::Contains("or discard what is there with --fresh"));
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
    CHECK_THAT(refused.err, Catch::Contains("q.toml: has the name of a study; name this output .h5"));
  }
  const auto refused = frahm({"new", "sweep", folder / "a.h5"});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Catch::Contains("a.h5: has the name of a result; name this study .toml"));
  CHECK(folder.names() == Names{"decay.toml", "small.toml"});
}

TEST_CASE("a result that was cut off is called damaged, and --fresh computes it anew") {
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
    CHECK_THAT(refused.err, Catch::Contains("small.h5: is a result that is damaged, or of a later version") &&
                                Catch::Contains("--fresh computes it anew"));
    CHECK(run(study, output, {"--fresh"}).code == 0);
    CHECK(text_of(output).size() > whole.size() / 2);
    CHECK(frahm({"status", output}).code == 0);
  }
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
    CHECK_THAT(refused.err, Catch::Contains(*note) && Catch::Contains("is no note of frahm"));
  }
  CHECK(text_of(folder / *note) == "my thesis");
  CHECK(folder.names() == Names{*note, "small.toml"});
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
  CHECK_THAT(another.err, Catch::Contains("no longer gives what the logs were made from"));
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
