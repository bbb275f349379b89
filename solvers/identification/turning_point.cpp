#include "solvers/identification/turning_point.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "solvers/identification/linear_fit.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
constexpr Index kMostShapes = 12;
constexpr double kQuarter = 0.5 * std::numbers::pi;

// phi_1 ... phi_degree at s, u = 1 + delta^2: phi_1 = u exp(-delta s) sin s, phi_2 = 1 - exp(-delta s) (cos s
// + delta sin s), and from phi_2'' + 2 delta phi_2' + u phi_2 = u, integrated again and again,
//   phi_k = s^(k-2) / (k-2)! - (2 delta phi_{k-1} + phi_{k-2}) / u.
using Shapes = Eigen::Matrix<double, kMostShapes + 1, 1>;
Shapes shapes_at(double s, double delta, Index degree) {
  const double u = 1.0 + delta * delta, falls = std::exp(-delta * s);
  Shapes phi;
  phi[1] = u * falls * std::sin(s);
  phi[2] = 1.0 - falls * (std::cos(s) + delta * std::sin(s));
  double power = s;
  for (Index k = 3; k <= degree; ++k) {
    phi[k] = power - (2.0 * delta * phi[k - 1] + phi[k - 2]) / u;
    power *= s / static_cast<double>(k - 1);
  }
  return phi;
}

// phi_k is about s^k / k!: over this about one at a quarter period.
double size_of_shape(Index k) {
  return std::pow(kQuarter, k) / std::tgamma(static_cast<double>(k) + 1.0);
}

// dx/ds = a_2 phi_1 + a_3 phi_2 + ..., with the a_k of its side.
double slope_at(const TurningPoint& fit, double s, const Shapes& phi) {
  const Eigen::VectorXd& a = s < 0.0 ? fit.before : fit.after;
  return a.dot(phi.segment(1, a.size()));
}

// The turning point of the parabola through all samples.
TurningPoint parabola(const Quarters& quarters) {
  Eigen::MatrixXd A(quarters.phase.size(), 3);
  A << Eigen::VectorXd::Ones(quarters.phase.size()), quarters.phase, quarters.phase.cwiseAbs2();
  const Eigen::Vector3d p = A.colPivHouseholderQr().solve(quarters.x);
  constexpr double kNear =
      0.5 * kQuarter;  // the turning sample is no further off, regardless of the parabola
  TurningPoint fit;
  fit.phase = p[2] != 0.0 ? std::clamp(-0.5 * p[1] / p[2], -kNear, kNear) : 0.0;
  fit.before = fit.after = Eigen::VectorXd::Constant(1, 2.0 * p[2]);
  return fit;
}

// The terms of both sides, a_2 ... a_common, and those added after the turn, b_2 ... b_jump.
struct Degrees {
  Index common, jump;
  Index unknowns() const { return common + jump; }  // X and the phase of the turn among them

  friend bool operator==(const Degrees&, const Degrees&) = default;
};

// Columns: X, the phase of the turn, the shapes of both sides, those after the turn.
Eigen::MatrixXd columns(const Quarters& quarters, const TurningPoint& fit, Degrees degrees) {
  const Index common = degrees.common - 1, jump = degrees.jump - 1;
  Eigen::VectorXd size(common);
  for (Index k = 0; k < common; ++k) size[k] = size_of_shape(k + 2);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(quarters.phase.size(), degrees.unknowns());
  for (Index i = 0; i < A.rows(); ++i) {
    const double s = quarters.phase[i] - fit.phase;
    const Shapes phi = shapes_at(s, quarters.decrease, std::max<Index>(degrees.common, fit.after.size() + 1));
    A(i, 0) = 1.0;
    A(i, 1) = -slope_at(fit, s, phi);
    A.row(i).segment(2, common) = phi.segment(2, common).cwiseQuotient(size).transpose();
    if (s > 0.0) A.row(i).tail(jump) = A.row(i).segment(2, jump);
  }
  return A;
}

