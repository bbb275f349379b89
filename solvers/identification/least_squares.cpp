#include "solvers/identification/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/algebra/singular_values.hpp"

namespace frahm::identification {
namespace {

// p(q) that stays within the bounds for every q, and its derivative. Source: [25].
//   both bounds  p = a + (b - a) (sin q + 1) / 2
//   one          p = a + s (sqrt(q^2 + 1) - 1),  s the unknown's scale; below an upper bound alike
class Bounded {
 public:
  explicit Bounded(const Unknown& unknown) : a_(unknown.lower), b_(unknown.upper), scale_(unknown.scale) {}

  double inside(double q) const {
    if (two_sided()) return a_ + 0.5 * (b_ - a_) * (std::sin(q) + 1.0);
    const double away = scale_ * (std::sqrt(q * q + 1.0) - 1.0);
    if (a_ > -kInfinity) return a_ + away;
    return b_ < kInfinity ? b_ - away : scale_ * q;
  }
  double slope(double q) const {
    if (two_sided()) return 0.5 * (b_ - a_) * std::cos(q);
    const double away = scale_ * q / std::sqrt(q * q + 1.0);
    if (a_ > -kInfinity) return away;
    return b_ < kInfinity ? -away : scale_;
  }
  // q of a value p; a p at a bound, where the slope is zero, is moved off it.
  double outside(double p) const {
    constexpr double kOff = 1e-3;  // of the range
    if (two_sided()) return std::asin(std::clamp(2.0 * (p - a_) / (b_ - a_) - 1.0, -1.0 + kOff, 1.0 - kOff));
    if (a_ == -kInfinity && b_ == kInfinity) return p / scale_;
    const double away = a_ > -kInfinity ? p - a_ : b_ - p;
    const double root = std::max(away / scale_, kOff) + 1.0;
    return std::sqrt(root * root - 1.0);
  }
  // -1 or 1 if p is practically at a bound.
  int at_bound(double p) const {
    constexpr double kAt = 1e-6;  // of the range
    const double range = two_sided() ? b_ - a_ : scale_;
    if (p - a_ <= kAt * range) return -1;
    return b_ - p <= kAt * range ? 1 : 0;
  }
  double bound(int side) const { return side < 0 ? a_ : b_; }

 private:
  bool two_sided() const { return a_ > -kInfinity && b_ < kInfinity; }

  double a_, b_, scale_;
};

// The problem in the free unknowns' q, in the form that Eigen's solver takes.
class Functor : public Eigen::DenseFunctor<double> {
 public:
  Functor(const std::vector<Bounded>& bounded, std::vector<Eigen::Index> free, Eigen::VectorXd p,
          const Residuals& residuals, Eigen::Index rows)
      : DenseFunctor(static_cast<int>(free.size()), static_cast<int>(rows)),
        bounded_(bounded),
        free_(std::move(free)),
        p_(std::move(p)),
        residuals_(residuals) {}

  const Eigen::VectorXd& inside(const Eigen::VectorXd& q) {
    for (std::size_t i = 0; i < free_.size(); ++i)
      p_[free_[i]] = at(i).inside(q[static_cast<Eigen::Index>(i)]);
    return p_;
  }
  Eigen::VectorXd outside() const {
    Eigen::VectorXd q(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i)
      q[static_cast<Eigen::Index>(i)] = at(i).outside(p_[free_[i]]);
    return q;
  }

  // Infinite where there are no residuals: the solver then takes a shorter step.
  int operator()(const Eigen::VectorXd& q, Eigen::VectorXd& r) {
    if (!residuals_(inside(q), r, nullptr)) r.setConstant(values(), kInfinity);
    return 0;
  }
  int df(const Eigen::VectorXd& q, Eigen::MatrixXd& by_q) {
    if (!residuals_(inside(q), scratch_, &jacobian_)) return -1;
    by_q.resize(values(), inputs());
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      by_q.col(column) = jacobian_.col(free_[i]) * at(i).slope(q[column]);
    }
    return 0;
  }

 private:
  const Bounded& at(std::size_t i) const { return bounded_[static_cast<std::size_t>(free_[i])]; }

