// What is told of commands: help, wrong usage, the nearest word.
#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "tests/end_to_end/small_runs.hpp"
#include "tests/study_path.hpp"

namespace command_words_test {
namespace {

using runs::Folder, runs::frahm, runs::Names, runs::run, runs::small;

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
        "frahm run: --threads: \"x\" is not a whole number from 0 to 4096");
  CHECK(complaint({"export", "s.toml", "--rate", "1", "--rate", "2"}) ==
        "frahm export: --rate is given 2 times, but can be given only once");
  CHECK(complaint({"run", "s.toml", "-o"}) == "frahm run: --output lacks its value, FILE");
  CHECK(complaint({"run", "s.toml", "--thread", "2"}) ==
        "frahm run: unknown option --thread; did you mean \"--threads\"?");
  CHECK(complaint({"rnu"}) == "frahm: unknown command \"rnu\"; did you mean \"run\"?");
}

TEST_CASE("an empty argument is refused, whatever it is for") {
  for (const Names& wrong : {Names{"run", "s.toml", "-o", ""}, Names{"export", "r.h5", "-o", ""},
                             Names{"report", "r.h5", "-o", ""}, Names{"point", "s.toml", "--history", ""},
                             Names{"new", "sweep", ""}, Names{"merge", ""}}) {
    const std::string after = wrong[wrong.size() - 2];
    CHECK(complaint(wrong) ==
          "frahm: argument " + std::to_string(wrong.size()) + ", after \"" + after + "\", is empty");
  }
  CHECK(complaint({"export", "r.h5", "--output="}) == "frahm: \"--output=\" lacks its value");
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

}  // namespace
}  // namespace command_words_test
