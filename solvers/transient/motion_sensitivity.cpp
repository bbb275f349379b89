#include "solvers/transient/motion_sensitivity.hpp"

#include <algorithm>

#include "solvers/algebra/no_value.hpp"
#include "solvers/transient/step_limits.hpp"

namespace frahm::transient {
namespace {

using Eigen::Index;

constexpr const char* kJumpsToRest = "a contact comes to rest just when the velocity of its support jumps";
constexpr const char* kLetsGo = "a contact lets go of its static limit just between two passages";

}  // namespace

MotionSensitivity::MotionSensitivity(std::span<const periodic::Observed> observed, std::vector<double> times,
                                     Watch watch)
    : walk_(flow_),
      steps_(flow_),
      time_(times.front()),
      times_(std::move(times)),
      samples_(observed),
      observed_(observed),
      watch_(std::move(watch)) {
  flow_.expect_many_steps();
  motion_.values.resize(static_cast<Index>(times_.size()), static_cast<Index>(observed.size()));
}

void MotionSensitivity::set_system(const mechanics::LinearSystem& system,
                                   std::span<const mechanics::LinearSystem> by) {
  flow_.set_system(system);
  directions_.clear();
  directions_.reserve(by.size());
  for (std::size_t d = 0; d < by.size(); ++d) directions_.emplace_back(flow_);
  motion_.by.assign(by.size(), Eigen::MatrixXd(motion_.values.rows(), motion_.values.cols()));
  flow_.set_forcing(system);
  for (std::size_t d = 0; d < by.size(); ++d) {
    directions_[d].by.set(flow_.equations(), system, by[d]);
    directions_[d].sensitivity.set_direction(directions_[d].by);
  }
}

void MotionSensitivity::start(const InitialState& initial, std::span<const InitialState> by) {
  const Index n = flow_.equations().masses();
  const double h = flow_.equations().step;
  const auto values = [n](const std::vector<double>& given) {
    return given.empty() ? Eigen::VectorXd(Eigen::VectorXd::Zero(n))
                         : Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(given.data(), n));
  };
  const auto state = [&](const InitialState& from) {
    State z = State::Zero(flow_.equations().states());
    z.head(n) = values(from.displacement);
    z.segment(n, n) = h * values(from.velocity);
    return z;
  };
  z_ = state(initial);
  if (!z_.allFinite()) throw mechanics::MechanicsError("the initial values must be finite");
  for (std::size_t d = 0; d < by.size(); ++d) {
    directions_[d].delta = state(by[d]);
    // v h:  d(v h) = h dv + (v h) dh/h
    directions_[d].delta.segment(n, n) += directions_[d].by.log_step * z_.segment(n, n);
  }
}

bool MotionSensitivity::advance(double time, double phase, double longest) {
  const double h = flow_.equations().step, start = time_, length = without_rounding((time - start) / h);
  if (steps_taken_ + length > kMostSteps) failure_ = kTooManySteps;
  const double most = std::clamp(longest / h, 1.0, kStepsAtOnce);
  for (double done = 0.0; done < length && failure_ == nullptr;) {
    if (watch_) watch_();
    const double part = std::min(length - done, most);
    if (!pass(part, phase + done * flow_.fundamental_rate())) return false;
    done += part;
    time_ = start + done * h;
  }
  if (failure_ == nullptr) time_ = time;
  return failure_ == nullptr;
}

bool MotionSensitivity::pass(double length, double phase) {
  passage_start_ = time_;
  walk_.pass(z_, phase, length, passage_, periodic::Tangent::none, 0, &steps_);
  steps_taken_ += length;
  failure_ = passage_.failure;
  if (failure_ != nullptr) return false;
  differentiate();
  const auto steps = steps_.steps();
  const double h = flow_.equations().step;
  for (std::size_t i = 0; i < steps.size(); ++i) sample(i, time_ + (steps[i].start + steps[i].length) * h);
  keep_ending(steps.back());
  z_ = passage_.end;
  return true;
}

void MotionSensitivity::differentiate() {
  if (directions_.empty() || *why_none_ != '\0') return;
  const auto steps = steps_.steps();
  for (Step& step : steps) steps_.expand(step);
  if (!begun_) {
    begin(steps.front());
  } else {
    why_none_ = jumps_ ? cross_jump(steps.front()) : cross_border(steps.front());
  }
  jumps_ = false;
  for (Direction& d : directions_) {
    if (*why_none_ != '\0') return;
    d.delta = d.sensitivity.carry(steps, passage_.changes, d.delta);
    why_none_ = d.sensitivity.why_none();
  }
}

