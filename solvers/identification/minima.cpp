#include "solvers/identification/minima.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "solvers/algebra/singular_values.hpp"
#include "solvers/mechanics/element_table.hpp"

namespace frahm::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd, Eigen::VectorXd;

// Length of each record in a first fit [periods]: long enough to determine a frequency, and short enough that
// a frequency a quarter off slips no more than half a period. If that fails, as with friction that stops the
// model long before the measured motion, only the length in which the model still moves.
constexpr double kFirstPeriods[] = {2.0, 0.25};
// A fit that misses more than this part of the measured variation has failed.
constexpr double kNowhere = 0.5;
// A fit that misses less than this has no better fit next to it.
constexpr double kExactly = 1e-9;
constexpr LeastSquaresOptions kOnTheWay = {.tolerance = 1e-6, .most_evaluations = 50};
constexpr double kLower = 1e-6;  // another minimum counts as lower if its sum of squares is this share less

std::vector<Unknown> started_at(const VectorXd& p, std::vector<Unknown> unknowns) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) unknowns[i].start = p[static_cast<Index>(i)];
  return unknowns;
}

// The direction, of length 1 in units of p, in which the residuals at the fit change least.
VectorXd least_determined(const LeastSquaresFit& fit, const VectorXd& scales) {
  return scales.cwiseProduct(algebra::singular_values(fit.jacobian * scales.asDiagonal()).V.rightCols<1>());
}

// Whether a descent came to an answer: from some starts the model cannot be computed.
bool has_answer(const LeastSquaresFit& fit) {
  return fit.p.size() > 0 && fit.p.allFinite() && fit.jacobian.size() > 0;
}

}  // namespace

Minima::Minima(const GreyBoxTask& task, Misfit& misfit, int& iterations)
    : task_(task),
      misfit_(misfit),
      iterations_(iterations),
      residuals_([&misfit](const VectorXd& p, VectorXd& r, MatrixXd* by) { return misfit(p, r, by); }),
      switches_(std::ranges::any_of(task.network.elements,
                                    [](const mechanics::Element& each) {
                                      return mechanics::has_contact(each) || !each.bends.empty();
                                    })),
      free_(std::ranges::any_of(
          task.records, [](const TimeRecord& record) { return record.motion == MotionKind::free; })) {}

LeastSquaresFit Minima::descend(const VectorXd& p, const LeastSquaresOptions& options) {
  LeastSquaresFit fit = least_squares(started_at(p, misfit_.unknowns()), residuals_, options);
  iterations_ += fit.iterations;
  return fit;
}

LeastSquaresFit Minima::from(const VectorXd& p) {
  return descend(p, {});
}

// Whether a fit misses more than this share of the measured variation, with the weights of a first fit.
bool Minima::misses(const LeastSquaresFit& fit, double share) const {
  return !(fit.sum_of_squares() <= share * share * static_cast<double>(misfit_.series()));
}

// Keeps the fit with the lower sum of squares; if they are equal, the converged one.
void Minima::take(LeastSquaresFit fit, LeastSquaresFit& best) {
  if (!has_answer(fit)) return;
  const double sum = fit.sum_of_squares(), least = best.sum_of_squares();
  const bool lower = sum < (1.0 - kLower) * least;
  const bool alike = sum <= (1.0 + kLower) * least && fit.converged && !best.converged;
  if (best.jacobian.size() == 0 || lower || alike) best = std::move(fit);
}

// First the records' beginnings, twice as much of them each time, then all. Starts from the start itself if
// that is nearer than the result of growing.
LeastSquaresFit Minima::grown(const VectorXd& start, double periods) {
  VectorXd p = start, r, grown_r;
  for (double seconds = periods * misfit_.longest_period(start); misfit_.follow(seconds); seconds *= 2.0) {
    const LeastSquaresFit fit = descend(p, kOnTheWay);
    if (fit.p.size() == 0 || !fit.p.allFinite()) break;
    p = fit.p;
  }
  misfit_.follow_all();
  const bool is_nearer = residuals_(p, grown_r, nullptr) &&
                         (!residuals_(start, r, nullptr) || grown_r.squaredNorm() < r.squaredNorm());
  if (!is_nearer) p = start;
  return descend(p, kOnTheWay);
}

void Minima::search(const VectorXd& start, LeastSquaresFit& best) {
  if (!task_.grow) return take(descend(start, kOnTheWay), best);
  for (const double periods : kFirstPeriods) {
    take(grown(start, periods), best);
    // Growing may lead away from a start that is right.
    if (periods == kFirstPeriods[0] && misses(best, kExactly)) take(descend(start, kOnTheWay), best);
    if (best.jacobian.size() > 0 && !misses(best, kNowhere)) return;
  }
}

// Halves the friction until the model moves as the data do; the other values are those of the start.
void Minima::loosen(LeastSquaresFit& best) {
  constexpr int kMostHalvings = 8;
  VectorXd p = misfit_.start();
  const std::vector<Index> frictions = misfit_.frictions(p);
  for (const Index i : frictions) p[i] = std::max(std::abs(p[i]), std::abs(best.p[i]));
  for (int halving = 0; halving < kMostHalvings && !frictions.empty(); ++halving) {
    for (const Index i : frictions) p[i] *= 0.5;
    if (!misfit_.moves(p)) continue;
    search(p, best);
    if (!misses(best, kNowhere)) return;
  }
}

