#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "studies/program/listing.hpp"

namespace frahm::studies {

struct CheckOptions {
  std::filesystem::path study;
  std::vector<std::string> set = {};  // name=value, a unit after the value or none
  int threads = 0;                    // for the predicted time; 0: one on each processor
  std::uint64_t max_array = 0;        // tasks that an array of the cluster may have; 0: as Slurm here says
  int simulate_ranks = 0;             // so many ranks of `threads` threads (0: one); 0: no simulation
  bool all = false;                   // every mode, of a large system too

  Listing listing() const { return all ? Listing::whole : Listing::excerpt; }
};

// Validates a study and prints what its run needs: points and tiles, the time and size to expect, the line
// that submits it as an array of tasks, and the linear modes at the first point of the grid. Computes rows of
// the map for about a second (four where a row takes long) to predict the time. Returns 0, or 3 where none of
// them has a response. Throws StudyError for any error in the study.
int check_command(const CheckOptions& options, std::ostream& out);

}  // namespace frahm::studies
