#include "solvers/identification/decay_extrema.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/identification/linear_fit.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
using Samples = std::span<const double>;

std::string wrong(Samples time, Samples displacement) {
  const std::string bad =
      first_of({unless_equal("time and displacement", {time.size(), displacement.size()}),
                unless_finite("time", time), unless_finite("displacement", displacement)});
  if (!bad.empty()) return bad;
  if (time.size() < kLeastSamples)
    return "the record has " + std::to_string(time.size()) + " samples, it takes " +
           std::to_string(kLeastSamples) + " at least";
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (!(time[i] > time[i - 1]))
      return "time " + std::to_string(i + 1) + " is " + number(time[i]) + " s after " + number(time[i - 1]) +
             " s: times must increase";
  }
  return "";
}

// How far sample i is from the polynomial through its three neighbours on either side, over what noise of 1
// in each of the seven would make of it.
double off_neighbours(Samples time, Samples x, std::size_t i) {
  double passes = 0.0, squares = 1.0;
  for (std::size_t j = i - 3; j <= i + 3; ++j) {
    if (j == i) continue;
    double lagrange = 1.0;
    for (std::size_t k = i - 3; k <= i + 3; ++k) {
      if (k != i && k != j) lagrange *= (time[i] - time[k]) / (time[j] - time[k]);
    }
    passes += lagrange * x[j];
    squares += lagrange * lagrange;
  }
  return std::abs(x[i] - passes) / std::sqrt(squares);
}

// Standard deviation of white noise: of the median, which the few samples about a stop do not disturb.
double noise_of(Samples time, Samples x) {
  constexpr double kMedian = 0.6744897501960817;  // of |noise| / sigma of a normal distribution
  std::vector<double> off;
  for (std::size_t i = 3; i + 3 < x.size(); ++i) off.push_back(off_neighbours(time, x, i));
  std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
  return off[off.size() / 2] / kMedian;
}

// The samples at which the trace turns by more than `swing` after having swung by more than it.
// A first sample may be among them, and the end of the last swing is not.
std::vector<std::size_t> turns(Samples x, double swing) {
  std::vector<std::size_t> found;
  std::size_t top = 0, bottom = 0;
  int direction = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] > x[top]) top = i;
    if (x[i] < x[bottom]) bottom = i;
    if (direction >= 0 && x[top] - x[i] > swing) {
      found.push_back(top);
      direction = -1;
      bottom = i;
    } else if (direction <= 0 && x[i] - x[bottom] > swing) {
      found.push_back(bottom);
      direction = 1;
      top = i;
    }
  }
  return found;
}

// The samples about one turning point, in quarter periods of about 1.
struct Quarter {
  double at = 0.0, length = 0.0;  // [s] the turning sample, a quarter period
  Eigen::VectorXd tau, x;         // (t - at) / length, [m]
};

struct TurnFit {
  double tau = 0.0, x = 0.0;         // the turning point
  double rss = 0.0, rounding = 0.0;  // [m^2], [m]
  Eigen::Matrix2d cofactor;          // of x and tau, for samples of variance 1
  double criterion = std::numeric_limits<double>::infinity();
  Eigen::VectorXd before, after;  // a_2, a_3 ... of the two sides
  Index common = 0, jump = 0, unknowns = 0;
  bool converged = false;
};

// x - X and its slope, at s from the turning point, with a_2, a_3, ... of its side.
double slope_at(const TurnFit& fit, double s) {
  const Eigen::VectorXd& a = s < 0.0 ? fit.before : fit.after;
  double sum = 0.0;
  for (Index k = a.size() - 1; k >= 0; --k) sum = sum * s + static_cast<double>(k + 2) * a[k];
  return sum * s;
}

// Where and how the parabola of all samples turns.
TurnFit parabola(const Quarter& quarter) {
  Eigen::MatrixXd A(quarter.tau.size(), 3);
  A << Eigen::VectorXd::Ones(quarter.tau.size()), quarter.tau, quarter.tau.cwiseAbs2();
  const Eigen::Vector3d p = A.colPivHouseholderQr().solve(quarter.x);
  constexpr double kNear = 0.5;  // the turning sample is no further off, whatever the parabola says
  TurnFit fit;
  fit.tau = p[2] != 0.0 ? std::clamp(-0.5 * p[1] / p[2], -kNear, kNear) : 0.0;
  fit.before = fit.after = Eigen::VectorXd::Constant(1, p[2]);
  return fit;
}

