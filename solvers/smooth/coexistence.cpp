#include "solvers/smooth/coexistence.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/orbits/period_multiple.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/orbits/repeatable_numbers.hpp"
#include "solvers/smooth/equivalent_response.hpp"

namespace frahm::smooth {

void Coexistence::find(const mechanics::LinearSystem& system, const mechanics::NetworkValues& values,
                       Orbit& orbit) {
  system_ = &system;
  values_ = &values;
  stable_.clear();
  found_unstable_ = false;
  unsettled_ = 0;
  passages_ = newton_iterations_ = 0;
  for (const Earlier& earlier : before_) find_near(earlier.z, earlier.multiple);
  const Eigen::VectorXd response = sliding_response();
  for (int start = 0; start < wanted_.starts; ++start)
    unsettled_ += follow(start_state(start, response)) ? 0 : 1;
  add_mirrors();
  before_.clear();
  for (const Found& found : stable_) before_.push_back({found.orbit.z, found.orbit.multiple});
  tell(orbit);
}

// Follows the motion until an orbit is found near it. A period is followed in a twentieth of the time that
// one with its sensitivities takes, so that Newton's method waits longer than for exact laws.
bool Coexistence::follow(Eigen::VectorXd z) {
  constexpr int kTries[] = {12, 36, 108, 324};  // periods
  constexpr double kNear = 0.02, kThere = 1e-3;
  std::vector<Eigen::VectorXd> trail{z};
  int periods = 0;
  for (const int at : kTries) {
    for (; periods < at; ++periods) {
      if (!integrator_.follow(z, 0.0, equation_.period(), scale_of(z))) return false;
      ++passages_;
      trail.push_back(z);
      if (is_known(z, kThere)) return true;
    }
    if (find_near(z, likely_multiple(trail)) && is_known(z, kNear)) return true;
  }
  return false;
}

// The mirror image -z(t + T/2) of each that is not its own, where the forcing is odd and it is an orbit too.
void Coexistence::add_mirrors() {
  constexpr double kSame = 1e-5;  // as of keep()
  if (!system_->odd_forcing) return;
  const std::size_t count = stable_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int multiple = stable_[i].orbit.multiple;
    Eigen::VectorXd z = stable_[i].returns.front();
    if (!integrator_.follow(z, 0.0, 0.5 * equation_.period(), scale_of(z))) continue;
    ++passages_;
    const Eigen::VectorXd mirrored = -z;
    if (is_known(mirrored, kSame)) continue;
    z = mirrored;
    bool is_followed = true;
    for (int m = 0; m < multiple && is_followed; ++m, ++passages_)
      is_followed = integrator_.follow(z, 0.0, equation_.period(), scale_of(z));
    if (!is_followed || equation_.energy_norm(z - mirrored) > kSame * equation_.energy_scale(mirrored))
      continue;
    const std::size_t before = stable_.size();
    find_near(mirrored, multiple);
    // The same peak, so that of the pair the one that was found first counts as the larger.
    if (stable_.size() > before) stable_.back().peak = stable_[i].peak;
  }
}

// The multiple of the period after which the motion comes back closest.
int Coexistence::likely_multiple(const std::vector<Eigen::VectorXd>& trail) const {
  constexpr double kMuchCloser = 0.2, kFollowed = 1e-6;
  const auto gap = [&](int m) {
    return equation_.energy_norm(trail.back() - trail[trail.size() - 1 - static_cast<std::size_t>(m)]);
  };
  const int most = std::min(wanted_.most_multiple, static_cast<int>(trail.size()) - 1);
  int best = 1;
  for (int m = 2; m <= most; ++m) {
    const bool is_back = gap(best) < kFollowed * equation_.energy_scale(trail.back());
    if (!is_back && gap(m) < kMuchCloser * gap(best)) best = m;
  }
  return best;
}

void Coexistence::take_for_one(int multiple) {
  if (multiple > 1) {
    equation_.set(periodic::over_multiple(*system_, multiple), *values_);
  } else {
    equation_.set(*system_, *values_);
  }
}

// Whether Newton's method finds a stable orbit from here. One whose multipliers the sensitivities cannot tell
// from 1 counts as stable: without damping all do.
bool Coexistence::find_near(const Eigen::VectorXd& z, int multiple) {
  constexpr double kOfSensitivities = 1e-6;
  Orbit orbit;
  orbit.z = z;
  orbit.multiple = multiple;
  if (multiple > 1) take_for_one(multiple);
  shooting_.find(scale_of(z), orbit);
  passages_ += multiple * orbit.passages;
  newton_iterations_ += orbit.newton_iterations;
  const bool is_found = orbit.is_found();
  const bool is_stable = is_found && orbit.floquet_radius() < 1.0 + kOfSensitivities;
  found_unstable_ = found_unstable_ || (is_found && !is_stable);
  const double peak = is_stable ? peak_of(orbit) : 0.0;
  if (multiple > 1) take_for_one(1);
  return is_stable && keep(orbit, peak);
}