  const std::vector<Bounded>& bounded_;
  std::vector<Eigen::Index> free_;
  Eigen::VectorXd p_, scratch_;
  Eigen::MatrixXd jacobian_;
  const Residuals& residuals_;
};

std::string reason_of(Eigen::LevenbergMarquardtSpace::Status status) {
  using namespace Eigen::LevenbergMarquardtSpace;
  switch (status) {
    case RelativeReductionTooSmall:
    case RelativeErrorTooSmall:
    case RelativeErrorAndReductionTooSmall:
    case FtolTooSmall:
    case XtolTooSmall:
    case CosinusTooSmall:
    case GtolTooSmall:
      return "";
    case TooManyFunctionEvaluation:
      return "the allowed evaluations were used up";
    default:
      return "the model has no derivative at the best values found";
  }
}

// Unknowns that end at a bound towards which the sum of squares pushes them.
std::vector<int> held(const std::vector<Bounded>& bounded, const LeastSquaresFit& fit) {
  const Eigen::VectorXd gradient = fit.jacobian.transpose() * fit.residuals;
  std::vector<int> sides(bounded.size(), 0);
  for (std::size_t i = 0; i < bounded.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const int side = bounded[i].at_bound(fit.p[place]);
    if (side * gradient[place] < 0.0) sides[i] = side;
  }
  return sides;
}

void solve(const std::vector<Bounded>& bounded, const Residuals& residuals,
           const LeastSquaresOptions& options, LeastSquaresFit& fit) {
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < bounded.size(); ++i) {
    if (fit.at_bound[i] == 0) free.push_back(static_cast<Eigen::Index>(i));
  }
  fit.converged = true;
  if (!free.empty()) {
    Functor functor(bounded, std::move(free), fit.p, residuals, fit.residuals.size());
    Eigen::LevenbergMarquardt<Functor> solver(functor);
    solver.setFtol(options.tolerance);
    solver.setXtol(options.tolerance);
    solver.setMaxfev(options.most_evaluations);
    Eigen::VectorXd q = functor.outside();
    fit.reason = reason_of(solver.minimize(q));
    fit.converged = fit.reason.empty();
    fit.iterations += static_cast<int>(solver.iterations());
    fit.p = functor.inside(q);
  }
  if (!residuals(fit.p, fit.residuals, &fit.jacobian)) {
    fit.converged = false;
    fit.jacobian.resize(0, 0);
    fit.reason = "the model has no value or no derivative at the best values found";
  }
}

// The Gauss-Newton step, J d = -r, of the unknowns that no bound holds, in units of their scales.
Eigen::VectorXd gauss_newton_step(const std::vector<Unknown>& unknowns, const LeastSquaresFit& fit) {
  Eigen::MatrixXd J = fit.jacobian;
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    J.col(i) *= fit.at_bound[place] == 0 ? unknowns[place].scale : 0.0;
  }
  return -algebra::shortest_solution(J, fit.residuals);
}

// A model that is solved to its own tolerance, such as a periodic orbit, is rough in its last digits, and the
// search for their least does not end by itself. It ends when the next step is a thousandth of a standard
// error, or in the ninth digit.
bool has_arrived(const std::vector<Unknown>& unknowns, const LeastSquaresFit& fit) {
  constexpr double kErrors = 1e-3, kDigits = 1e-9;
  if (fit.jacobian.size() == 0) return false;
  Eigen::VectorXd d = gauss_newton_step(unknowns, fit);
  if (d.norm() <= kDigits) return true;
  for (Eigen::Index i = 0; i < d.size(); ++i) d[i] *= unknowns[static_cast<std::size_t>(i)].scale;
  const double free = std::max(1.0, static_cast<double>(fit.residuals.size() - d.size()));
  return (fit.jacobian * d).norm() <= kErrors * fit.residuals.norm() / std::sqrt(free);
}

