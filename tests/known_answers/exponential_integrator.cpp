#include "tests/known_answers/exponential_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/known_answers/isolated_roots.hpp"

// How the motion is followed through its pieces.
namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;

constexpr Index kMostTerms = 80;

}  // namespace

void ExponentialIntegrator::set_forcing_states() {
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const Index place = 2 * n_ + internal_ + 2 * static_cast<Index>(k);
    x_[place] = 1.0;
    x_[place + 1] = 0.0;
  }
  x_[size_ - 1] = 1.0;
}

void ExponentialIntegrator::start(const VectorXd& q, const VectorXd& v, const VectorXd& s) {
  constexpr double kAtRest = 1e-11, kAtLimit = 1e-12;  // relative
  x_.setZero();
  x_.head(n_) = q;
  x_.segment(n_, n_) = v;
  x_.segment(2 * n_, s.size()) = s;
  set_forcing_states();
  most_ = least_ = q;
  stuck_throughout = ~0U;
  modes_ = {std::vector<Mode>(contacts_.size(), Mode::stuck), std::vector<Side>(bends_.size(), Side::before)};
  zeros_.assign(contacts_.size() + bends_.size(), {0, 0});
  speed_scale_ = v.cwiseAbs().maxCoeff() + omega_ * q.cwiseAbs().maxCoeff() + 1e-3;
  typical_.setZero(size_);
  typical_.head(n_).setConstant(speed_scale_ / omega_);
  typical_.segment(n_, n_).setConstant(speed_scale_);
  for (std::size_t b = 0; b < bends_.size(); ++b) {
    if (bends_[b].past.dot(x_) <= 0.0) continue;
    modes_.bend[b] = bends_[b].jumps && bends_[b].force.dot(x_) <= 0.0 ? Side::free : Side::beyond;
  }
  std::vector<std::size_t> at_rest;
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    const Contact& contact = contacts_[j];
    const double speed = contact.speed.dot(x_);
    const Mode sliding = speed > 0.0 ? Mode::forward : Mode::backward;
    if (holds(j) && std::abs(speed) < kAtRest * speed_scale_)
      at_rest.push_back(j);
    else if (holds(j))
      modes_.contact[j] = sliding;
    else if (const double s_j = x_[contact.internal];
             std::abs(s_j) >= contact.limit * (1.0 - kAtLimit) && s_j * speed > 0.0)
      modes_.contact[j] = sliding;
  }
  choose(at_rest);
}

unsigned ExponentialIntegrator::coulomb_contacts() const {
  unsigned mask = 0;
  for (std::size_t j = 0; j < contacts_.size(); ++j)
    if (holds(j)) mask |= 1U << j;
  return mask;
}

void ExponentialIntegrator::pass_period() {
  set_forcing_states();
  for (int i = 0; i < steps_; ++i) advance(step_);
}

// Taylor's series of exp(A h) X, up to two terms in a row that are below rounding.
void ExponentialIntegrator::expand(double h) {
  constexpr double kBelowRounding = 1e-18;
  taylor_.resize(size_, kMostTerms);
  taylor_.col(0) = x_;
  const Index moving = 2 * n_ + internal_;  // the forcing's states are near one
  const double small = kBelowRounding * (x_.cwiseAbs() + typical_).head(moving).maxCoeff();
  int in_a_row = 0;
  for (terms_ = 1; terms_ < kMostTerms && in_a_row < 2; ++terms_) {
    const auto term = taylor_.col(terms_);
    taylor_.col(terms_).noalias() = now_->A * taylor_.col(terms_ - 1) * (h / static_cast<double>(terms_));
    const bool is_small = term.head(moving).cwiseAbs().maxCoeff() <= small &&
                          term.tail(size_ - moving).cwiseAbs().maxCoeff() <= kBelowRounding;
    in_a_row = is_small ? in_a_row + 1 : 0;
  }
  if (terms_ == kMostTerms) throw std::runtime_error("the reference's series has too many terms");
}

void ExponentialIntegrator::move(double part) {
  x_ = taylor_.col(terms_ - 1);
  for (Index k = terms_ - 2; k >= 0; --k) x_ = x_ * part + taylor_.col(k);
  x_[size_ - 1] = 1.0;
}

