#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "solvers/tuning/optimum.hpp"

namespace frahm::tuning {

// The ends of the front of a task with a trade-off, each a tuning of its own from that start.
FrontEnds front_ends(const Task& task, std::size_t start, const std::function<bool()>& stop_asked);

// For a front: a problem whose optimum another, under no higher limit, undercuts, and that other; its design
// is a better start. Nothing where there is none.
struct Undercut {
  std::size_t problem = 0, by = 0;
};
std::vector<Undercut> undercut(const std::vector<Optimum>& optima);

}  // namespace frahm::tuning
