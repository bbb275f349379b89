#include "solvers/quantities/trace.hpp"

#include <algorithm>

namespace frahm::periodic {

bool operator==(const Trace& a, const Trace& b) {
  const auto same = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
    return x.size() == y.size() && x == y;
  };
  return a.kind == b.kind && same(a.at.w, b.at.w) && same(a.at.p, b.at.p) && same(a.at.j, b.at.j) &&
         a.element == b.element && a.node == b.node;
}

std::size_t place_of(Trace trace, std::vector<Trace>& traces) {
  const auto found = std::find(traces.begin(), traces.end(), trace);
  const auto index = static_cast<std::size_t>(found - traces.begin());
  if (found == traces.end()) traces.push_back(std::move(trace));
  return index;
}

}  // namespace frahm::periodic
