#pragma once

#include <memory>
#include <string>

#include "engine/ranks.hpp"

namespace frahm::engine {

// The ranks among which an MPI launcher (mpirun, srun --mpi) has started this process; null if none has, if
// it is the only one, or if the program was built without MPI. MPI ends with them, in all ranks at once.
// Throws std::runtime_error if MPI does not let one thread after the other send messages.
std::unique_ptr<Ranks> mpi_ranks();

// "Open MPI 4.1.4"; empty without MPI.
std::string mpi_library();

}  // namespace frahm::engine