// What the two sides have in common, x = X + a_2 s^2 + ... + a_degree s^degree, s = tau - turn, and what
// comes to it behind the turn, b_2 s^2 + ... + b_jump s^jump: friction pulls the other way there. jump 1:
// nothing.
struct Degrees {
  Index common, jump;
  Index unknowns() const { return common + jump; }  // X and the turn's place among them
};

// By Gauss and Newton from `start`.
TurnFit fit_of(const Quarter& quarter, const TurnFit& start, Degrees degrees) {
  constexpr int kMostSteps = 40;
  constexpr double kSettled = 1e-13, kGood = 1e-7;
  const Index n = quarter.tau.size(), common = degrees.common - 1, jump = degrees.jump - 1;
  TurnFit fit = start;
  fit.converged = false;
  fit.common = degrees.common;
  fit.jump = degrees.jump;
  fit.unknowns = degrees.unknowns();
  Eigen::MatrixXd A(n, fit.unknowns);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  for (int step = 0; step < kMostSteps; ++step) {
    A.setZero();
    for (Index i = 0; i < n; ++i) {
      const double s = quarter.tau[i] - fit.tau;
      A(i, 0) = 1.0;
      A(i, 1) = -slope_at(fit, s);
      double power = s * s;
      for (Index k = 0; k < common; ++k, power *= s) {
        A(i, 2 + k) = power;
        if (s > 0.0 && k < jump) A(i, 2 + common + k) = power;
      }
    }
    qr.compute(A);
    const Eigen::VectorXd p = qr.solve(quarter.x);
    fit.rss = (quarter.x - A * p).squaredNorm();
    fit.x = p[0];
    fit.before = fit.after = p.segment(2, common);
    fit.after.head(jump) += p.tail(jump);
    fit.tau += p[1];
    if (!(std::abs(fit.tau) < 1.0)) return fit;
    fit.converged = std::abs(p[1]) < kGood;
    if (std::abs(p[1]) < kSettled) break;
  }
  // Both sides of a maximum lie below it.
  fit.converged = fit.converged && qr.rank() == A.cols() && !(fit.before[0] * fit.after[0] < 0.0);
  if (!fit.converged) return fit;
  const Eigen::MatrixXd inverse = qr.matrixR()
                                      .topLeftCorner(A.cols(), A.cols())
                                      .triangularView<Eigen::Upper>()
                                      .solve(Eigen::MatrixXd::Identity(A.cols(), A.cols()));
  const Eigen::MatrixXd rows = (qr.colsPermutation() * inverse).topRows(2);
  fit.cofactor = rows * rows.transpose();
  // A jump that may choose its place fits noise as three unknowns do, source [28].
  const Index chosen = degrees.jump > 1 ? 2 : 0;
  fit.criterion = corrected_akaike(fit.rss, n, A.cols() + chosen, fit.rounding);
  return fit;
}

// The best of one common degree: without a jump, with one of the acceleration, of two more derivatives, of
// all.
TurnFit best_of_degree(const Quarter& quarter, const TurnFit& start, Index degree) {
  TurnFit best;
  for (const Index jump : {Index{1}, Index{2}, Index{4}, degree}) {
    const Degrees degrees{degree, jump};
    if (jump > degree || quarter.tau.size() <= degrees.unknowns()) continue;
    const TurnFit fit = fit_of(quarter, best.converged ? best : start, degrees);
    if (fit.converged && (!best.converged || fit.criterion < best.criterion)) best = fit;
  }
  return best;
}

// A jump too small to be seen still moves the turn of the polynomial that does without: the time, not the
// extreme, which is stationary. So the time and its error are those of the fit with the jump.
void take_time_with_jump(const Quarter& quarter, TurnFit& fit) {
  const TurnFit timed = fit_of(quarter, fit, {fit.common, 2});
  if (!timed.converged) return;
  fit.tau = timed.tau;
  fit.cofactor(1, 1) = timed.cofactor(1, 1);
}

// The degree goes up by two: what an even power misses an odd one does not find.
TurnFit best_fit(const Quarter& quarter) {
  constexpr Index kHighestDegree = 12, kLeastOfSide = 2;
  constexpr double kEpsilon = 4.0 * std::numeric_limits<double>::epsilon();
  TurnFit start = parabola(quarter), best;
  start.rounding = kEpsilon * quarter.x.cwiseAbs().maxCoeff();
  const Index before = (quarter.tau.array() < start.tau).count();
  if (std::min(before, quarter.tau.size() - before) < kLeastOfSide) return best;
  for (Index degree = 2; degree <= kHighestDegree; degree += 2) {
    const TurnFit fit = best_of_degree(quarter, start, degree);
    // Over a quarter period s^4 is always there, a tenth and more of s^2. Beyond it the first degree that
    // does not predict better ends it: one of many would fit the noise by chance.
    const bool better = degree <= 4 || fit.criterion < best.criterion;
    if (!fit.converged || !better) break;
    start = best = fit;
  }
  if (best.converged && best.jump < 2) take_time_with_jump(quarter, best);
  return best;
}

