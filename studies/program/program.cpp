#include "studies/program/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <system_error>

#include "engine/assist.hpp"
#include "engine/dealer.hpp"
#include "engine/fingerprint.hpp"
#include "engine/io_error.hpp"
#include "engine/mpi.hpp"
#include "results/store_error.hpp"
#include "studies/program/assist_command.hpp"
#include "studies/program/check_command.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/export_command.hpp"
#include "studies/program/merge_command.hpp"
#include "studies/program/option_values.hpp"
#include "studies/program/point_command.hpp"
#include "studies/program/report_command.hpp"
#include "studies/program/run_command.hpp"
#include "studies/program/status_command.hpp"
#include "studies/program/verify_command.hpp"
#include "studies/program/version_command.hpp"
#include "studies/reading/study_source.hpp"

namespace frahm::studies {
namespace {

constexpr const char* overview =
    "Periodic responses of vibrating systems with dry friction and inerters, over whole maps of parameters.";

constexpr const char* first_steps = R"(
A study file describes a system and the axes of a map. From there:
  frahm check study.toml                      is it right, how long will it take
  frahm point study.toml --at r=0.9,f=0.1     the full report of one response
  frahm run study.toml                        the whole map, into study.h5; run again to resume
  frahm status study.h5                       what is in a file, or how far it is
  frahm report study.h5                       its page: maps, curves and numbers to look at
Every command has its own help: frahm run --help

Exit codes: 0 done, 1 internal error, 2 wrong usage or study, 3 some points failed or have no periodic
response, 4 stopped (run again to resume), 5 refused to mix results of different studies, 6 input or output failed, 7 a tuning or fit did not
converge, 8 self-check failed)";

constexpr const char* run_examples = R"(
Examples:
  frahm run rig_atlas.toml                    into rig_atlas.h5, on all processors
  frahm run rig_atlas.toml --set "K=8200 N/m" -o stiffer.h5
  frahm run rig_atlas.toml --time-budget 50m  stops in time; the same command goes on
  mpirun -np 16 frahm run rig_atlas.toml      on the ranks of an MPI job
  frahm run rig_atlas.toml --from rig_atlas.h5    after axes have grown: computes the new points only
  frahm run rig_decay_main.toml               one motion: a free decay, or a transient
  frahm run tune_classical.toml               a tuning: an optimum from each of its starts
  frahm run identify_rig_tmd.toml             an identification: a model from measurements
  sbatch --array=0-15 --wrap 'frahm run rig_atlas.toml --shard $SLURM_ARRAY_TASK_ID/16'
                                              then: frahm merge rig_atlas.h5)";

constexpr const char* check_examples = R"(
Examples:
  frahm check rig_atlas.toml --set "A=20 mm"
  frahm check rig_atlas.toml --max-array 201  an array's tasks, as MaxArraySize of the cluster allows
  frahm check rig_atlas.toml --simulate-ranks 1000 --threads 4)";

constexpr const char* point_examples = R"(
Examples (a bare number is in the unit in which the study speaks of the parameter):
  frahm point den_hartog.toml --at r=0.9,f=0.1
  frahm point rig_atlas.toml --at "omega=250 rpm,I=6.36 kg" --history orbit.csv
  frahm point rig_atlas.toml --at omega=250 --json
  frahm point rig_atlas.toml --at omega=250 --gradient)";

constexpr const char* merge_examples = R"(
Examples:
  frahm merge rig_atlas.h5                    all shard logs beside it
  frahm merge rig_atlas.h5 node1/rig_atlas.h5.*.frahm-log node2/rig_atlas.h5.*.frahm-log
  frahm merge rig_atlas.h5 --partial          what there is; the logs are kept)";

constexpr const char* export_examples = R"(
Examples:
  frahm export rig_atlas.h5                   into rig_atlas.csv, a row a point
  frahm export rig_atlas.h5 -o - | head
  frahm export curves.h5 --group resonance    the resonances the study asked for
  frahm export tuned.h5 --schedule            a tuning's schedule for a controller, in steps of 1 rpm
  frahm export tuned.h5 --sweep optimum.toml  a study of the response at its optimum; then frahm run it
  frahm export found.h5 --study model.toml    a study in which the estimates of an identification stand
  frahm export rig_decay_main.toml --data decay.csv --rate "500 Hz" --noise "0.05 mm" --seed 7
                                              measurements as a sensor would take them, to try an experiment)";