// X, step of the turn's phase, a_k, b_k, of scaled columns.
void take_step(const Eigen::VectorXd& p, Degrees degrees, TurningPoint& fit) {
  const Index common = degrees.common - 1, jump = degrees.jump - 1;
  fit.x = p[0];
  fit.before = fit.after = p.segment(2, common);
  fit.after.head(jump) += p.tail(jump);
  for (Index k = 0; k < common; ++k) {
    fit.before[k] /= size_of_shape(k + 2);
    fit.after[k] /= size_of_shape(k + 2);
  }
  fit.phase += p[1];
}

// Covariance of X and the turn's phase, and Akaike's criterion.
template <class Decomposition>
void set_errors(const Decomposition& qr, Index data, TurningPoint& fit) {
  const Index n = qr.cols();
  const Eigen::MatrixXd inverse =
      qr.matrixR().topLeftCorner(n, n).template triangularView<Eigen::Upper>().solve(
          Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd rows = (qr.colsPermutation() * inverse).topRows(2);
  fit.cofactor = rows * rows.transpose();
  // A jump whose position is fitted counts for noise as three unknowns do, source [28].
  constexpr Index kChosen = 2;
  fit.criterion = corrected_akaike(fit.rss, data, n + kChosen, fit.rounding);
}

// By Gauss and Newton from `start`.
TurningPoint fit_of(const Quarters& quarters, const TurningPoint& start, Degrees degrees) {
  constexpr int kMostSteps = 40;
  constexpr double kSettled = 1e-13, kGood = 1e-7;
  TurningPoint fit = start;
  fit.converged = false;
  fit.unknowns = degrees.unknowns();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::MatrixXd A = columns(quarters, fit, degrees);
    qr.compute(A);
    const Eigen::VectorXd p = qr.solve(quarters.x);
    fit.rss = (quarters.x - A * p).squaredNorm();
    take_step(p, degrees, fit);
    if (!(std::abs(fit.phase) < kQuarter)) return fit;
    fit.converged = std::abs(p[1]) < kGood;
    if (std::abs(p[1]) < kSettled) break;
  }
  // Both sides of a maximum lie below it.
  fit.converged = fit.converged && qr.rank() == qr.cols() && !(fit.before[0] * fit.after[0] < 0.0);
  if (fit.converged) set_errors(qr, quarters.phase.size(), fit);
  return fit;
}

}  // namespace

TurningPoint turning_point(const Quarters& quarters) {
  constexpr Index kLeastOfSide = 2, kLeastPoints = 6;
  constexpr double kEpsilon = 4.0 * std::numeric_limits<double>::epsilon();
  const Index n = quarters.phase.size();
  if (n < kLeastPoints) return {};
  TurningPoint start = parabola(quarters);
  start.rounding = kEpsilon * quarters.x.cwiseAbs().maxCoeff();
  const Index before = (quarters.phase.array() < start.phase).count();
  if (std::min(before, n - before) < kLeastOfSide) return {};
  // One less of few samples.
  constexpr Degrees kOfFew{3, 2}, kLeast{4, 2};
  const Degrees first = n > kLeast.unknowns() + 1 ? kLeast : kOfFew;
  TurningPoint best = fit_of(quarters, start, first);
  // The degree goes up by two: an odd power does not find what an even one misses. The first degree that does
  // not predict better ends the search: one of many would fit the noise by chance.
  for (Index degree = 4; best.converged && degree <= kMostShapes; degree += 2) {
    const TurningPoint last = best;
    for (const Index jump : std::set<Index>{2, 4, degree}) {
      const Degrees degrees{degree, jump};
      // Repeating the first fit would be better or worse by rounding alone.
      if (degrees == first || n <= degrees.unknowns()) continue;
      const TurningPoint fit = fit_of(quarters, last, degrees);
      if (fit.converged && fit.criterion < best.criterion) best = fit;
    }
    if (!(best.criterion < last.criterion)) break;
  }
  return best;
}

}  // namespace frahm::identification
