#pragma once

// The exit codes of the program.
namespace frahm::studies::exit_code {

inline constexpr int done = 0;
inline constexpr int internal_error = 1;
inline constexpr int wrong_input = 2;  // usage, or the study
inline constexpr int some_failed = 3;  // finished; the points that failed are listed in the file
inline constexpr int stopped = 4;      // by a signal or the time budget; the same command resumes
inline constexpr int resume_refused = 5;
inline constexpr int input_output = 6;
inline constexpr int not_converged = 7;  // a tuning: its best design so far is in the file

}  // namespace frahm::studies::exit_code