constexpr const char* report_examples = R"(
Examples:
  frahm report rig_atlas.h5                   the page rig_atlas.html: opens in any browser, alone and offline
  frahm report rig_atlas.h5 -o for_client.html --quantities main_peak,tmd_peak,guide_regime
  frahm report tuned.h5 --figures figures     its figures for a paper: SVG, CSV, and PDF with rsvg-convert or
                                              inkscape)";

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
                  "change a parameter that is no axis: name=value or \"name=value unit\"; repeatable")
      ->allow_extra_args(false);
}

void add_threads(CLI::App& command, int& threads) {
  command
      .add_option("--threads", threads,
                  "number of threads; 0: OMP_NUM_THREADS, else SLURM_CPUS_PER_TASK, else all processors")
      ->check(CLI::Range(0, 4096))
      ->take_last();
}

void add_progress(CLI::App& command, engine::ProgressStyle& style) {
  const std::map<std::string, engine::ProgressStyle> styles{{"auto", engine::ProgressStyle::automatic},
                                                            {"plain", engine::ProgressStyle::plain},
                                                            {"json", engine::ProgressStyle::json},
                                                            {"none", engine::ProgressStyle::none}};
  command.add_option("--progress", style, "auto, plain, json or none")
      ->transform(CLI::Transformer(styles))
      ->type_name("STYLE")
      ->take_last();
}

// The options of `run` as texts, read once the whole line is known.
struct RunTexts {
  RunCommandOptions options;
  std::string shard, budget;
};

void add_run(CLI::App& program, RunTexts& texts, Action& action) {
  CLI::App* run =
      add_command(program, "run",
                  "compute what a study asks for: a map, an optimum, one motion or a model; again, to resume",
                  run_examples);
  auto& [options, shard, budget] = texts;
  add_study(*run, options.study);
  run->add_option("-o,--output", options.run.output, "result file; else the study's name with .h5, here");
  add_threads(*run, options.run.threads);
  run->add_option("--shard", shard,
                  "i/n: compute part i of n, i from 0; else, in an array task of Slurm, its own part");
  run->add_option("--from", options.from,
                  "reuse the points of this earlier result, of the same system on another grid");
  run->add_flag("--fresh", options.run.fresh, "start anew: an earlier result and its logs are lost");
  run->add_option("--time-budget", budget, "stop after 90s, 50m, 2h or 1d");
  add_set(*run, options.set);
  add_progress(*run, options.run.progress);
  run->callback([&, run] {
    action = [&, run](std::ostream& out) {
      options.run.shard = run->count("--shard") == 0 ? shard_of_array_task(std::getenv) : shard_of(shard);
      if (run->count("--output") > 0 && options.run.output.empty())
        throw StudyError(rules::wrong_option, "--output \"\": name the result file");
      if (run->count("--from") > 0 && options.from.empty())
        throw StudyError(rules::wrong_option, "--from \"\": name the result whose points are taken over");
      if (run->count("--time-budget") > 0) options.run.time_budget = time_span_of("--time-budget", budget);
      const bool leads = !options.run.ranks || options.run.ranks->rank() == 0;
      return leads ? run_command(options, out) : assist_command(options);
    };
  });
}