// The place in the step, in [0, 1], where the first mode ends, or 2; and which.
std::pair<double, ExponentialIntegrator::End> ExponentialIntegrator::first_of_ends() {
  constexpr double kRounding = 1e-14;
  std::pair<double, End> first{2.0, {}};
  guards_.noalias() = taylor_.leftCols(terms_).transpose() * now_->forms.transpose();
  for (std::size_t i = 0; i < now_->ends.size(); ++i) {
    const End& end = now_->ends[i];
    const auto column = static_cast<Index>(i);
    const auto zeros = static_cast<Index>(zeros_[end.index][end.which]);
    const SeriesOverStep g{guards_.col(column).data() + zeros, terms_ - zeros};
    if (g.c[0] > g.most_slope() && g.c[0] > kRounding) continue;
    const double little =
        kRounding * now_->forms.row(column).cwiseAbs().dot((x_.cwiseAbs() + typical_).transpose());
    const double place = first_end(g, little);
    if (place < first.first) first = {place, end};
  }
  return first;
}

void ExponentialIntegrator::advance(double h) {
  constexpr int kMostEvents = 1000;  // of a step
  constexpr double kAtOnce = 1e-9;   // of a step: what grows from zero has not left it yet
  for (int events = 0; h > 0.0; ++events) {
    if (events > kMostEvents) throw std::runtime_error("the reference met too many events in a step");
    expand(h);
    const auto [first, at] = first_of_ends();
    const double part = std::min(first, 1.0);
    if (watches_extremes) note_extremes(part);
    move(part);
    if (part * h > kAtOnce * step_) std::ranges::fill(zeros_, std::array<int, 2>{0, 0});
    for (std::size_t j = 0; j < contacts_.size() && part * h > kAtOnce * step_; ++j)
      if (modes_.contact[j] != Mode::stuck) stuck_throughout &= ~(1U << j);
    if (first > 1.0) return;
    h *= 1.0 - part;
    ++events_;
    pass(at);
  }
}

void ExponentialIntegrator::note_extremes(double end) {
  for (Index i = 0; i < n_; ++i) {
    const RowVectorXd q = taylor_.row(i).head(terms_), v = taylor_.row(n_ + i).head(terms_);
    const SeriesOverStep displacement{q.data(), terms_}, velocity{v.data(), terms_};
    const auto note = [&](double at) {
      most_[i] = std::max(most_[i], displacement(at));
      least_[i] = std::min(least_[i], displacement(at));
    };
    note(end);
    if (std::abs(v[0]) > velocity.most_slope()) continue;
    isolate(velocity, velocity.most_bend(), 1e-14 * speed_scale_, 0.0, end, [&](double a, double b) {
      if ((velocity(a) <= 0.0) != (velocity(b) <= 0.0)) note(root_between(velocity, a, b));
      return false;
    });
  }
}

void ExponentialIntegrator::pass(const End& end) {
  if (end.index < contacts_.size())
    pass_contact(end.index, end.which);
  else
    pass_bend(end.index - contacts_.size(), end.which);
}

void ExponentialIntegrator::pass_contact(std::size_t j, std::size_t which) {
  Contact& contact = contacts_[j];
  Mode& mode = modes_.contact[j];
  const Mode released = which == 0 ? Mode::forward : Mode::backward;
  if (!holds(j)) {
    const bool slid = mode != Mode::stuck;
    const bool forward = slid ? mode == Mode::forward : which == 0;
    x_[contact.internal] = forward ? contact.limit : -contact.limit;
    if (slid) zeros_[j][forward ? 0 : 1] = 2;  // s stays at its limit with u' = 0, and unloads
    mode = slid ? Mode::stuck : released;
    now_ = &piece(modes_);
    return;
  }
  if (mode == Mode::stuck) {
    const bool drops = contact.static_limit > contact.limit;
    mode = released;
    zeros_[j] = {drops ? 1 : 2, 0};  // u' grows like t where the force drops, otherwise like t^2
    choose(drops ? stuck_contacts() : std::vector<std::size_t>{});
    return;
  }
  constexpr double kTogether = 1e-12;
  std::vector<std::size_t> at_rest = stuck_contacts(), just_released;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!holds(k) || modes_.contact[k] == Mode::stuck) continue;
    const bool rests = std::abs(contacts_[k].speed.dot(x_)) < kTogether * speed_scale_;
    if (k == j || (rests && zeros_[k][0] == 0))
      at_rest.push_back(k);
    else if (rests)
      just_released.push_back(k);
  }
  choose(at_rest);
  // The reversal of one may press another, released at the same instant, back to rest.
  if (is_consistent(just_released, modes_)) return;
  at_rest.insert(at_rest.end(), just_released.begin(), just_released.end());
  choose(at_rest);
}

