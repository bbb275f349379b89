#pragma once

#include <cstddef>
#include <span>

#include "solvers/nonstop/pack.hpp"

// Orbits from the phases of their events, kLanes points at once.
namespace frahm::periodic::nonstop {

// Solves a pack. workspace: of workspace_size() doubles, aligned as kLanes doubles.
using Solve = void(const Pack& pack, double* workspace);

// One source, compiled for several instruction sets; all give the same bytes.
struct Kernel {
  const char* name;  // "x86-64-v3"
  bool runs_here;
  Solve* solve;
};

std::span<const Kernel> kernels();  // the fastest last
const Kernel& fastest_kernel();     // that runs here

// Points with more reversals, or that take more steps, are not solved.
inline constexpr int kMostReversals = 32;
// For all segments of the span together: for a system of so many contacts.
constexpr int most_steps(int contacts) {
  const int steps = 64 * contacts;
  return steps < 256 ? 256 : steps > 1024 ? 1024 : steps;
}

std::size_t workspace_size(const Shape& shape);

}  // namespace frahm::periodic::nonstop