// delta is taken with tau = t/h held, the initial values are given with t held:
//   delta = dz|_t - z' dtau,  dtau = -tau dh/h
void MotionSensitivity::begin(const Step& first) {
  const Index n = flow_.equations().masses(), internal = flow_.equations().internal_forces();
  State rate(flow_.equations().states());
  rate << first.left.z.segment(n, n), first.left.a, first.left.ds.head(internal);
  const double tau = time_ / flow_.equations().step;
  for (Direction& d : directions_) d.delta += (d.by.log_step * tau) * rate;
}

// What arrives, lets go or bends just at the end of a passage changes between two passages. The next one
// begins with the projection onto what is stuck from there on.
const char* MotionSensitivity::cross_border(const Step& first) {
  const auto& eq = flow_.equations();
  const periodic::Mode<kAny, kAny>&before = flow_.mode(ending_.mode), &after = flow_.mode(first.mode);
  if (ending_.mode == first.mode) return "";
  const periodic::Event change{.arrived = periodic::arrived_between(flow_, before, after),
                               .released = before.stuck & ~after.stuck,
                               .at_place = (after.beyond ^ before.beyond) & eq.bends.jumping};
  if (change.arrived == 0 && change.at_place == 0 && lets_go_inside(change.released)) return kLetsGo;
  for (Direction& d : directions_) {
    const char* reason =
        d.sensitivity.cross(change, {ending_.mode, ending_.at}, {first.mode, first.left}, d.delta);
    if (*reason != '\0') return reason;
  }
  return "";
}

// The state goes on, and its derivative with it, whoever slides from there on: the time of the jump is fixed.
const char* MotionSensitivity::cross_jump(const Step& first) const {
  const periodic::Mode<kAny, kAny>&before = flow_.mode(ending_.mode), &after = flow_.mode(first.mode);
  return (after.stuck & ~before.stuck & flow_.equations().holding) == 0 ? "" : kJumpsToRest;
}

// Whether a force falls from its static limit though it was not at it.
bool MotionSensitivity::lets_go_inside(periodic::ContactMask released) const {
  for (; released != 0; released &= released - 1) {
    const Index j = periodic::first(released);
    if (periodic::falls_at_release(flow_.equations(), j) &&
        !periodic::is_at_limit(flow_, j, ending_.at, flow_.mode(ending_.mode)))
      return true;
  }
  return false;
}

void MotionSensitivity::keep_ending(const Step& last) {
  begun_ = true;
  ending_.mode = last.mode;
  ending_.at = last.right;
}

// The samples before `end` [s], from a step of the current passage on.
void MotionSensitivity::sample(std::size_t i, double end) {
  if (next_sample_ == times_.size() || times_[next_sample_] >= end) return;
  Step& step = steps_.steps()[i];
  steps_.expand(step);
  samples_.set_step(flow_, step);
  const double h = flow_.equations().step, start = passage_start_ + step.start * h;
  const std::size_t first = next_sample_;
  powers_.clear();
  for (; next_sample_ < times_.size() && times_[next_sample_] < end; ++next_sample_) {
    powers_.push_back(periodic::powers(std::clamp((times_[next_sample_] - start) / h, 0.0, step.length)));
    samples_.values(powers_.back(), 1.0, motion_.values.row(static_cast<Index>(next_sample_)));
  }
  if (*why_none_ != '\0') return;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    samples_.set_direction(flow_, directions_[d].sensitivity, i);
    for (std::size_t k = 0; k < powers_.size(); ++k)
      samples_.derivatives(powers_[k], times_[first + k] / h, 1.0,
                           motion_.by[d].row(static_cast<Index>(first + k)));
  }
}

// Held masses are released only by forces that still change.
bool MotionSensitivity::is_at_rest() const {
  const auto& eq = flow_.equations();
  const Index harmonics = eq.force.cols() - 1;
  return begun_ && eq.internal_forces() == 0 && eq.force.rightCols(harmonics).isZero(0.0) &&
         eq.motion_velocity.isZero(0.0) && flow_.configuration(flow_.mode(ending_.mode)).holds_all(eq);
}

void MotionSensitivity::finish() {
  if (!is_at_rest()) {
    // The last instant, which lies before no step.
    return sample(steps_.steps().size() - 1, kInfinity);
  }
  for (; next_sample_ < times_.size(); ++next_sample_) {
    const auto row = static_cast<Index>(next_sample_);
    for (std::size_t o = 0; o < observed_.size(); ++o) {
      const auto column = static_cast<Index>(o);
      const bool rests = observed_[o].order == 0;
      motion_.values(row, column) = rests ? z_[observed_[o].mass] : 0.0;
      for (std::size_t d = 0; d < directions_.size(); ++d)
        motion_.by[d](row, column) = rests ? directions_[d].delta[observed_[o].mass] : 0.0;
    }
  }
}

}  // namespace frahm::transient
