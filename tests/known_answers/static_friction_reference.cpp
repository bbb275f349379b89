#include "tests/known_answers/static_friction_reference.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <stdexcept>

#include "tests/known_answers/isolated_roots.hpp"

namespace frahm::static_friction {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;
using periodic::first_end, periodic::SeriesOverStep;
using Ways = std::vector<int>;  // of each contact: 0 sticks, +1, -1 slides

constexpr double kEdge = 1e-9;       // relative: decided by derivatives
constexpr double kZero = 1e-10;      // a derivative below it is zero [1/s^k]
constexpr double kLittle = 1e-13;    // rounding of a guard, counted in its limit
constexpr double kTogether = 1e-11;  // guards that are zero at one instant
constexpr Index kTerms = 24;

// A form of the state that is positive while a way lasts, counted in its limit; and whose way it is.
struct Guard {
  RowVectorXd form;
  unsigned of = 0;  // contacts, a bit each
  bool slides = false;
};

struct Piece {
  MatrixXd A;
  MatrixXd lambda;  // rows: a force of each contact
  VectorXd loop;    // forces in balance by which those of a loop may differ; zeros: there is none
  std::vector<Guard> guards;
};

class Follower {
 public:
  explicit Follower(const System& system) : s_(system), n_(system.mass.size()), size_(2 * n_ + 3) {
    x_.setZero(size_);
    x_[2 * n_] = x_[2 * n_ + 2] = 1.0;
    const MatrixXd M_inverse = s_.mass.cwiseInverse().asDiagonal();
    const double stiff = std::sqrt((M_inverse * s_.K).eigenvalues().cwiseAbs().maxCoeff());
    const double damped = (M_inverse * s_.C).eigenvalues().cwiseAbs().maxCoeff();
    step_ = 0.5 / std::max({stiff, damped, s_.omega});
    motion_.stops.resize(s_.contacts.size());
    motion_.peak.setZero(n_);
  }

  Motion follow(double duration) {
    ways_.assign(s_.contacts.size(), 0);
    std::vector<std::size_t> all;
    for (std::size_t j = 0; j < ways_.size(); ++j) all.push_back(j);
    if (choose(all, 0)) move_to(duration);
    motion_.end = x_.head(n_);
    return motion_;
  }

 private:
  const Piece& piece(const Ways& ways) {
    const auto known = pieces_.find(ways);
    return known != pieces_.end() ? known->second : pieces_.emplace(ways, make(ways)).first->second;
  }
  Piece make(const Ways& ways) const;
  void add_stuck_guards(const std::vector<Index>& stuck, Piece& piece) const;
  bool choose(const std::vector<std::size_t>& at_rest, unsigned expected);
  double broken_by(const Ways& ways, unsigned at_rest, unsigned expected, double& slack, unsigned& edge);
  double sum_of(const Ways& ways);
  void move_to(double end);
  void note_near(const SeriesOverStep& g, double end);
  void note_peaks(const MatrixXd& series, double end);

