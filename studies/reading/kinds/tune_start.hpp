#pragma once

#include "solvers/tuning/problem/solver.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/study/study.hpp"

// What a tuning starts from, and the solver that suits it.
namespace frahm::studies {

// The keys "start" and "global".
void read_start(const TomlSection& section, TuneChoice& choice);

// The key "solver" of a tuning over a band, and whether its start suits it, once its designs are known.
tuning::SolverKind read_solver(const TomlSection& section, const TuneChoice& choice);
void check_map(const TuneReading& reading, const TomlSection& section);

}  // namespace frahm::studies
