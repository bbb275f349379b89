#include "solvers/quantities/trace.hpp"

#include <algorithm>

namespace frahm::periodic {

bool operator==(const Trace& a, const Trace& b) {
  const auto same = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
    return x.size() == y.size() && x == y;
  };
  return a.measure == b.measure && same(a.at.w, b.at.w) && same(a.at.p, b.at.p) && a.element == b.element &&
         a.node == b.node;
}

mechanics::Incidence mass_incidence(const mechanics::Network& network, std::size_t mass) {
  return {Eigen::VectorXd::Unit(static_cast<Eigen::Index>(network.masses.size()),
                                static_cast<Eigen::Index>(mass)),
          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.prescribed.size()))};
}

std::optional<Trace> trace_of(const Quantity& quantity, const mechanics::Assembly& assembly) {
  switch (quantity.measure) {
    case Measure::amplitude:
    case Measure::peak:
    case Measure::peak_phase:
    case Measure::phase:
      return Trace{.at = mass_incidence(assembly.network(), quantity.index)};
    case Measure::velocity_peak:
    case Measure::acceleration_peak:
      return Trace{.measure = quantity.measure, .at = mass_incidence(assembly.network(), quantity.index)};
    case Measure::stroke:
    case Measure::element_phase:
      return Trace{.at = assembly.incidences()[quantity.index]};
    case Measure::force_peak:
      return Trace{.measure = quantity.measure, .element = quantity.index};
    case Measure::transmitted_force: {
      Trace trace{.measure = quantity.measure};
      if (quantity.index > 0) trace.node = {mechanics::NodeKind::prescribed, quantity.index - 1};
      return trace;
    }
    default:
      return std::nullopt;
  }
}

std::size_t place_of(Trace trace, std::vector<Trace>& traces) {
  const auto found = std::find(traces.begin(), traces.end(), trace);
  const auto place = static_cast<std::size_t>(found - traces.begin());
  if (found == traces.end()) traces.push_back(std::move(trace));
  return place;
}

}  // namespace frahm::periodic
