#include "studies/program/program.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <system_error>

#include "engine/assist.hpp"
#include "engine/dealer.hpp"
#include "engine/fingerprint.hpp"
#include "engine/io_error.hpp"
#include "engine/mpi.hpp"
#include "results/checked_apart.hpp"
#include "results/store_error.hpp"
#include "studies/program/command_line.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/plain_output.hpp"
#include "studies/program/refusal_advice.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

using Start = std::chrono::steady_clock::time_point;  // of the program

// How a command ended.
struct Ending {
  int code = exit_code::done;
  std::string complaint = {};  // the error; empty if there was none
};

Ending carry_out(const CommandLine& line, std::ostream& out) {
  try {
    const int code = line.action(out);
    out.flush();
    return out ? Ending{code}
               : Ending{exit_code::input_output,
                        "standard output could not be written to; any file made is complete"};
  } catch (const StudyError& error) {
    return {exit_code::wrong_input, error.what()};
  } catch (const engine::ResumeRefused& error) {
    const std::string advice = error.advice().empty() ? refusal_advice({}) : error.advice();
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
            fmt::format("the system refuses a thread or another resource: {}", error.what())};
  } catch (const std::exception& error) {
    return {exit_code::internal_error, fmt::format("internal error, please report it: {}", error.what())};
  }
}

// The code of a command line that asks for no command, but for help which may not have been printed.
int without_command(int code, std::ostream& out, std::ostream& complaints) {
  out.flush();
  if (out) return code;
  complaints << "frahm: standard output could not be written to\n";
  return exit_code::input_output;
}

// Runs the program in a single process, or in rank 0.
int lead(engine::Ranks* ranks, Start begun, int argc, const char* const* argv, std::ostream& out) {
  CommandLine line;
  line.run.run.begun = begun;
  line.run.run.ranks = ranks;
  PlainOutput plain(out), complaints(std::cerr);
  if (const auto code = parse_command_line(argc, argv, line, plain, complaints))
    return without_command(*code, plain, complaints);
  const Ending ending = carry_out(line, plain);
  if (!ending.complaint.empty()) complaints << "frahm: " << ending.complaint << '\n';
  return ending.code;
}

// Runs the program in the other ranks: a run is shared, rank 0 does every other command. These ranks print
// nothing; rank 0 reports their errors.
int follow(engine::Ranks& ranks, Start begun, int argc, const char* const* argv) {
  CommandLine line;
  line.run.run.begun = begun;
  line.run.run.ranks = &ranks;
  std::ostringstream unseen;
  if (parse_command_line(argc, argv, line, unseen, unseen) || !line.is_run)
    return engine::wait_for_end(ranks);
  const Ending ending = carry_out(line, unseen);
  return ending.complaint.empty() ? ending.code : engine::tell_failure(ranks, ending.complaint, ending.code);
}

}  // namespace

int run_program(int argc, const char* const* argv, std::ostream& out) {
  const Start begun = std::chrono::steady_clock::now();  // the ranks take time to meet
  const std::unique_ptr<engine::Ranks> ranks = engine::mpi_ranks();
  if (!ranks) return lead(nullptr, begun, argc, argv, out);
  results::keep_checks_here();
  if (ranks->rank() > 0) return follow(*ranks, begun, argc, argv);
  const int code = lead(ranks.get(), begun, argc, argv, out);
  engine::end_all(*ranks, code);
  return code;
}

}  // namespace frahm::studies
