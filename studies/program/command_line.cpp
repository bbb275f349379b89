#include "studies/program/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <ostream>

#include "studies/program/assist_command.hpp"
#include "studies/program/command_examples.hpp"
#include "studies/program/completion.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/explain_command.hpp"
#include "studies/program/help_text.hpp"
#include "studies/program/option_values.hpp"
#include "studies/program/schema_command.hpp"
#include "studies/program/starter_studies.hpp"
#include "studies/program/status_command.hpp"
#include "studies/program/verify_command.hpp"
#include "studies/program/version_command.hpp"
#include "studies/reading/text/plain_text.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

using Action = std::function<int(std::ostream&)>;  // of the given command

CLI::App* add_command(CLI::App& program, const char* name, const char* what, const char* examples) {
  CLI::App* command = program.add_subcommand(name, what);
  command->footer(examples);
  return command;
}

void add_study(CLI::App& command, std::filesystem::path& study) {
  command.add_option("STUDY", study, "study file (TOML)")->required();
}

void add_set(CLI::App& command, std::vector<std::string>& set) {
  command
      .add_option("--set", set,
                  "change a parameter that is not an axis: name=value or \"name=value unit\"; repeatable")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

// Checks of values, whose messages are ours.
auto among(std::vector<std::string> words) {
  return [words = std::move(words)](const std::string& text) { return problem_of_word(text, words); };
}
auto whole_within(std::int64_t least, std::int64_t most) {
  return [=](const std::string& text) { return problem_of_whole_number(text, least, most); };
}

void add_threads(CLI::App& command, int& threads) {
  command
      .add_option(
          "--threads", threads,
          "number of threads; 0: OMP_NUM_THREADS, otherwise SLURM_CPUS_PER_TASK, otherwise all processors")
      ->type_name("N")
      ->check(whole_within(0, 4096))
      ->take_last();
}

void add_progress(CLI::App& command, engine::ProgressStyle& style) {
  using enum engine::ProgressStyle;
  const std::map<std::string, engine::ProgressStyle> styles{
      {"auto", automatic}, {"plain", plain}, {"json", json}, {"none", none}};
  command
      .add_option_function<std::string>(
          "--progress", [&style, styles](const std::string& word) { style = styles.at(word); },
          "how to show progress (default: auto)")
      ->type_name("auto|plain|json|none")
      ->check(among({"auto", "plain", "json", "none"}))
      ->take_last();
}

int run_as_given(CommandLine& line, std::ostream& out) {
  RunCommandOptions& options = line.run;
  options.run.shard = line.shard.empty() ? shard_of_array_task(std::getenv) : shard_of(line.shard);
  if (!line.time_budget.empty()) options.run.time_budget = time_span_of("--time-budget", line.time_budget);
  if (!line.rank_silence.empty())
    options.run.rank_silence = time_span_of("--rank-silence", line.rank_silence);
  const bool leads = !options.run.ranks || options.run.ranks->rank() == 0;
  return leads ? run_command(options, out) : assist_command(options);
}

void add_run(CLI::App& program, CommandLine& line) {
  CLI::App* run = add_command(
      program, "run",
      "compute what a study asks for: a map, an optimum, one motion or a model; run again to resume",
      help::run_examples);
  RunCommandOptions& options = line.run;
  add_study(*run, options.study);
  run->add_option("-o,--output", options.run.output,
                  "result file (default: the study's name with .h5, in this folder)")
      ->type_name("FILE");
  add_threads(*run, options.run.threads);
  run->add_option("--shard", line.shard,
                  "i/n: compute part i of n, i from 0 (default in an array task of Slurm: its own part)")
      ->type_name("I/N");
  run->add_option("--from", options.from,
                  "reuse the points of this earlier result for the same system on another grid")
      ->type_name("RESULT");
  run->add_flag("--fresh", options.run.fresh,
                "start from the beginning; an earlier result and its logs are lost");
  run->add_option("--time-budget", line.time_budget, "stop after TIME, such as 90s, 50m, 2h or 1d")
      ->type_name("TIME");
  run->add_option("--rank-silence", line.rank_silence,
                  "continue without an MPI rank that has been silent for TIME (default 60s)")
      ->type_name("TIME");
  add_set(*run, options.set);
  add_progress(*run, options.run.progress);
  run->callback([&] {
    line.is_run = true;
    line.action = [&](std::ostream& out) { return run_as_given(line, out); };
  });
}

void add_check(CLI::App& program, CheckOptions& options, Action& action) {
  CLI::App* check =
      add_command(program, "check",
                  "validate a study and print its size, its expected run time and its natural frequencies",
                  help::check_examples);
  add_study(*check, options.study);
  add_set(*check, options.set);
  add_threads(*check, options.threads);
  check
      ->add_option("--max-array", options.max_array,
                   "largest number of tasks of a Slurm array, MaxArraySize (default: what Slurm reports "
                   "here, or 1001)")
      ->type_name("N")
      ->check(whole_within(1, 4'000'001));  // the largest Slurm can be set to
  check
      ->add_option("--simulate-ranks", options.simulate_ranks,
                   "predict time and efficiency on up to N MPI ranks with --threads each (0: one)")
      ->type_name("N")
      ->check(whole_within(1, 100'000));
  check->add_flag("--all", options.all, "print every mode, even of a large system");
  check->callback([&] { action = [&](std::ostream& out) { return check_command(options, out); }; });
}

void add_point(CLI::App& program, PointOptions& options, Action& action) {
  CLI::App* point =
      add_command(program, "point", "print the full report of one response", help::point_examples);
  add_study(*point, options.study);
  point
      ->add_option("--at", options.at,
                   "the point, as name=value,...; other parameters keep their values in the study")
      ->type_name("NAME=VALUE,...")
      ->allow_extra_args(false);
  add_set(*point, options.set);
  point->add_option("--history", options.history, "write the motion over one period to this CSV file")
      ->type_name("FILE");
  point->add_flag(
      "--gradient", options.gradient,
      "print exact derivatives with respect to the parameters, with central differences next to them");
  point
      ->add_option("--path", options.path,
                   "fastest: from the phases of the orbit's events where that is proved, otherwise by "
                   "shooting; general: always by shooting")
      ->type_name("fastest|general")
      ->check(among({"fastest", "general"}))
      ->take_last();
  point->add_flag("--responses", options.responses,
                  "print every stable response that was found: state at omega t = 0, peaks, multipliers");
  point->add_flag("--json", options.json, "print the report as one JSON object");
  point->add_flag("--all", options.all, "print every quantity and mode, even of a large system");
  point->callback([&] { action = [&](std::ostream& out) { return point_command(options, out); }; });
}

void add_branch(CLI::App& program, BranchCommandOptions& options, Action& action) {
  CLI::App* branch =
      add_command(program, "branch", "follow a response, stable or not, along a parameter and through folds",
                  help::branch_examples);
  add_study(*branch, options.study);
  branch
      ->add_option("--along", options.along,
                   "the parameter along which to follow the response (any number of the study)")
      ->type_name("NAME")
      ->required();
  branch->add_option("--from", options.from, "start of its range (default: that of its axis)")
      ->type_name("VALUE");
  branch->add_option("--to", options.to, "end of its range (default: that of its axis)")->type_name("VALUE");
  branch
      ->add_option("--at", options.at,
                   "values of other parameters, as name=value,... (default: as in the study); a value of the "
                   "--along parameter is the place to start")
      ->type_name("NAME=VALUE,...")
      ->allow_extra_args(false);
  add_set(*branch, options.set);
  branch->add_option("--steps", options.steps, "largest number of points in each direction (default 2000)")
      ->type_name("N")
      ->check(whole_within(1, 1'000'000));
  branch
      ->add_option("--multiple", options.multiple,
                   "follow a response that takes N periods of the excitation (default: any)")
      ->type_name("N")
      ->check(whole_within(1, 64));
  branch
      ->add_option("-o,--output", options.output,
                   "write all points to this file: a result if its name ends in .h5, otherwise CSV")
      ->type_name("FILE");
  branch->add_flag("--fresh", options.fresh, "replace another result of that name, which is lost");
  add_progress(*branch, options.progress);
  branch->callback([&] { action = [&](std::ostream& out) { return branch_command(options, out); }; });
}

void add_status(CLI::App& program, std::filesystem::path& file, Action& action) {
  CLI::App* status =
      add_command(program, "status", "print what a result file holds, or how much of its run is done",
                  help::status_examples);
  status->add_option("FILE", file, "result file, finished or not")->required();
  status->callback([&] { action = [&](std::ostream& out) { return status_command(file, out); }; });
}

void add_merge(CLI::App& program, MergeOptions& options, Action& action) {
  CLI::App* merge =
      add_command(program, "merge", "join the parts that run --shard computed, and write the result file",
                  help::merge_examples);
  merge->add_option("FILE", options.output, "result file to make")->required();
  merge->add_option("SHARD", options.logs, "shard logs, *.frahm-log (default: those next to FILE)");
  merge->add_flag("--partial", options.partial,
                  "write what there is even if tiles are missing; the logs are kept");
  add_threads(*merge, options.threads);
  add_progress(*merge, options.progress);
  merge->callback([&] { action = [&](std::ostream& out) { return merge_command(options, out); }; });
}

void add_export(CLI::App& program, ExportOptions& options, Action& action) {
  CLI::App* command =
      add_command(program, "export",
                  "write a result as CSV, a study with tuned or identified values, or simulated measurements",
                  help::export_examples);
  command->add_option("FILE", options.file, "result file")->required();
  command
      ->add_option("--group", options.group,
                   "export a group instead of the map: resonance, orbits, branches, identification ...")
      ->type_name("GROUP");
  command->add_flag("--csv", options.csv, "write CSV (the default)");
  command->add_flag("--schedule", options.schedule, "for a tuning: its schedule for a controller");
  command
      ->add_option("--step", options.step,
                   "with --schedule: its step, in the unit of the band (default 1 rpm)")
      ->type_name("STEP")
      ->check(problem_of_number_above_zero);
  command
      ->add_option("--sweep", options.sweep,
                   "for a tuning: write a study that sweeps its optimum to this file")
      ->type_name("FILE");
  command
      ->add_option("--run-up", options.run_up,
                   "for a tuning: write a study of a run-up at its optimum to this file")
      ->type_name("FILE");
  command
      ->add_option("--study", options.study,
                   "for an identification: write a study that contains its estimates to this file")
      ->type_name("FILE");
  DataOptions& data = options.data;
  command
      ->add_option("--data", data.output,
                   "write simulated measurements to this CSV file (- for stdout); the argument FILE may then "
                   "be a study")
      ->type_name("FILE");
  add_set(*command, data.set);
  command->add_option("--at", data.at, "with --data: the point of a periodic response, name=value,...")
      ->type_name("NAME=VALUE,...")
      ->allow_extra_args(false);
  command
      ->add_option("--rate", data.rate,
                   "with --data: samples per second, or \"1 kHz\" (default: 100 per natural period)")
      ->type_name("RATE");
  command
      ->add_option("--duration", data.duration,
                   "with --data: duration, such as \"10 s\" (default: that of the motion, or ten periods)")
      ->type_name("TIME");
  command
      ->add_option("--noise", data.noise,
                   "with --data: standard deviation of the noise, as \"1%\" (of the standard deviation of "
                   "each column) or as \"0.1 mm\"")
      ->type_name("NOISE");
  command->add_option("--seed", data.seed, "with --data: seed of the noise (default 1)")->type_name("N");
  command
      ->add_option(
          "--columns", data.columns,
          "with --data: columns to write: <mass>_displacement, _velocity, _acceleration, and for a periodic "
          "response also <element>_force (default: the displacements)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("-o,--output", options.output, "CSV file, - for stdout (default: FILE with .csv)")
      ->type_name("FILE");
  command->callback([&] { action = [&](std::ostream& out) { return export_command(options, out); }; });
}

void add_report(CLI::App& program, ReportOptions& options, Action& action) {
  CLI::App* command =
      add_command(program, "report", "make the page of a result: figures, tables and where they come from",
                  help::report_examples);
  command->add_option("FILE", options.file, "result file")->required();
  command->add_option("-o,--output", options.output, "the page, - for stdout (default: FILE with .html)")
      ->type_name("FILE");
  command
      ->add_option("--quantities", options.quantities,
                   "for a map: quantities to show, by name or by a pattern such as floor*_peak (default: "
                   "those of the study's [report], otherwise peaks, strokes, regimes, stops, energy shares, "
                   "differences and status)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--figures", options.figures,
                   "write every figure as SVG, CSV and PDF into this folder, and no page; needs Node.js")
      ->type_name("FOLDER");
  command->callback([&] { action = [&](std::ostream& out) { return report_command(options, out); }; });
}

void add_new(CLI::App& program, NewOptions& options, Action& action) {
  CLI::App* command =
      add_command(program, "new", "write a study to start from, with comments", help::new_examples);
  const std::vector<std::string> kinds = starter_kinds();
  command->add_option("KIND", options.kind, listed(kinds, " or "))
      ->required()
      ->type_name(fmt::format("{}", fmt::join(kinds, "|")));
  command->add_option("FILE", options.file, "the study to write, - for stdout (default: KIND.toml)");
  command->callback([&] { action = [&](std::ostream& out) { return new_command(options, out); }; });
}

void add_explain(CLI::App& program, std::string& word, Action& action) {
  CLI::App* command =
      add_command(program, "explain", "print what a key, a quantity, a unit, a status or an exit code means",
                  help::explain_examples);
  command
      ->add_option("WORD", word, "a key of a study, a quantity, a unit, a status, an outcome or an exit code")
      ->required();
  command->callback([&] { action = [&](std::ostream& out) { return explain_command(word, out); }; });
}

void add_completion(CLI::App& program, CommandLine& line) {
  CLI::App* command =
      add_command(program, "completion", "print a script that completes these commands in a shell",
                  help::completion_examples);
  command->add_option("SHELL", line.shell, "bash, zsh or fish")
      ->required()
      ->check(among({"bash", "zsh", "fish"}))
      ->type_name("bash|zsh|fish");
  command->callback([&line] {
    line.action = [&line](std::ostream& out) {
      out << completion_script(line.commands, line.shell);
      return exit_code::done;
    };
  });
}

void add_help(CLI::App& program, CommandLine& line) {
  std::string words = "help";
  for (const CLI::App* each : program.get_subcommands(nullptr)) words += "|" + each->get_name();
  for (const std::string& kind : starter_kinds()) words += "|" + kind;
  CLI::App* command = add_command(program, "help", "print the help of a command", help::help_examples);
  command->add_option("COMMAND", line.word, "command or kind of study (default: frahm itself)")
      ->type_name(words);
  command->callback([&line] {
    line.action = [&line](std::ostream& out) {
      out << help_for(line.commands, line.word);
      return exit_code::done;
    };
  });
}

void describe(CLI::App& program, CommandLine& line) {
  program.set_help_flag("-h,--help", "print this help");
  program.footer(help::first_steps);
  program.require_subcommand(0, 1);
  auto* version = program.add_flag("--version", line.version, "print the version");
  program.add_flag("--verbose", line.verbose, "with --version: compiler, libraries, processor")
      ->needs(version);
  add_run(program, line);
  add_check(program, line.check, line.action);
  add_point(program, line.point, line.action);
  add_branch(program, line.branch, line.action);
  add_status(program, line.status, line.action);
  add_merge(program, line.merge, line.action);
  add_export(program, line.table, line.action);
  add_report(program, line.report, line.action);
  add_command(program, "verify",
              "solve the classical cases on this machine and compare with their closed forms",
              help::verify_examples)
      ->callback([&line] { line.action = [](std::ostream& out) { return verify_command(out); }; });
  add_new(program, line.starter, line.action);
  add_explain(program, line.word, line.action);
  add_command(program, "schema", "print the JSON Schema of study files, for editors", help::schema_examples)
      ->callback([&line] { line.action = schema_command; });
  add_completion(program, line);
  add_help(program, line);
}

// What CLI11 knows of an option, in our own words.
CommandOption option_of(const CLI::Option& option) {
  CommandOption own{.what = option.get_description(),
                    .is_positional = option.get_positional(),
                    .is_required = option.get_required(),
                    .is_list = option.get_expected_max() > 1};
  if (own.is_positional) own.names.push_back(option.get_name(true));
  for (const std::string& name : option.get_snames()) own.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) own.names.push_back("--" + name);
  // After a colon it has the checks of the value; a flag has no type.
  const std::string type = option.get_type_name();
  if (option.get_items_expected_max() > 0) own.value = type.substr(0, type.find(':'));
  return own;
}

Command command_of(const CLI::App& app, const std::string& name) {
  Command own{.name = name, .what = app.get_description(), .foot = app.get_footer()};
  for (const CLI::Option* option : app.get_options()) own.options.push_back(option_of(*option));
  for (const CLI::App* each : app.get_subcommands(nullptr))
    own.commands.push_back(command_of(*each, name + " " + each->get_name()));
  return own;
}

// The one of its commands that was given, otherwise the program itself.
const Command& given_command(const CLI::App& program, const Command& tree) {
  const auto given = program.get_subcommands();
  if (given.empty()) return tree;
  return *std::ranges::find(tree.commands, given.front()->get_name(), &Command::last_word);
}

// What CLI11 says of an option that lacks its value or is given too often, in our own words.
std::string in_our_words(const CLI::ParseError& error) {
  const std::string what = error.what();
  const std::string first = what.substr(0, what.find('\n'));
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ArgumentMismatch)) return first;
  const std::string option = first.substr(0, first.find(':'));
  constexpr std::string_view before = " required ", after = " missing", received = "received ";
  const std::size_t type = first.find(before), times = first.rfind(received);
  if (times != std::string::npos)
    return fmt::format("{} is given {} times, but can be given only once", option,
                       first.substr(times + received.size()));
  if (type == std::string::npos || !first.ends_with(after)) return first;
  const std::size_t start = type + before.size();
  return fmt::format("{} lacks its value, {}", option,
                     first.substr(start, first.size() - after.size() - start));
}

// What is wrong with a command line, and the nearest word to one that is not known.
std::string complaint(const CLI::App& program, const Command& tree, const CLI::ParseError& error) {
  const Command& command = given_command(program, tree);
  const std::vector<std::string> unknown = program.remaining(true);
  const std::string more = fmt::format("\nMore: {} --help", command.name);
  if (unknown.empty()) return fmt::format("{}: {}{}", command.name, in_our_words(error), more);
  const std::string word = unknown.front().substr(0, unknown.front().find('='));
  if (word.starts_with("-")) {
    std::vector<std::string> names;
    for (const CommandOption& option : command.options) {
      if (!option.is_positional) names.insert(names.end(), option.names.begin(), option.names.end());
    }
    return fmt::format("{}: unknown option {}{}{}", command.name, word, suggestion(word, names), more);
  }
  if (&command != &tree)
    return fmt::format("{}: \"{}\" is one argument too many{}", command.name, word, more);
  return fmt::format("frahm: {}{}", unknown_command(tree, word), more);
}

// The help that a command line asks for.
std::string asked_help(const CLI::App& program, const Command& tree) {
  const Command& command = given_command(program, tree);
  const std::vector<std::string> unknown = program.remaining(true);
  const std::vector<std::string> kinds = starter_kinds();
  const bool is_of_kind =
      &command == &tree && !unknown.empty() && std::ranges::find(kinds, unknown.front()) != kinds.end();
  return is_of_kind ? help_for(tree, unknown.front()) : help_text(command);
}

// What is wrong with the first argument that could not be printed in a message, kept in a note or stored in a
// result, or that is empty, as no value of ours is.
std::optional<std::string> unfit_argument(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    std::string shown = argv[i];
    if (shown.empty()) return fmt::format("argument {}, after \"{}\", is empty", i, argv[i - 1]);
    if (shown.starts_with("--") && shown.ends_with("=")) return fmt::format("\"{}\" lacks its value", shown);
    if (is_plain_line(shown)) continue;
    std::ranges::replace_if(
        shown, [](char c) { return c == '\n' || c == '\t'; }, '?');
    return fmt::format("argument {} \"{}\": must be UTF-8 without control characters such as a line feed", i,
                       shown);
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> parse_command_line(int argc, const char* const* argv, CommandLine& line, std::ostream& out,
                                      std::ostream& complaints) {
  CLI::App program(help::overview, "frahm");
  describe(program, line);
  for (int i = 0; i < argc; ++i) line.run.command += (i == 0 ? "frahm" : std::string(" ") + argv[i]);
  line.branch.command = line.run.command;
  line.commands = command_of(program, "frahm");
  if (const auto wrong = unfit_argument(argc, argv)) {
    complaints << "frahm: " << *wrong << '\n';
    return exit_code::wrong_input;
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    out << asked_help(program, line.commands);
    return exit_code::done;
  } catch (const CLI::ParseError& error) {
    complaints << complaint(program, line.commands, error) << '\n';
    return exit_code::wrong_input;
  }
  if (line.version) line.action = [&line](std::ostream& to) { return version_command(line.verbose, to); };
  if (line.action) return std::nullopt;
  complaints << help_text(line.commands);
  return exit_code::wrong_input;
}

}  // namespace frahm::studies