void ExponentialIntegrator::pass_bend(std::size_t b, std::size_t which) {
  Side& side = modes_.bend[b];
  const Bend& bend = bends_[b];
  if (which == 0)
    side = side == Side::before ? Side::beyond : Side::before;
  else
    side = side == Side::free ? Side::beyond : Side::free;
  zeros_[contacts_.size() + b] = {0, 0};
  zeros_[contacts_.size() + b][which] = 1;
  choose(bend.jumps ? stuck_contacts() : std::vector<std::size_t>{});
}

std::vector<std::size_t> ExponentialIntegrator::stuck_contacts() const {
  std::vector<std::size_t> stuck;
  for (std::size_t j = 0; j < contacts_.size(); ++j)
    if (holds(j) && modes_.contact[j] == Mode::stuck) stuck.push_back(j);
  return stuck;
}

bool ExponentialIntegrator::is_consistent(const std::vector<std::size_t>& at_rest, const Modes& modes) {
  constexpr double kTie = 1e-11;  // relative: ties go to stick
  const Piece& result = piece(modes);
  if (!result.is_possible) return false;
  for (const std::size_t j : at_rest) {
    const Contact& contact = contacts_[j];
    const auto row = static_cast<Index>(j);
    const double rate = result.rate.row(row).dot(x_);
    const double little = kTie * contact.limit * contact.w.dot(M_inverse_ * contact.w);
    if (modes.contact[j] == Mode::stuck) {
      if (std::abs(result.lambda.row(row).dot(x_)) > contact.static_limit * (1.0 + kTie)) return false;
    } else if ((modes.contact[j] == Mode::forward ? rate : -rate) < -little) {
      return false;
    }
  }
  return true;
}

// For all consistent modes of the contacts at rest, those with most of them stuck.
void ExponentialIntegrator::choose(const std::vector<std::size_t>& at_rest) {
  int combinations = 1, best = -1;
  for (std::size_t i = 0; i < at_rest.size(); ++i) combinations *= 3;
  Modes chosen = modes_;
  for (int code = 0; code < combinations && !at_rest.empty(); ++code) {
    Modes modes = modes_;
    int stuck = 0, rest = code;
    for (const std::size_t j : at_rest) {
      modes.contact[j] = static_cast<Mode>(rest % 3);
      stuck += rest % 3 == 0;
      rest /= 3;
    }
    if (stuck <= best || !is_consistent(at_rest, modes)) continue;
    best = stuck;
    chosen = modes;
  }
  if (best < 0 && !at_rest.empty()) throw std::logic_error("the reference found no consistent modes");
  modes_ = chosen;
  for (const std::size_t j : at_rest) zeros_[j] = {modes_.contact[j] == Mode::stuck ? 0 : 1, 0};
  now_ = &piece(modes_);
  if (!at_rest.empty()) bring_to_rest();
}

// Velocities of stuck contacts, which are zero but for rounding, are taken out by the least change of energy.
void ExponentialIntegrator::bring_to_rest() {
  const std::vector<std::size_t> stuck = stuck_contacts();
  if (stuck.empty()) return;
  const auto count = static_cast<Index>(stuck.size());
  MatrixXd W(n_, count);
  VectorXd speed(count);
  for (Index i = 0; i < count; ++i) {
    W.col(i) = contacts_[stuck[static_cast<std::size_t>(i)]].w;
    speed[i] = contacts_[stuck[static_cast<std::size_t>(i)]].speed.dot(x_);
  }
  x_.segment(n_, n_) -= M_inverse_ * W * (W.transpose() * M_inverse_ * W).ldlt().solve(speed);
}

}  // namespace frahm::periodic
