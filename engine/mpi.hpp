#pragma once

#include <memory>
#include <string>

#include "engine/ranks.hpp"

namespace frahm::engine {

// The ranks among which an MPI launcher (mpirun, srun --mpi) has started this process; null without a
// launcher, with one process, or in a build without MPI. Their destructor finalises MPI, in all ranks at
// once. Throws std::runtime_error if MPI lets only the main thread send messages.
std::unique_ptr<Ranks> mpi_ranks();

// "Open MPI 4.1.4"; empty without MPI.
std::string mpi_library();

}  // namespace frahm::engine