LeastSquaresFit Minima::from_start() {
  LeastSquaresFit best;
  search(misfit_.start(), best);
  const bool found = best.jacobian.size() > 0;
  if (switches_ && found && misses(best, kNowhere)) loosen(best);
  LeastSquaresFit fit = from(found ? best.p : misfit_.start());
  exact_ = fit.p.size() > 0 && !misses(fit, kExactly);
  return beside(std::move(fit));
}

// Starts for a half swing more or fewer before rest, for one half of that, and for two: the friction is
// changed accordingly, alone and together with the other unknowns as they follow it. Then both ways along the
// least determined direction; and without the static forces, below which nothing may stick.
std::vector<VectorXd> Minima::starts_beside(const LeastSquaresFit& fit) {
  constexpr double kSwings[] = {-2.0, -1.0, -0.5, 0.5, 1.0, 2.0};
  constexpr double kLengths[] = {-0.6, 0.6, -0.2, 0.2};
  const std::vector<Unknown>& unknowns = misfit_.unknowns();
  VectorXd scales(fit.p.size());
  for (Index i = 0; i < scales.size(); ++i)
    scales[i] = std::max(std::abs(fit.p[i]), unknowns[static_cast<std::size_t>(i)].scale);
  std::vector<VectorXd> starts;
  const MatrixXd spread = covariance(fit.jacobian, 1.0, scales);
  const double swings = std::clamp(static_cast<double>(misfit_.turns(fit.p)), 3.0, 30.0);
  for (const Index i : free_ ? misfit_.frictions(fit.p) : std::vector<Index>{}) {
    for (const double by : kSwings) {
      VectorXd moved = fit.p, following = fit.p;
      moved[i] *= 1.0 + by / swings;
      following += (by / swings * fit.p[i] / spread(i, i)) * spread.col(i);
      starts.push_back(moved);
      if (following.allFinite() && spread(i, i) > 0.0) starts.push_back(following);
    }
  }
  const VectorXd direction = least_determined(fit, scales);
  for (const double length : std::span(kLengths).first(free_ ? 4 : 2))
    starts.push_back(fit.p + length * direction);
  for (const VectorXd& p : misfit_.without_static_forces(fit.p)) starts.push_back(p);
  for (VectorXd& p : starts) {
    for (Index i = 0; i < p.size(); ++i) {
      const Unknown& unknown = unknowns[static_cast<std::size_t>(i)];
      p[i] = std::clamp(p[i], unknown.lower, unknown.upper);
    }
  }
  return starts;
}

// A separate minimum is one that the parabola about this fit does not explain: by |J d|^2 it would be far
// above the fit, and is not. s^2: the variance of a residual.
void Minima::keep_rival(const LeastSquaresFit& other, const LeastSquaresFit& fit) {
  constexpr double kAlike = 25.0,
                   kApart = 100.0;  // s^2: noise makes one of many minima so much lower by chance
  if (!has_answer(other)) return;
  const double free = std::max(1.0, static_cast<double>(fit.residuals.size() - fit.p.size()));
  const double variance = fit.sum_of_squares() / free;
  const bool alike = other.sum_of_squares() <= fit.sum_of_squares() + kAlike * variance;
  if (!alike || (fit.jacobian * (other.p - fit.p)).squaredNorm() <= kApart * variance) return;
  VectorXd rival = other.p;
  for (Index i = 0; i < rival.size(); ++i) {
    // Beyond it nothing changes any more: a clearance that is never reached.
    if (rival[i] > fit.p[i] && other.jacobian.col(i).isZero(0.0)) rival[i] = HUGE_VAL;
  }
  rivals_.push_back(rival);
}

LeastSquaresFit Minima::beside(LeastSquaresFit fit) {
  constexpr int kMostRounds = 5;
  constexpr LeastSquaresOptions kGlance = {.tolerance = 1e-4, .most_evaluations = 15};
  if (!switches_ || exact_ || fit.jacobian.size() == 0) return fit;
  for (int round = 0; round < kMostRounds; ++round) {
    LeastSquaresFit best = fit;
    rivals_.clear();
    for (const VectorXd& start : starts_beside(fit)) {
      LeastSquaresFit other = descend(start, kGlance);
      keep_rival(other, fit);
      take(std::move(other), best);
    }
    if (!(best.sum_of_squares() < (1.0 - kLower) * fit.sum_of_squares())) return fit;
    best = from(best.p);
    if (!(best.sum_of_squares() < (1.0 - kLower) * fit.sum_of_squares())) return fit;
    fit = std::move(best);
    exact_ = !misses(fit, kExactly);
    if (exact_) {  // what lies next to it differs by rounding
      rivals_.clear();
      return fit;
    }
  }
  return fit;
}

}  // namespace frahm::identification