  const System& s_;
  Index n_, size_;
  double step_ = 0.0, t_ = 0.0;
  VectorXd x_;
  Ways ways_;
  std::map<Ways, Piece> pieces_;
  Motion motion_;
};

Piece Follower::make(const Ways& ways) const {
  const auto m = static_cast<Index>(ways.size());
  MatrixXd force = MatrixXd::Zero(n_, size_);
  force.leftCols(n_) = -s_.K;
  force.middleCols(n_, n_) = -s_.C;
  force.col(2 * n_) = s_.cosine;
  force.col(2 * n_ + 1) = s_.sine;
  force.col(2 * n_ + 2) = s_.constant;
  std::vector<Index> stuck;
  MatrixXd W(n_, m);
  for (Index j = 0; j < m; ++j) {
    const Contact& contact = s_.contacts[static_cast<std::size_t>(j)];
    W.col(j) = contact.w;
    const int way = ways[static_cast<std::size_t>(j)];
    if (way == 0) stuck.push_back(j);
    force.col(2 * n_ + 2) -= way * contact.kinetic * contact.w;
  }
  const MatrixXd M_inverse = s_.mass.cwiseInverse().asDiagonal();
  Piece piece;
  piece.lambda.setZero(m, size_);
  piece.loop.setZero(m);
  MatrixXd acceleration = M_inverse * force;
  if (!stuck.empty()) {
    const MatrixXd W_s = W(Eigen::all, stuck), G = W_s.transpose() * M_inverse * W_s;
    const MatrixXd lambda = G.completeOrthogonalDecomposition().solve(W_s.transpose() * acceleration);
    const MatrixXd kernel = G.fullPivLu().kernel();
    if (G.fullPivLu().rank() < G.rows()) {
      if (kernel.cols() > 1) throw std::logic_error("the reference takes one loop");
      piece.loop(stuck) = kernel.col(0) / kernel.cwiseAbs().maxCoeff();
    }
    piece.lambda(stuck, Eigen::all) = lambda;
    acceleration -= M_inverse * W_s * lambda;
  }
  piece.A.setZero(size_, size_);
  piece.A.block(0, n_, n_, n_).setIdentity();
  piece.A.middleRows(n_, n_) = acceleration;
  piece.A(2 * n_, 2 * n_ + 1) = -s_.omega;
  piece.A(2 * n_ + 1, 2 * n_) = s_.omega;
  for (Index j = 0; j < m; ++j) {
    const int way = ways[static_cast<std::size_t>(j)];
    if (way == 0) continue;
    RowVectorXd speed = RowVectorXd::Zero(size_);
    speed.segment(n_, n_) = way * s_.contacts[static_cast<std::size_t>(j)].w.transpose();
    piece.guards.push_back({speed, 1U << j, true});
  }
  add_stuck_guards(stuck, piece);
  return piece;
}

// Contacts outside the loop: F_s -+ lambda. In it each leaves an interval of multiples of the forces in
// balance, and the upper end of one must not be below the lower end of another.
void Follower::add_stuck_guards(const std::vector<Index>& stuck, Piece& piece) const {
  const auto constant = [&](double value) {
    RowVectorXd form = RowVectorXd::Zero(size_);
    form[size_ - 1] = value;
    return form;
  };
  for (const Index i : stuck) {
    const double limit = s_.contacts[static_cast<std::size_t>(i)].limit, z = piece.loop[i];
    const RowVectorXd lambda = piece.lambda.row(i);
    if (std::abs(z) < 1e-9) {
      for (const double side : {1.0, -1.0})
        piece.guards.push_back({constant(1.0) - side / limit * lambda, 1U << i, false});
      continue;
    }
    for (const Index k : stuck) {
      const double limit_k = s_.contacts[static_cast<std::size_t>(k)].limit, z_k = piece.loop[k];
      if (k == i || std::abs(z_k) < 1e-9) continue;
      const RowVectorXd high = constant(limit / std::abs(z)) - lambda / z;
      const RowVectorXd low = constant(-limit_k / std::abs(z_k)) - piece.lambda.row(k) / z_k;
      const double size = limit / std::abs(z) + limit_k / std::abs(z_k);
      piece.guards.push_back({(high - low) / size, (1U << i) | (1U << k), false});
    }
  }
}

// How far the worst claim of these ways is from being true; 0: all are. slack: how far the nearest is from
// being broken, but for those on the edge.
double Follower::broken_by(const Ways& ways, unsigned at_rest, unsigned expected, double& slack,
                           unsigned& edge) {
  const Piece& p = piece(ways);
  double worst = 0.0;
  for (const Guard& guard : p.guards) {
    if ((guard.of & at_rest) == 0) continue;
    VectorXd x = x_;
    double value = guard.form.dot(x), size = 1.0;
    if (guard.slides) {
      const auto j = static_cast<std::size_t>(std::countr_zero(guard.of));
      const Contact& contact = s_.contacts[j];
      size = contact.kinetic * contact.w.dot(contact.w.cwiseQuotient(s_.mass));
      x = p.A * x;
      value = guard.form.dot(x) / size;
    }
    if (std::abs(value) > kEdge) {
      if (value < 0.0)
        worst = std::max(worst, -value);
      else
        slack = std::min(slack, value);
      continue;
    }
    edge |= guard.of;
    if (!guard.slides && (guard.of & expected) != 0) {  // it is about to be broken: that is the event
      worst = std::max(worst, 1.0);
      continue;
    }
    double first = 0.0;
    for (int k = 0; k < 6 && std::abs(first) < kZero; ++k) {
      x = p.A * x;
      first = guard.form.dot(x) / size;
    }
    const bool holds = guard.slides ? first >= kZero : first > -kZero;
    if (!holds) worst = std::max(worst, (guard.of & expected) != 0 ? 1.0 : 0.5 * kNear);
  }
  return worst;
}

double Follower::sum_of(const Ways& ways) {
  const Piece& p = piece(ways);
  VectorXd force = p.lambda * x_;
  const auto m = static_cast<Index>(ways.size());
  VectorXd limit(m);
  for (Index j = 0; j < m; ++j) {
    const Contact& contact = s_.contacts[static_cast<std::size_t>(j)];
    const int way = ways[static_cast<std::size_t>(j)];
    if (way != 0) force[j] = way * contact.kinetic;
    limit[j] = contact.limit;
  }
  const VectorXd z = p.loop.cwiseQuotient(limit), relative = force.cwiseQuotient(limit);
  if (z.squaredNorm() == 0.0) return relative.squaredNorm();
  double low = -HUGE_VAL, high = HUGE_VAL;
  for (Index j = 0; j < m; ++j) {
    if (std::abs(p.loop[j]) < 1e-9) continue;
    low = std::max(low, -1.0 / std::abs(z[j]) - relative[j] / z[j]);
    high = std::min(high, 1.0 / std::abs(z[j]) - relative[j] / z[j]);
  }
  return (relative + std::clamp(-relative.dot(z) / z.squaredNorm(), low, std::max(low, high)) * z)
      .squaredNorm();
}

// expected: the contacts whose event this is.
bool Follower::choose(const std::vector<std::size_t>& at_rest, unsigned expected) {
  int codes = 1, best_stuck = -1, best_kept = -1;
  unsigned resting = 0;
  for (const std::size_t j : at_rest) {
    codes *= 3;
    resting |= 1U << j;
  }
  double best_sum = 0.0, best_slack = 0.0, difference = 1.0;
  Ways chosen;
  for (int code = 0; code < codes; ++code) {
    Ways ways = ways_;
    int stuck = 0, kept = 0, rest = code;
    for (const std::size_t j : at_rest) {
      ways[j] = rest % 3 == 2 ? -1 : rest % 3;
      rest /= 3;
      stuck += ways[j] == 0;
      kept += ways[j] == 0 && ways_[j] == 0;
    }
    if (stuck < best_stuck) continue;
    double slack = 1.0;
    unsigned edge = 0;
    const double broken = broken_by(ways, resting, expected, slack, edge);
    if (broken > 0.0) {
      if (broken < kNear) motion_.is_near = true;
      continue;
    }
    const double sum = sum_of(ways);
    const bool same = stuck == best_stuck && kept == best_kept;
    if (same) difference = std::min(difference, std::abs(sum - best_sum));
    if (stuck == best_stuck && (kept < best_kept || (kept == best_kept && sum >= best_sum))) continue;
    best_stuck = stuck;
    best_kept = kept;
    best_sum = sum;
    best_slack = (edge & ~expected) != 0 ? 0.0 : slack;
    chosen = ways;
  }
  if (best_stuck < 0) {
    motion_.has_none_admissible = true;
    return false;
  }
  if (best_slack < kNear || difference < kNear) motion_.is_near = true;
  for (const std::size_t j : at_rest) {
    const bool rested = t_ > 0.0 && ways_[j] == 0;
    if (chosen[j] == 0 && !rested) motion_.stops[j].push_back({t_, -1.0});
    if (chosen[j] != 0 && rested) motion_.stops[j].back().release = t_;
  }
  ways_ = chosen;
  return true;
}

// Where g is positive throughout, whether it nearly is not somewhere within.
void Follower::note_near(const SeriesOverStep& g, double end) {
  constexpr int kPlaces = 24;
  constexpr double kGolden = 0.6180339887498949;
  if (g.c[0] > g.most_slope() + kNear) return;
  for (int i = 1; i < kPlaces; ++i) {
    double a = end * (i - 1) / kPlaces, b = end * (i + 1) / kPlaces;
    const double middle = g(end * i / kPlaces);
    if (middle > g(a) || middle > g(b) || middle > 1e-2) continue;
    for (int k = 0; k < 60; ++k) {
      const double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
      (g(c) < g(d) ? b : a) = g(c) < g(d) ? d : c;
    }
    if (g(a) < kNear) motion_.is_near = true;
  }
}

void Follower::note_peaks(const MatrixXd& series, double end) {
  for (Index i = 0; i < n_; ++i) {
    const RowVectorXd q = series.row(i), v = series.row(n_ + i);
    const SeriesOverStep displacement{q.data(), kTerms}, velocity{v.data(), kTerms};
    const auto note = [&](double at) {
      motion_.peak[i] = std::max(motion_.peak[i], std::abs(displacement(at)));
    };
    note(end);
    periodic::isolate(velocity, velocity.most_bend(), 1e-15, 0.0, end, [&](double a, double b) {
      if ((velocity(a) <= 0.0) != (velocity(b) <= 0.0)) note(periodic::root_between(velocity, a, b));
      return false;
    });
  }
}

void Follower::move_to(double end) {
  int at_once = 0;
  while (t_ < end) {
    const double h = std::min(step_, end - t_);
    if (h < 1e-13 * end) break;
    const Piece& p = piece(ways_);
    MatrixXd series(size_, kTerms);
    series.col(0) = x_;
    for (Index k = 1; k < kTerms; ++k) series.col(k) = p.A * series.col(k - 1) * (h / static_cast<double>(k));
    double first = 2.0;
    unsigned of = 0;
    std::vector<RowVectorXd> polynomials;
    for (const Guard& guard : p.guards) polynomials.emplace_back(guard.form * series);
    for (std::size_t i = 0; i < p.guards.size(); ++i) {
      const double at = first_end({polynomials[i].data(), kTerms}, kLittle);
      if (at >= first) continue;
      first = at;
      of = p.guards[i].of;
    }
    const double part = std::min(first, 1.0);
    // Contacts that stick tie velocities of others together, which then reach zero at one instant.
    for (std::size_t i = 0; first <= 1.0 && i < p.guards.size(); ++i) {
      const SeriesOverStep g{polynomials[i].data(), kTerms};
      if (std::abs(g(part)) < kTogether && g.slope(part) < 0.0) of |= p.guards[i].of;
    }
    for (std::size_t i = 0; i < p.guards.size(); ++i) {
      if ((p.guards[i].of & of) != 0) continue;
      const SeriesOverStep g{polynomials[i].data(), kTerms};
      note_near(g, part);
      if (first <= 1.0 && g(part) < kNear) motion_.is_near = true;
    }
    note_peaks(series, part);
    x_ = series.col(kTerms - 1);
    for (Index k = kTerms - 2; k >= 0; --k) x_ = x_ * part + series.col(k);
    t_ += part * h;
    if (first > 1.0) continue;
    at_once = part == 0.0 ? at_once + 1 : 0;
    if (at_once > 10 || ++motion_.events > 5000) throw std::runtime_error("the reference chatters");
    std::vector<std::size_t> at_rest;
    for (std::size_t j = 0; j < ways_.size(); ++j)
      if (ways_[j] == 0 || (of >> j & 1U) != 0) at_rest.push_back(j);
    if (!choose(at_rest, of)) return;
    // What rounding leaves of the velocities of stuck contacts goes, by the least change of energy.
    for (int sweep = 0; sweep < 30; ++sweep) {
      for (std::size_t j = 0; j < ways_.size(); ++j) {
        if (ways_[j] != 0) continue;
        const VectorXd& w = s_.contacts[j].w;
        const VectorXd pull = w.cwiseQuotient(s_.mass);
        x_.segment(n_, n_) -= pull * (w.dot(x_.segment(n_, n_)) / w.dot(pull));
      }
    }
  }
}

}  // namespace

Motion follow(const System& system, double duration) {
  return Follower(system).follow(duration);
}

}  // namespace frahm::static_friction