void add_check(CLI::App& program, CheckOptions& options, Action& action) {
  CLI::App* check = add_command(
      program, "check", "validate a study; its size, its time, its natural frequencies", check_examples);
  add_study(*check, options.study);
  add_set(*check, options.set);
  add_threads(*check, options.threads);
  check
      ->add_option("--max-array", options.max_array,
                   "most tasks of a Slurm array (MaxArraySize); else as Slurm here says, or 1001")
      ->check(CLI::Range(1, 4'000'001));  // the largest Slurm can be set to
  check
      ->add_option("--simulate-ranks", options.simulate_ranks,
                   "predict time and efficiency on up to so many MPI ranks of --threads each (0: one)")
      ->check(CLI::Range(1, 100'000));
  check->add_flag("--all", options.all, "every mode, of a large system too");
  check->callback([&] { action = [&](std::ostream& out) { return check_command(options, out); }; });
}

void add_point(CLI::App& program, PointOptions& options, Action& action) {
  CLI::App* point = add_command(program, "point", "the full report of one response", point_examples);
  add_study(*point, options.study);
  point->add_option("--at", options.at, "name=value,...; other parameters as in the study")
      ->allow_extra_args(false);
  add_set(*point, options.set);
  point->add_option("--history", options.history, "write the motion over one period to this CSV file");
  point->add_flag("--gradient", options.gradient,
                  "exact derivatives with respect to the parameters, beside central differences");
  point
      ->add_option(
          "--path", options.path,
          "fastest: from the phases of its events where that is proved; general: by shooting, always")
      ->check(CLI::IsMember({"fastest", "general"}))
      ->take_last();
  point->add_flag("--json", options.json, "the report as one JSON object");
  point->add_flag("--all", options.all, "every quantity and mode, of a large system too");
  point->callback([&] { action = [&](std::ostream& out) { return point_command(options, out); }; });
}

void add_status(CLI::App& program, std::filesystem::path& file, Action& action) {
  CLI::App* status = program.add_subcommand("status", "what a result file holds, or how far it is");
  status->add_option("FILE", file, "result file, finished or not")->required();
  status->callback([&] { action = [&](std::ostream& out) { return status_command(file, out); }; });
}

void add_merge(CLI::App& program, MergeOptions& options, Action& action) {
  CLI::App* merge =
      add_command(program, "merge", "join what run --shard computed into the result file", merge_examples);
  merge->add_option("FILE", options.output, "result file to make")->required();
  merge->add_option("SHARD", options.logs, "shard logs (*.frahm-log); else those beside FILE");
  merge->add_flag("--partial", options.partial,
                  "write what there is although tiles are missing; the logs stay");
  add_threads(*merge, options.threads);
  add_progress(*merge, options.progress);
  merge->callback([&] { action = [&](std::ostream& out) { return merge_command(options, out); }; });
}

void add_export(CLI::App& program, ExportOptions& options, Action& action) {
  CLI::App* command = add_command(
      program, "export", "write a result as CSV; a study of an optimum or a model; simulated measurements",
      export_examples);
  command->add_option("FILE", options.file, "result file")->required();
  command->add_option("--group", options.group,
                      "a group instead of the map: resonance, orbits, identification ...");
  command->add_flag("--csv", options.csv, "CSV, which is the default");
  command->add_flag("--schedule", options.schedule, "of a tuning: its schedule for a controller");
  command->add_option("--step", options.step, "of --schedule: its step, in the unit of the band; else 1 rpm");
  command->add_option("--sweep", options.sweep, "of a tuning: a study that sweeps its optimum, to this file");
  command->add_option("--study", options.study,
                      "of an identification: a study in which its estimates stand, to this file");
  DataOptions& data = options.data;
  command->add_option("--data", data.output,
                      "simulated measurements of a study (FILE may be one), to this CSV file; - for stdout");
  add_set(*command, data.set);
  command->add_option("--at", data.at, "of --data: the point of a periodic response, name=value,...")
      ->allow_extra_args(false);
  command->add_option("--rate", data.rate,
                      "of --data: samples a second, or \"1 kHz\"; else 100 a natural period");
  command->add_option("--duration", data.duration,
                      "of --data: so long, \"10 s\"; else the motion, or ten periods");
  command->add_option("--noise", data.noise,
                      "of --data: standard deviation, \"1%\" of each column's own or \"0.1 mm\"");
  command->add_option("--seed", data.seed, "of --data: of the noise, else 1");
  command
      ->add_option("--columns", data.columns,
                   "of --data: name,... of <mass>_displacement, _velocity, _acceleration, of a periodic "
                   "response <element>_force too; else the displacements")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("-o,--output", options.output, "CSV file, - for stdout; else FILE with .csv");
  command->callback([&] { action = [&](std::ostream& out) { return export_command(options, out); }; });
}

void add_report(CLI::App& program, ReportOptions& options, Action& action) {
  CLI::App* command = add_command(
      program, "report", "make the page of a result: figures, tables, where they come from", report_examples);
  command->add_option("FILE", options.file, "result file")->required();
  command->add_option("-o,--output", options.output, "the page, - for stdout; else FILE with .html");
  command
      ->add_option(
          "--quantities", options.quantities,
          "of a map: name,... to show, or floor*_peak; else those of the study's [report], else peaks, "
          "strokes, regimes, stops, energy shares, differences and status")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--figures", options.figures,
                      "no page: every figure as SVG, CSV and PDF into this folder; needs Node.js");
  command->callback([&] { action = [&](std::ostream& out) { return report_command(options, out); }; });
}

// All values that the command line can set.
struct CommandLine {
  RunTexts run;
  CheckOptions check;
  PointOptions point;
  std::filesystem::path status;
  MergeOptions merge;
  ExportOptions table;
  ReportOptions report;
  bool version = false, verbose = false;
  Action action;
};

void describe(CLI::App& program, CommandLine& line) {
  program.footer(first_steps);
  program.require_subcommand(0, 1);
  auto* version = program.add_flag("--version", line.version, "print the version");
  program.add_flag("--verbose", line.verbose, "compiler, libraries, processor")->needs(version);
  add_run(program, line.run, line.action);
  add_check(program, line.check, line.action);
  add_point(program, line.point, line.action);
  add_status(program, line.status, line.action);
  add_merge(program, line.merge, line.action);
  add_export(program, line.table, line.action);
  add_report(program, line.report, line.action);
  program
      .add_subcommand("verify",
                      "solve the classical cases on this machine and compare with their closed forms")
      ->callback([&line] { line.action = [](std::ostream& out) { return verify_command(out); }; });
}

// How a command ended.
struct Ending {
  int code = exit_code::done;
  std::string complaint = {};  // the error; empty if there was none
};

Ending carry_out(const Action& action, std::ostream& out) {
  try {
    const int code = action(out);
    out.flush();
    return out ? Ending{code}
               : Ending{exit_code::input_output,
                        "standard output could not be written to; a file that was made is whole"};
  } catch (const StudyError& error) {
    return {exit_code::wrong_input, error.what()};
  } catch (const engine::ResumeRefused& error) {
    const std::string advice = error.advice().empty()
                                   ? "it is not replaced unasked: name another file with -o, or discard what "
                                     "is there with --fresh"
                                   : error.advice();
    return {exit_code::resume_refused, fmt::format("{}\n{}", error.what(), advice)};
  } catch (const engine::RankFailed& error) {
    return {error.code(), error.what()};
  } catch (const engine::IoError& error) {
    return {exit_code::input_output, error.what()};
  } catch (const results::StoreError& error) {
    return {exit_code::input_output, error.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    return {exit_code::input_output, error.what()};
  } catch (const std::bad_alloc&) {
    return {exit_code::input_output, "there is not enough memory"};
  } catch (const std::system_error& error) {
    return {exit_code::input_output,
            fmt::format("the system refuses a thread or another of its means: {}", error.what())};
  } catch (const std::exception& error) {
    return {exit_code::internal_error, fmt::format("internal error, please report it: {}", error.what())};
  }
}

// Parses the command line; the exit code if there is nothing more to do. A rank other than 0 prints nothing.
std::optional<int> parse(CLI::App& program, CommandLine& line, int argc, const char* const* argv,
                         std::ostream& out, std::ostream& complaints) {
  for (int i = 0; i < argc; ++i) line.run.options.command += (i == 0 ? "frahm" : std::string(" ") + argv[i]);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) complaints << "frahm: ";
    return program.exit(error, out, complaints) == 0 ? exit_code::done : exit_code::wrong_input;
  }
  if (line.version) line.action = [&line](std::ostream& to) { return version_command(line.verbose, to); };
  if (line.action) return std::nullopt;
  complaints << program.help();
  return exit_code::wrong_input;
}