// Adds a stable orbit to those known. False where a multiple of the period is that of a shorter orbit.
bool Coexistence::keep(Orbit& orbit, double peak) {
  constexpr double kSame = 1e-5;  // of the tolerance to which motions are followed
  if (is_known(orbit.z, kSame)) return true;
  Found found;
  found.returns.push_back(orbit.z);
  for (int m = 1; m < orbit.multiple; ++m) {
    Eigen::VectorXd next = found.returns.back();
    if (!integrator_.follow(next, 0.0, equation_.period(), scale_of(next))) return false;
    ++passages_;
    if (equation_.energy_norm(next - orbit.z) < kSame * equation_.energy_scale(orbit.z)) return false;
    found.returns.push_back(next);
  }
  found.orbit = std::move(orbit);
  found.peak = peak;
  stable_.push_back(std::move(found));
  return true;
}

Eigen::VectorXd Coexistence::scale_of(const Eigen::VectorXd& z) const {
  const Eigen::Index n = equation_.masses();
  return equation_.scale(z.head(n).cwiseAbs().maxCoeff(), z.segment(n, n).cwiseAbs().maxCoeff());
}

// At the integrator's steps.
double Coexistence::peak_of(const Orbit& orbit) const {
  const Trajectory& trajectory = orbit.passage.trajectory;
  Eigen::VectorXd z;
  double peak = 0.0;
  for (std::size_t i = 0; i < trajectory.steps().size(); ++i) {
    trajectory.state(i, trajectory.steps()[i].end, z);
    peak = std::max(peak, std::abs(z[0]));
  }
  return peak;
}

bool Coexistence::is_known(const Eigen::VectorXd& z, double within) const {
  const auto is_near = [&](const Eigen::VectorXd& state) {
    return equation_.energy_norm(z - state) < within * equation_.energy_scale(state);
  };
  return std::ranges::any_of(stable_,
                             [&](const Found& found) { return std::ranges::any_of(found.returns, is_near); });
}

// The response with dampers in place of the friction, where that slides; at rest where there is none.
Eigen::VectorXd Coexistence::sliding_response() const {
  auto found = equivalent_start(equation_, Equivalents::from_sliding);
  if (!found) found = equivalent_start(equation_, Equivalents::from_rest);
  return found.value_or(Eigen::VectorXd::Zero(equation_.size()));
}

// That response, rest, and states of several times its displacements, some of them as far as the laws begin
// to bend.
Eigen::VectorXd Coexistence::start_state(int index, const Eigen::VectorXd& response) const {
  constexpr double kReach[] = {1.5, 4.0, 8.0}, kBeyondBend = 1.5;
  if (index == 0) return response;
  const Eigen::Index n = equation_.masses();
  const double size = std::max(response.head(n).cwiseAbs().maxCoeff(), equation_.static_displacement());
  Eigen::VectorXd z = Eigen::VectorXd::Zero(equation_.size());
  if (index == 1) return z;
  const int kind = index % 3;
  double reach = size * kReach[kind];
  if (kind == 2) reach = std::max(reach, kBeyondBend * equation_.bent_displacement());
  periodic::RepeatableNumbers numbers(index);
  const double rate = equation_.lowest_rate();
  for (Eigen::Index i = 0; i < n; ++i) z[i] = reach * numbers.next();
  for (Eigen::Index i = 0; i < n; ++i) z[n + i] = reach * rate * numbers.next();
  return z;
}

void Coexistence::tell(Orbit& orbit) {
  if (stable_.empty()) {
    orbit = Orbit{};
    const bool was_ended = integrator_.work().is_over();
    orbit.status = was_ended ? Status::failed : Status::not_periodic;
    orbit.reason = was_ended ? periodic::kSearchIsLong
                             : periodic::none_stable(wanted_.starts, wanted_.most_multiple, found_unstable_);
    orbit.residual = kNone;
    orbit.coexisting = 0;
    orbit.unsettled = unsettled_;
  } else {
    const bool largest = wanted_.show == periodic::OrbitsWanted::Show::largest;
    const auto reported = std::ranges::max_element(
        stable_, {}, [&](const Found& found) { return largest ? found.peak : -found.peak; });
    return tell(static_cast<std::size_t>(reported - stable_.begin()), orbit);
  }
  orbit.passages = passages_;
  orbit.newton_iterations = newton_iterations_;
}

void Coexistence::tell(std::size_t which, Orbit& orbit) {
  orbit = stable_[which].orbit;
  orbit.coexisting = static_cast<int>(stable_.size());
  orbit.unsettled = unsettled_;
  if (orbit.coexisting > 1) orbit.status = Status::several;
  if (orbit.multiple > 1) take_for_one(orbit.multiple);
  orbit.passages = passages_;
  orbit.newton_iterations = newton_iterations_;
}

}  // namespace frahm::smooth