// The samples within half the way to the neighbours of turn k; empty where less than half of a side is there.
Quarter quarter_of(Samples time, Samples x, const std::vector<std::size_t>& turns, std::size_t k) {
  const double at = time[turns[k]];
  const double before = k > 0 ? at - time[turns[k - 1]] : time[turns[k + 1]] - at;
  const double after = k + 1 < turns.size() ? time[turns[k + 1]] - at : before;
  const double from = at - 0.5 * before, to = at + 0.5 * after;
  Quarter quarter{at, 0.25 * (before + after), {}, {}};
  if (at - time.front() < 0.25 * before || time.back() - at < 0.25 * after) return quarter;
  const auto first =
      static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), from) - time.begin());
  const auto end = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), to) - time.begin());
  const auto n = static_cast<Index>(end - first);
  quarter.tau = (Eigen::Map<const Eigen::VectorXd>(&time[first], n).array() - at) / quarter.length;
  quarter.x = Eigen::Map<const Eigen::VectorXd>(&x[first], n);
  return quarter;
}

FoundExtrema none(std::string why) {
  FoundExtrema found;
  found.failure = std::move(why);
  return found;
}

struct Turn {
  double length;  // [s]
  TurnFit fit;
  double at;  // [s]
};

// Standard errors: every sample has the noise that all the fits together leave.
void set_errors(const std::vector<Turn>& fitted, double rss, double degrees_of_freedom, FoundExtrema& found) {
  found.extrema.degrees_of_freedom = degrees_of_freedom;
  found.noise = degrees_of_freedom > 0.0 ? std::sqrt(rss / degrees_of_freedom) : 0.0;
  for (const Turn& turn : fitted) {
    found.extrema.time.push_back(turn.at + turn.length * turn.fit.tau);
    found.extrema.displacement.push_back(turn.fit.x);
    if (!(degrees_of_freedom > 0.0)) continue;
    const double sigma = std::max(found.noise, turn.fit.rounding);
    found.extrema.displacement_sigma.push_back(sigma * std::sqrt(turn.fit.cofactor(0, 0)));
    found.extrema.time_sigma.push_back(sigma * std::sqrt(turn.fit.cofactor(1, 1)) * turn.length);
  }
}

}  // namespace

FoundExtrema find_extrema(Samples time, Samples displacement) {
  if (const std::string why = wrong(time, displacement); !why.empty()) return none(why);
  // A swing of ten standard deviations is no accident in a million samples, and twice that turns at a place
  // that the samples show; a billionth of the whole is rounding.
  constexpr double kAboveNoise = 20.0, kAboveRounding = 1e-9;
  const auto [least, most] = std::minmax_element(displacement.begin(), displacement.end());
  const double swing =
      std::max(kAboveNoise * noise_of(time, displacement), kAboveRounding * (*most - *least));
  const std::vector<std::size_t> turned = turns(displacement, swing);
  if (turned.size() < 2)
    return none("the record turns " + std::to_string(turned.size()) + " times by more than the noise, " +
                number(swing) + " m: it takes two turning points at least");
  FoundExtrema found;
  std::vector<Turn> fitted;
  double rss = 0.0, degrees_of_freedom = 0.0;
  for (std::size_t k = 0; k < turned.size(); ++k) {
    const Quarter quarter = quarter_of(time, displacement, turned, k);
    const TurnFit fit = quarter.tau.size() > 0 ? best_fit(quarter) : TurnFit{};
    // A gap would break the turn from maximum to minimum: only the first and the last may be missing.
    if (!fit.converged && !fitted.empty()) break;
    if (!fit.converged) continue;
    fitted.push_back({quarter.length, fit, quarter.at});
    rss += fit.rss;
    degrees_of_freedom += static_cast<double>(quarter.tau.size() - fit.unknowns);
  }
  if (fitted.size() < 2)
    return none("only " + std::to_string(fitted.size()) + " of " + std::to_string(turned.size()) +
                " turning points have samples enough about them: it takes five at least, two on either side");
  set_errors(fitted, rss, degrees_of_freedom, found);
  const std::size_t left_out = turned.size() - fitted.size();
  if (left_out > 0)
    found.notes.push_back(
        std::to_string(left_out) + " of " + std::to_string(turned.size()) +
        " turning points lie at the ends of the record or have too few samples, and are left out");
  return found;
}

}  // namespace frahm::identification