// Runs the program in a single process, or in rank 0.
int lead(engine::Ranks* ranks, int argc, const char* const* argv, std::ostream& out) {
  CLI::App program(overview, "frahm");
  CommandLine line;
  describe(program, line);
  line.run.options.run.ranks = ranks;
  if (const auto code = parse(program, line, argc, argv, out, std::cerr)) return *code;
  const Ending ending = carry_out(line.action, out);
  if (!ending.complaint.empty()) std::cerr << "frahm: " << ending.complaint << '\n';
  return ending.code;
}

// Runs the program in the other ranks: a run is shared, rank 0 does every other command. These ranks print
// nothing; rank 0 reports their errors.
int follow(engine::Ranks& ranks, int argc, const char* const* argv) {
  CLI::App program(overview, "frahm");
  CommandLine line;
  describe(program, line);
  line.run.options.run.ranks = &ranks;
  std::ostringstream unseen;
  if (parse(program, line, argc, argv, unseen, unseen) || !program.got_subcommand("run"))
    return engine::wait_for_end(ranks);
  const Ending ending = carry_out(line.action, unseen);
  return ending.complaint.empty() ? ending.code : engine::tell_failure(ranks, ending.complaint, ending.code);
}

}  // namespace

int run_program(int argc, const char* const* argv, std::ostream& out) {
  const std::unique_ptr<engine::Ranks> ranks = engine::mpi_ranks();
  if (!ranks) return lead(nullptr, argc, argv, out);
  if (ranks->rank() > 0) return follow(*ranks, argc, argv);
  const int code = lead(ranks.get(), argc, argv, out);
  engine::end_all(*ranks, code);
  return code;
}

}  // namespace frahm::studies
