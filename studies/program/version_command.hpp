#pragma once

#include <iosfwd>

namespace frahm::studies {

// Prints name and version; verbose: commit, compiler, flags, libraries, threads and whether this CPU has the
// instructions of the build. Returns 0.
int version_command(bool verbose, std::ostream& out);

}  // namespace frahm::studies
