#include "solvers/branches/branch_map.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "solvers/algebra/eigenvalues.hpp"
#include "solvers/exact/response.hpp"
#include "solvers/exact/rest_search.hpp"
#include "solvers/mechanics/system_derivative.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/period_multiple.hpp"
#include "solvers/orbits/rest_directions.hpp"

namespace frahm::periodic {

BranchMap::BranchMap(const mechanics::Network& network, const ValuesAlong& values, double low, double high)
    : assembly_(network, mechanics::FreeMasses::allowed),
      values_(values),
      low_(low),
      high_(high),
      walk_(flow_),
      steps_(flow_),
      sensitivity_(flow_) {}

void BranchMap::set(double parameter) {
  const mechanics::NetworkValues now = values_.at(parameter);
  const bool same_matrices =
      has_last_ && !assembly_.matrices_depend_on_frequency() && have_same_elements(now, last_);
  has_last_ = false;
  if (!same_matrices) assembly_.set_values(now, system_);
  assembly_.set_forcing(now, system_);
  if (multiple_ > 1) longer_ = over_multiple(system_, multiple_);
  if (!same_matrices) flow_.set_system(system());
  flow_.set_forcing(system());
  last_ = now;
  has_last_ = true;
  at_ = parameter;
}

Eigen::VectorXd BranchMap::begin(const AnyOrbit& orbit) {
  const auto& eq = flow_.equations();
  const Eigen::Index n = eq.masses(), internal = eq.internal_forces();
  multiple_ = orbit.multiple;
  half_period_ = orbit.half_period;
  if (multiple_ > 1) longer_ = over_multiple(system_, multiple_);
  root_.setZero(eq.states(), eq.states());
  root_.topLeftCorner(n, n) = eq.K_root;
  root_.block(n, n, n, n) = eq.M_root * eq.step;
  root_.bottomRightCorner(internal, internal).diagonal() = eq.internal_stiffness.cwiseSqrt().cwiseInverse();
  root_inverse_ = root_.inverse();
  const double size = std::sqrt(2.0) * flow_.energy_scale(orbit.z);
  scale_ = size > 0.0 ? size : 1.0;
  has_last_ = false;
  return place_of(orbit);
}

Eigen::VectorXd BranchMap::place_of(const AnyOrbit& orbit) const {
  const Eigen::Index n = flow_.equations().masses();
  Eigen::VectorXd z = orbit.z;
  z.segment(n, n) /= flow_.equations().step;
  Eigen::VectorXd y(z.size() + 1);
  y << root_ * z / scale_, (at_ - low_) / (high_ - low_);
  return y;
}

Eigen::VectorXd BranchMap::state(const Eigen::VectorXd& y) const {
  const Eigen::Index n = flow_.equations().masses();
  Eigen::VectorXd z = scale_ * (root_inverse_ * y.head(y.size() - 1));
  z.segment(n, n) *= flow_.equations().step;
  return z;
}

// A matrix over states in the units of the flow, over scaled ones.
Eigen::MatrixXd BranchMap::scaled(const Eigen::MatrixXd& by_state) const {
  const Eigen::Index n = flow_.equations().masses();
  const double step = flow_.equations().step;
  Eigen::MatrixXd A = by_state;
  A.middleRows(n, n) /= step;
  A.middleCols(n, n) *= step;
  return root_ * A * root_inverse_;
}

Eigen::VectorXd BranchMap::oscillators_at_section() const {
  Eigen::VectorXd u(flow_.equations().oscillators());
  flow_.equations().oscillators_at(section_, flow_.orders(), u);
  return u;
}

// Contacts that stick throughout keep their rest position (multiplier +1): the residual has no part of it.
Shot BranchMap::pass(const Eigen::VectorXd& y, Tangent tangent) {
  Shot shot;
  shot.failed = true;
  try {
    set(parameter(y));
  } catch (const mechanics::MechanicsError&) {
    return shot;
  }
  const auto& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  const Eigen::VectorXd z = state(y);
  if (!z.allFinite() || eq.period > ShootingOptions{}.most_steps_a_period) return shot;
  steps_.clear();
  walk_.pass(z, section_, length(), shot.passage, tangent, 0, &steps_);
  if (shot.passage.failure != nullptr) return shot;
  shot.failed = false;
  shot.stuck_throughout = stuck_throughout(flow_, shot.passage);
  if (!half_period_ && shot.stuck_throughout != 0)
    shot.to_rest = shift_projector(rest_directions(eq, shot.stuck_throughout));
  Eigen::VectorXd residual = (half_period_ ? -1.0 : 1.0) * shot.passage.end - z;
  if (shot.to_rest.size() > 0) residual -= shot.to_rest * residual;
  shot.closing = closing_of(flow_, shot.passage);
  if (shot.closing.is_modulo()) shot.closing.apply(z, oscillators_at_section(), residual);
  residual.segment(n, n) /= eq.step;
  shot.residual = root_ * residual / scale_;
  return shot;
}

Shot BranchMap::shoot(const Eigen::VectorXd& y) {
  Shot shot = pass(y, Tangent::followed);
  if (shot.failed) return shot;
  Eigen::MatrixXd A = (half_period_ ? -1.0 : 1.0) * shot.passage.tangent;
  shot.closing.project(A);
  A.diagonal().array() -= 1.0;
  if (shot.to_rest.size() > 0) A -= shot.to_rest;
  shot.derivative.resize(y.size() - 1, y.size());
  shot.derivative << scaled(A), by_parameter(shot);
  shot.failed = !shot.derivative.allFinite();
  return shot;
}

// Of the residual by the parameter, scaled, from a state whose velocity in SI does not change: counted in
// steps it is  v h, which grows by (v h) dh/h.
Eigen::VectorXd BranchMap::by_parameter(const Shot& shot) {
  const auto& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  mechanics::LinearSystem system_by;
  mechanics::differentiate(assembly_, last_, values_.derivative(at_), system(), system_by);
  StepDerivative<kAnySize, kAnySize> by;
  by.set(eq, system(), system_by);
  sensitivity_.set_direction(by);
  for (auto& step : steps_.steps()) steps_.expand(step);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(eq.states());
  start.segment(n, n) = by.log_step * shot.passage.segments.front().z.segment(n, n);
  Eigen::VectorXd end = sensitivity_.carry(steps_.steps(), shot.passage.changes, start);
  const double sign = half_period_ ? -1.0 : 1.0;
  end *= sign;
  if (shot.closing.is_modulo())
    shot.closing.apply_change(eq, by, shot.passage.segments.front().z, oscillators_at_section(), end);
  end.segment(n, n) = (end.segment(n, n) - sign * by.log_step * shot.passage.end.segment(n, n)) / eq.step;
  if (shot.to_rest.size() > 0) end -= shot.to_rest * end;
  return (high_ - low_) / scale_ * (root_ * end);
}

AnyOrbit BranchMap::orbit(const Eigen::VectorXd& y, Shot&& shot) {
  AnyOrbit orbit;
  orbit.z = state(y);
  orbit.section = section_;
  orbit.half_period = half_period_;
  orbit.multiple = multiple_;
  orbit.passage = std::move(shot.passage);
  orbit.stuck_throughout = shot.stuck_throughout;
  orbit.closing = shot.closing;
  orbit.residual = shot.residual.norm() / std::max(1.0, y.head(y.size() - 1).norm());
  orbit.status = orbit.passage.margin < kGrazing ? Status::grazing : Status::ok;
  judge_stability(flow_, orbit);
  return orbit;
}

Eigen::VectorXd BranchMap::at_rest_in_the_middle(const Eigen::VectorXd& y) {
  Shot shot = pass(y, Tangent::followed);
  if (shot.failed) return {};
  AnyOrbit there = orbit(y, std::move(shot));
  if (!RestSearch<kAnySize, kAnySize>(assembly_, flow_).shift_to_middle(there)) return {};
  return place_of(there);
}

Eigen::VectorXd BranchMap::moved(const Eigen::VectorXd& y, double section) {
  set(parameter(y));
  const Eigen::Index n = flow_.equations().masses();
  const double turn = 2.0 * std::numbers::pi;
  const double ahead = section > section_ ? section - section_ : section - section_ + turn;
  AnyPassage passage;
  walk_.pass(state(y), section_, ahead / flow_.fundamental_rate(), passage, Tangent::none);
  if (passage.failure != nullptr) return {};
  Eigen::VectorXd z = passage.end;
  z.segment(n, n) /= flow_.equations().step;
  Eigen::VectorXd there = y;
  there.head(z.size()) = root_ * z / scale_;
  return there;
}

Eigen::VectorXd BranchMap::gap_after(int part, const Eigen::VectorXd& y) {
  set(parameter(y));
  AnyPassage passage;
  const Eigen::VectorXd z = state(y);
  walk_.pass(z, section_, length() / part, passage, Tangent::none);
  if (passage.failure != nullptr) return {};
  const Eigen::Index n = flow_.equations().masses();
  Eigen::VectorXd gap = passage.end - z;
  closing_of(flow_, passage).remove(gap);
  gap.segment(n, n) /= flow_.equations().step;
  return root_ * gap / scale_;
}

std::optional<double> BranchMap::better_section(const Shot& shot) const {
  constexpr double kNear = 0.02, kFar = 0.05;  // of the length
  const auto& segments = shot.passage.segments;
  if (segments.size() < 2) return std::nullopt;
  const double first = segments.front().length, last = segments.back().length;
  if (std::min(first, last) > kNear * length()) return std::nullopt;
  const auto longest = std::ranges::max_element(segments, {}, &Segment<kAnySize, kAnySize>::length);
  if (0.5 * longest->length < kFar * length()) return std::nullopt;
  return middle_of(*longest);
}

// As omega t [rad].
double BranchMap::middle_of(const Segment<kAnySize, kAnySize>& stretch) const {
  const double middle = stretch.start + 0.5 * stretch.length;
  return std::fmod(section_ + middle * flow_.fundamental_rate(), 2.0 * std::numbers::pi);
}

int BranchMap::slipping_sliders(const Segment<kAnySize, kAnySize>& stretch) const {
  int slipping = 0;
  for (Eigen::Index j = 0; j < flow_.equations().contacts(); ++j)
    slipping += flow_.equations().holds(j) || flow_.rests(flow_.mode(stretch.mode), j) ? 0 : 1;
  return slipping;
}

std::optional<double> BranchMap::section_of_least_slip(const Eigen::VectorXd& y) {
  const Shot shot = pass(y, Tangent::none);
  if (shot.failed) return std::nullopt;
  const auto& segments = shot.passage.segments;
  const auto fewer_then_longer = [this](const auto& a, const auto& b) {
    const int slip_a = slipping_sliders(a), slip_b = slipping_sliders(b);
    return slip_a != slip_b ? slip_a < slip_b : a.length > b.length;
  };
  const auto best = std::ranges::min_element(segments, fewer_then_longer);
  if (slipping_sliders(*best) >= slipping_sliders(segments.front())) return std::nullopt;
  return middle_of(*best);
}

Eigen::VectorXcd BranchMap::multipliers(const Shot& shot) {
  const Eigen::MatrixXd moving =
      moving_part(flow_, shot.passage.tangent, shot.stuck_throughout, shot.closing);
  Eigen::VectorXcd values = algebra::eigenvalues(moving);
  if (half_period_) values = values.array().square();
  std::ranges::sort(values, [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return values;
}

}  // namespace frahm::periodic