// The sum of squares is flat at its minimum, so it determines the unknowns to half the digits only.
// Gauss-Newton steps find the rest, as long as each is at most half as long as the one before.
void polish(const std::vector<Unknown>& unknowns, const Residuals& residuals, LeastSquaresFit& fit) {
  constexpr int kMostSteps = 12;
  constexpr double kSmall = 1e-3;  // of the scale: a larger step is no polishing
  double last = kSmall;
  LeastSquaresFit next = fit;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd d = gauss_newton_step(unknowns, fit);
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      const Unknown& unknown = unknowns[static_cast<std::size_t>(i)];
      next.p[i] = std::clamp(fit.p[i] + d[i] * unknown.scale, unknown.lower, unknown.upper);
    }
    const double length = d.norm();
    if (length == 0.0 || !(length <= 0.5 * last) || !residuals(next.p, next.residuals, &next.jacobian))
      return;
    last = length;
    fit = next;
  }
}

}  // namespace

LeastSquaresFit least_squares(const std::vector<Unknown>& unknowns, const Residuals& residuals,
                              const LeastSquaresOptions& options) {
  std::vector<Bounded> bounded(unknowns.begin(), unknowns.end());
  LeastSquaresFit fit;
  fit.at_bound.assign(unknowns.size(), 0);
  fit.p.resize(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    fit.p[static_cast<Eigen::Index>(i)] = bounded[i].inside(bounded[i].outside(unknowns[i].start));
  if (!residuals(fit.p, fit.residuals, nullptr)) {
    fit.reason = "the model has no value at the start";
    return fit;
  }
  solve(bounded, residuals, options, fit);
  const std::vector<int> sides =
      fit.jacobian.size() > 0 ? held(bounded, fit) : std::vector<int>(bounded.size(), 0);
  if (std::any_of(sides.begin(), sides.end(), [](int side) { return side != 0; })) {
    // Once more without the held unknowns, set exactly to their bounds.
    fit.at_bound = sides;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (sides[i] != 0) fit.p[static_cast<Eigen::Index>(i)] = bounded[i].bound(sides[i]);
    }
    solve(bounded, residuals, options, fit);
  }
  fit.converged = fit.converged || has_arrived(unknowns, fit);
  if (fit.converged) polish(unknowns, residuals, fit);
  if (fit.converged) fit.reason = "the sum of squares is least: no step makes it smaller";
  return fit;
}

Eigen::MatrixXd covariance(const Eigen::MatrixXd& jacobian, double variance, const Eigen::VectorXd& scales) {
  constexpr double kNoEffect = 1e-14;    // of a typical change, of the largest effect there is
  constexpr double kIndistinct = 1e-10;  // singular values of columns of length 1: the same to rounding
  constexpr double kTakesPart = 1e-4;    // in a direction of length 1
  const Eigen::Index n = jacobian.cols();
  Eigen::VectorXd length = jacobian.colwise().norm().transpose();
  const double largest = n > 0 ? length.cwiseProduct(scales).maxCoeff() : 0.0;
  Eigen::MatrixXd unit = jacobian;
  std::vector<bool> lost(static_cast<std::size_t>(n), false);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool none = !(length[i] * scales[i] > kNoEffect * largest);
    lost[static_cast<std::size_t>(i)] = none;
    if (none) unit.col(i).setZero();
    if (none) length[i] = 1.0;
    unit.col(i) /= length[i];
  }
  const algebra::SingularValues svd = algebra::singular_values(unit);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double sigma = k < svd.values.size() ? svd.values[k] : 0.0;
    const bool seen = sigma > kIndistinct * svd.values[0];
    const Eigen::VectorXd v = k < svd.V.cols() ? Eigen::VectorXd(svd.V.col(k)) : Eigen::VectorXd();
    if (seen) result += (variance / (sigma * sigma)) * v * v.transpose();
    for (Eigen::Index i = 0; !seen && i < v.size(); ++i) {
      if (std::abs(v[i]) > kTakesPart) lost[static_cast<std::size_t>(i)] = true;
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const bool none = lost[static_cast<std::size_t>(i)] || lost[static_cast<std::size_t>(j)];
      result(i, j) = none ? kNone : result(i, j) / (length[i] * length[j]);
    }
    if (lost[static_cast<std::size_t>(i)]) result(i, i) = kInfinity;
  }
  return result;
}

}  // namespace frahm::identification
