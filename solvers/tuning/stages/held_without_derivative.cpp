#include "solvers/tuning/stages/held_without_derivative.hpp"

#include <cstdio>

namespace frahm::tuning {
namespace {

constexpr double kAtWorst = 1.0 - 1e-6;  // of the worst peak or a limit

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

std::string held_without_derivative(const Scan& scan, const std::vector<CurveKind>& curves) {
  const auto holds = [&](std::size_t curve, double value) {
    const CurveKind& kind = curves[curve];
    return value >= kAtWorst * (kind.of == CurveKind::Of::objective ? scan.worst : kind.most());
  };
  for (std::size_t c = 0; c < scan.tightest.size(); ++c) {
    const Scan::Extreme& highest = scan.tightest[c];
    if (!highest.periodic && holds(c, highest.value))
      return "at " + number(highest.at) +
             " of the band no stable periodic response was found; the worst of the motion there holds the "
             "design and has no derivative";
  }
  for (const Scan::Maximum& maximum : scan.maxima) {
    if (maximum.is_end && holds(maximum.curve, maximum.value))
      return "the stable branch that holds the design ends at " + number(maximum.at) +
             " of the band, and the derivatives there do not give the motion of its end";
  }
  return "";
}

}  // namespace frahm::tuning
