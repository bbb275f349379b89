#include "solvers/orbits/rest_position.hpp"

#include <cmath>

#include "solvers/events/box_minimum.hpp"
#include "solvers/flow/constraints.hpp"

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kInside = 0.5 * kGrazing;  // of the size of a force

// lower <= A delta <= upper, an entry each, of forces with these limits. The size of a force is its limit, or
// more where kInside of the limit is less than what the forces are rounded by.
struct Bounds {
  MatrixXd A;
  VectorXd lower, upper, limit, size;

  double room(const VectorXd& delta) const {  // the least, of the sizes; negative where a limit is broken
    const VectorXd change = A * delta;
    return ((change - lower).cwiseMin(upper - change).array() / size.array()).minCoeff();
  }
};

Bounds bounds_of(std::span<const StuckForce> forces, Index contacts) {
  constexpr double kRounding = 1e-14;  // of the largest force
  const auto m = static_cast<Index>(forces.size());
  Bounds bounds{MatrixXd(m, contacts), VectorXd(m), VectorXd(m), VectorXd(m), VectorXd(m)};
  double largest = 0.0;
  for (const StuckForce& force : forces) largest = std::max({largest, force.most, -force.least});
  for (Index i = 0; i < m; ++i) {
    const StuckForce& force = forces[static_cast<std::size_t>(i)];
    bounds.A.row(i) = force.shares.transpose();
    bounds.lower[i] = -force.limit - force.least;
    bounds.upper[i] = force.limit - force.most;
    bounds.limit[i] = force.limit;
    bounds.size[i] = std::max(force.limit, kRounding * largest / kInside);
  }
  return bounds;
}

// A force that swings from limit to limit, to what counts as grazing, rests in the middle; false where one
// swings further.
bool close(Bounds& bounds) {
  for (Index i = 0; i < bounds.limit.size(); ++i) {
    double& lower = bounds.lower[i];
    double& upper = bounds.upper[i];
    if (lower > upper + kGrazing * bounds.size[i]) return false;
    if (lower > upper) lower = upper = 0.5 * (lower + upper);
  }
  return true;
}

// Forces that stay inside their limits by this much, where they can, let no contact slip by rounding.
void keep_from_slipping(Bounds& bounds, std::span<const StuckForce> forces, bool all) {
  for (Index i = 0; i < bounds.limit.size(); ++i) {
    if (!all && !forces[static_cast<std::size_t>(i)].stays_inside) continue;
    const double by = std::min(kInside * bounds.size[i], 0.5 * (bounds.upper[i] - bounds.lower[i]));
    bounds.lower[i] += by;
    bounds.upper[i] -= by;
  }
}

// The minimum where forces are shared, by its dual: the mu >= 0 that minimises
//   1/2 mu^T B G^+ B^T mu - mu^T (B G^+ c - b),   B = (A, -A),  b = (upper, -lower),
// leads to delta = G^+ (c - B^T mu) (Nocedal and Wright, Numerical Optimization, 2006, 12.9).
VectorXd shared_minimum(const MatrixXd& G, const VectorXd& c, const Bounds& bounds) {
  const Index m = bounds.limit.size();
  const MatrixXd inverse = weighted_pseudo_inverse(G, VectorXd::Ones(G.rows()));
  // Each row in the size of its own energy: limits may be orders of magnitude apart.
  const VectorXd size = (bounds.A * inverse * bounds.A.transpose()).diagonal().cwiseSqrt().cwiseInverse();
  MatrixXd B(2 * m, G.cols());
  B << size.asDiagonal() * bounds.A, size.asDiagonal() * -bounds.A;
  VectorXd b(2 * m);
  b << size.cwiseProduct(bounds.upper), -size.cwiseProduct(bounds.lower);
  const VectorXd ones = VectorXd::Ones(2 * m);
  const BoxMinimum dual =
      box_minimum(B * inverse * B.transpose(), B * (inverse * c) - b, 0.0 * ones, HUGE_VAL * ones, ones);
  return inverse * (c - B.transpose() * dual.lambda);
}

}  // namespace

RestShift least_energy_shift(const RestDirections& rest, const VectorXd& z_mean,
                             std::span<const StuckForce> forces) {
  constexpr double kBroken = -1e-9;  // of the size of a force
  Bounds bounds = bounds_of(forces, rest.balanced.rows() > 0 ? rest.balanced.rows() : rest.E.cols());
  if (!close(bounds)) return {};
  if (rest.balanced.rows() > 0) bounds.A = (bounds.A * rest.balanced).eval();
  const MatrixXd G = rest.L.transpose() * rest.E;
  const VectorXd c = -(rest.L.transpose() * z_mean);
  RestShift shift;
  if (rest.E.cols() == 0) {
    shift.delta.resize(0);
    if (bounds.room(shift.delta) < kBroken) return {};
  } else if (bounds.A.isIdentity(0.0)) {
    keep_from_slipping(bounds, forces, false);
    const BoxMinimum minimum = box_minimum(G, c, bounds.lower, bounds.upper, bounds.limit);
    if (!minimum.found) return {};
    shift.delta = minimum.lambda;
  } else {
    keep_from_slipping(bounds, forces, true);
    shift.delta = shared_minimum(G, c, bounds);
    if (!shift.delta.allFinite() || bounds.room(shift.delta) < kBroken) return {};
  }
  shift.verdict =
      bounds.room(shift.delta) <= kGrazing ? RestShift::Verdict::at_limit : RestShift::Verdict::inside;
  return shift;
}

// By the dual, as shared_minimum: limits of the largest and the least force are different rows here.
RestShift least_energy_step(const RestFamily& family) {
  const Index m = family.limit.size();
  const VectorXd inside = (1.0 - kInside) * family.limit;
  MatrixXd B(2 * m, m);
  B << family.of_most, -family.of_least;
  VectorXd b(2 * m);
  b << inside - family.most, inside + family.least;
  const MatrixXd G = family.of_mean.transpose() * family.energy_of_mean;
  const VectorXd c = -(family.energy_of_mean.transpose() * family.mean);
  const MatrixXd inverse = weighted_pseudo_inverse(G, VectorXd::Ones(m));
  const VectorXd size = (B * inverse * B.transpose()).diagonal().cwiseSqrt().cwiseInverse();
  B = (size.asDiagonal() * B).eval();
  b = (size.asDiagonal() * b).eval();
  const VectorXd ones = VectorXd::Ones(2 * m);
  RestShift shift;
  if (!B.allFinite() || !b.allFinite()) return shift;
  const BoxMinimum dual =
      box_minimum(B * inverse * B.transpose(), B * (inverse * c) - b, 0.0 * ones, HUGE_VAL * ones, ones);
  shift.delta = inverse * (c - B.transpose() * dual.lambda);
  if (!dual.found || !shift.delta.allFinite()) return shift;
  shift.verdict = dual.lambda.maxCoeff() > 0.0 ? RestShift::Verdict::at_limit : RestShift::Verdict::inside;
  return shift;
}

RestShift middle_shift(std::span<const StuckForce> forces) {
  RestShift shift;
  if (forces.empty()) return shift;
  const Bounds bounds = bounds_of(forces, forces.front().shares.size());
  if (!bounds.A.isIdentity(0.0)) return shift;
  shift.delta = 0.5 * (bounds.lower + bounds.upper);
  if (bounds.room(shift.delta) > kGrazing) shift.verdict = RestShift::Verdict::inside;
  return shift;
}

}  // namespace frahm::periodic
