#include "solvers/transient/largest_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "solvers/quantities/trace_scan.hpp"

namespace frahm::transient {
namespace {

using Eigen::Index;
using periodic::TraceKind, periodic::ValueAndSlope, periodic::Polynomial;

constexpr double kOfCubic = 1.0 / 384.0, kOfSlope = 1.7320508075688772 / 216.0;

double sum_over(const std::vector<Index>& masses, const Eigen::VectorXd& w, const auto& values) {
  double sum = 0.0;
  for (const Index i : masses) sum += w[i] * values[i];
  return sum;
}

// A bound of the trace's size within a step.  fourth: of the fourth derivative of what the ends are of.
double bound(TraceKind kind, ValueAndSlope left, ValueAndSlope right, double length, double fourth) {
  if (kind == TraceKind::acceleration) {
    const double middle = 3.0 * (right.value - left.value) / length - left.slope - right.slope;
    return std::max({std::abs(left.slope), std::abs(middle), std::abs(right.slope)}) +
           kOfSlope * fourth * length * length * length;
  }
  const double b1 = left.value + left.slope * length / 3.0, b2 = right.value - right.slope * length / 3.0;
  return std::max({std::abs(left.value), std::abs(b1), std::abs(b2), std::abs(right.value)}) +
         kOfCubic * fourth * length * length * length * length;
}

// Whether the derivative of a displacement or velocity keeps its sign within the step.
bool is_monotone(ValueAndSlope left, ValueAndSlope right, double length, double fourth) {
  const double middle = 3.0 * (right.value - left.value) / length - left.slope - right.slope;
  const double slack = kOfSlope * fourth * length * length * length;
  const double least = std::min({left.slope, middle, right.slope});
  const double most = std::max({left.slope, middle, right.slope});
  return least > slack || most < -slack;
}

// int_0^L p(s)^2 ds = L q^T H q  with  q_k = p_k L^k  and Hilbert's matrix  H_jk = 1/(j + k + 1).
double integral_of_square(const Polynomial& p, double length) {
  static const Eigen::MatrixXd hilbert =
      Eigen::MatrixXd::NullaryExpr(periodic::kTerms, periodic::kTerms,
                                   [](Index j, Index k) { return 1.0 / static_cast<double>(j + k + 1); });
  const Polynomial q = p.cwiseProduct(periodic::powers(length));
  return length * q.dot(hilbert * q);
}

}  // namespace

std::size_t LargestValues::add(TraceKind kind, const mechanics::Incidence& at, bool mean_square) {
  const auto same = std::ranges::find_if(followed_, [&](const Followed& each) {
    return each.kind == kind && each.at.w == at.w && each.at.p == at.p && each.at.j == at.j;
  });
  if (same != followed_.end()) {
    same->has_square = same->has_square || mean_square;
    return static_cast<std::size_t>(same - followed_.begin());
  }
  Followed followed{.kind = kind, .at = at, .masses = {}, .of_u = {}, .of_du = {}, .of_ddu = {}, .joint = {}};
  followed.has_square = mean_square;
  for (Index i = 0; i < at.w.size(); ++i) {
    if (at.w[i] != 0.0) followed.masses.push_back(i);
  }
  followed_.push_back(std::move(followed));
  return followed_.size() - 1;
}

void LargestValues::set_system(const Flow& flow) {
  const auto& eq = flow.equations();
  for (Followed& each : followed_) {
    if (each.at.has_joint()) {
      each.joint = {periodic::displacement_row(eq, each.at), periodic::velocity_row(eq, each.at)};
      each.speed = periodic::largest_rate(eq, each.joint.velocity);
      each.support_speed = each.joint.velocity.u.cwiseAbs().sum();
      continue;
    }
    const auto& [w, p, j] = each.at;
    each.speed = std::sqrt(2.0 * w.dot(eq.M_inverse * w));
    each.support_speed = 0.0;
    const bool moves = p.size() > 0 && !p.isZero(0.0);
    each.of_u = moves ? Eigen::VectorXd(eq.motion.transpose() * p) : Eigen::VectorXd();
    if (!moves) continue;
    each.of_du = eq.motion_velocity.transpose() * p;
    each.of_ddu = eq.motion_acceleration.transpose() * p;
    each.support_speed = p.cwiseAbs().dot(eq.motion_velocity.cwiseAbs().rowwise().sum());
  }
}

// Value and slope of the displacement, or of the velocity: the row of its velocities meets (v, a, s').
ValueAndSlope LargestValues::at_joint(const Followed& followed, const Instant& instant) {
  const auto& [displacement, velocity] = followed.joint;
  const double v = velocity.z.dot(instant.z) + velocity.u.dot(instant.u);
  if (followed.kind == TraceKind::displacement)
    return {displacement.z.dot(instant.z) + displacement.u.dot(instant.u), v};
  const Index n = instant.a.size();
  return {v, velocity.z.segment(n, n).dot(instant.a) + velocity.z.tail(instant.ds.size()).dot(instant.ds) +
                 velocity.u.dot(instant.du)};
}

LargestValues::Ends LargestValues::ends_of(const Followed& followed, const Step& step) {
  const Index n = followed.at.w.size();
  const auto at = [&](const Instant& instant) {
    if (followed.at.has_joint()) return at_joint(followed, instant);
    const auto sum = [&](const auto& values) { return sum_over(followed.masses, followed.at.w, values); };
    const bool moves = followed.of_u.size() > 0;
    const double v = sum(instant.z.segment(n, n)) + (moves ? followed.of_du.dot(instant.u) : 0.0);
    if (followed.kind == TraceKind::displacement)
      return ValueAndSlope{sum(instant.z.head(n)) + (moves ? followed.of_u.dot(instant.u) : 0.0), v};
    return ValueAndSlope{v, sum(instant.a) + (moves ? followed.of_ddu.dot(instant.u) : 0.0)};
  };
  return {at(step.left), at(step.right)};
}

// The first of values equal to 1e-12 has the time.
void LargestValues::consider(double value, double time, Followed& followed) {
  constexpr double kEqual = 1e-12;
  const double size = std::abs(value);
  if (size > followed.reached * (1.0 + kEqual)) {
    followed.reached = size;
    followed.largest.time = time;
  }
  if (size > std::abs(followed.largest.displacement)) followed.largest.displacement = value;
}

// In the units of the step.
Polynomial LargestValues::polynomial_of(const Followed& followed, const Steps& steps, Step& step) {
  const auto& x = steps.expand(step);
  const bool is_displacement = followed.kind == TraceKind::displacement;
  const Index first = is_displacement ? 0 : followed.at.w.size();
  Polynomial trace = Polynomial::Zero();
  if (followed.at.has_joint()) {
    const periodic::StateRow& row = is_displacement ? followed.joint.displacement : followed.joint.velocity;
    trace = x.z * row.z + x.u * row.u;
    return followed.kind == TraceKind::acceleration ? periodic::derivative(trace) : trace;
  }
  for (const Index i : followed.masses) trace += followed.at.w[i] * x.z.col(first + i);
  if (followed.of_u.size() > 0) trace += x.u * (is_displacement ? followed.of_u : followed.of_du);
  return followed.kind == TraceKind::acceleration ? periodic::derivative(trace) : trace;
}

void LargestValues::follow(const Flow& flow, const Steps& steps, Step& step, double at, double energy) {
  const double h = flow.equations().step, length = step.length;
  constexpr double rate = periodic::kStepRate, rate3 = rate * rate * rate, rate4 = rate3 * rate;
  for (Followed& each : followed_) {
    const auto [left, right] = ends_of(each, step);
    const bool is_displacement = each.kind == TraceKind::displacement;
    const bool is_acceleration = each.kind == TraceKind::acceleration;
    const double unit = is_displacement ? 1.0 : is_acceleration ? 1.0 / (h * h) : 1.0 / h;
    consider(unit * (is_acceleration ? left.slope : left.value), at, each);
    const double speed = 2.0 * energy * each.speed + each.support_speed;
    const double fourth = speed * (is_displacement ? rate3 : rate4);
    const bool may_exceed =
        unit * bound(each.kind, left, right, length, fourth) > std::abs(each.largest.displacement);
    if (may_exceed && (is_acceleration || !is_monotone(left, right, length, fourth))) {
      const Polynomial trace = polynomial_of(each, steps, step);
      const periodic::Roots stationary = periodic::stationary_points(trace);
      for (int i = 0; i < stationary.count; ++i) {
        const double s = stationary.at[static_cast<std::size_t>(i)];
        if (s < length) consider(unit * periodic::evaluate(trace, s), at + s * h, each);
      }
    }
    consider(unit * (is_acceleration ? right.slope : right.value), at + length * h, each);
    if (each.has_square) {
      each.square += unit * unit * h * integral_of_square(polynomial_of(each, steps, step), length);
      each.time += length * h;
    }
  }
}

}  // namespace frahm::transient
