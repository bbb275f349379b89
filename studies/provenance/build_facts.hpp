#pragma once

#include <string>
#include <vector>

namespace frahm::studies {

// How this program was built: for `--version` and for the provenance of results.
struct BuildFacts {
  std::string version;                 // "0.1.0"
  std::string commit;                  // of the sources at configure time, "-dirty" if they had been changed
  std::string compiler;                // "GNU 12.2.0"
  std::string flags;                   // "-O3 -DNDEBUG -march=x86-64-v3"
  std::vector<std::string> libraries;  // "Eigen 3.4.0", ...
};
BuildFacts build_facts();

}  // namespace frahm::studies
