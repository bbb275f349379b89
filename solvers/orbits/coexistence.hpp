#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/steady_response.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/orbits/repeatable_numbers.hpp"
#include "solvers/orbits/shooting.hpp"

// Orbits of a system whose laws are not all monotone: several may be stable, some take a multiple of the
// forcing's period, and none may be periodic at all. The search follows motions from many starts until they
// come near an orbit, which Newton's method then finds. It may miss one.
namespace frahm::periodic {

// The same motion with m periods taken for one: m times the orders at a frequency m times lower.
inline mechanics::LinearSystem over_multiple(const mechanics::LinearSystem& system, int multiple) {
  mechanics::LinearSystem longer = system;
  longer.omega /= multiple;
  longer.reference_order *= multiple;
  for (int& order : longer.orders) order *= multiple;
  return longer;
}

template <int N, int H>
class Coexistence {
 public:
  using S = Sizes<N, H>;
  // Of an orbit of the flow: moves it to its rest position; the peak of the first mass [m].
  using Settle = std::function<void(Orbit<N, H>&)>;
  using PeakOf = std::function<double(const Orbit<N, H>&)>;

  Coexistence(Flow<N, H>& flow, Settle settle, PeakOf peak_of, const OrbitsWanted& wanted = {})
      : flow_(flow), walk_(flow), shooting_(flow), settle_(settle), peak_of_(peak_of), wanted_(wanted) {}

  void forget() { before_.clear(); }
  // Finds the orbit to be told; the flow, which is set to `system`, is then set to its multiple of the
  // period.
  void find(const mechanics::LinearSystem& system, Orbit<N, H>& orbit);

 private:
  struct Found {
    Orbit<N, H> orbit;
    std::vector<typename S::State> returns;  // its states at phase 0, after each period
    double peak = 0.0;                       // of the first mass [m]
  };
  // An orbit of the point before, in SI.
  struct Earlier {
    typename S::State z;
    int multiple = 1;
  };

  void follow(typename S::State z, const mechanics::LinearSystem& system);
  int likely_multiple(const std::vector<typename S::State>& trail) const;
  bool find_near(const typename S::State& z, int multiple, const mechanics::LinearSystem& system);
  bool keep(Orbit<N, H>& orbit, double peak);
  double distance(const typename S::State& z, const Found& found) const;
  bool is_known(const typename S::State& z, double within) const;
  typename S::State random_start(int index, const mechanics::LinearSystem& system);
  void tell(const mechanics::LinearSystem& system, Orbit<N, H>& orbit);
  void remember();

  Flow<N, H>& flow_;
  Walk<N, H> walk_;
  Shooting<N, H> shooting_;
  Settle settle_;
  PeakOf peak_of_;
  OrbitsWanted wanted_;

  std::vector<Earlier> before_;  // of the point before
  std::vector<Found> stable_;    // of this point
  bool found_unstable_ = false;
  int passages_ = 0, newton_iterations_ = 0;
  Passage<N, H> passage_;
};

template <int N, int H>
void Coexistence<N, H>::find(const mechanics::LinearSystem& system, Orbit<N, H>& orbit) {
  flow_.set_forcing(system);
  stable_.clear();
  found_unstable_ = false;
  passages_ = newton_iterations_ = 0;
  for (const Earlier& earlier : before_) {
    typename S::State z = earlier.z;
    z.segment(system.masses(), system.masses()) *= flow_.equations().step;
    find_near(z, earlier.multiple, system);
  }
  for (int start = 0; start < wanted_.starts; ++start) follow(random_start(start, system), system);
  remember();
  tell(system, orbit);
}

// Follows the motion until an orbit is found near it.
template <int N, int H>
void Coexistence<N, H>::follow(typename S::State z, const mechanics::LinearSystem& system) {
  constexpr int kTries[] = {4, 12, 36, 108, 324};  // periods
  constexpr double kNear = 0.02, kThere = 1e-4;
  std::vector<typename S::State> trail{z};
  int periods = 0;
  for (const int at : kTries) {
    for (; periods < at; ++periods) {
      walk_.pass(z, 0.0, flow_.equations().period, passage_, Tangent::none);
      ++passages_;
      if (passage_.failure != nullptr) return;
      z = passage_.end;
      trail.push_back(z);
      if (is_known(z, kThere)) return;
    }
    if (find_near(z, likely_multiple(trail), system) && is_known(z, kNear)) return;
  }
}

// The multiple of the period after which the motion comes back closest.
template <int N, int H>
int Coexistence<N, H>::likely_multiple(const std::vector<typename S::State>& trail) const {
  constexpr double kMuchCloser = 0.2, kRounding = 1e-9;
  const auto gap = [&](int m) {
    return flow_.equations().energy_norm(trail.back() -
                                         trail[trail.size() - 1 - static_cast<std::size_t>(m)]);
  };
  const int most = std::min(wanted_.most_multiple, static_cast<int>(trail.size()) - 1);
  int best = 1;
  for (int m = 2; m <= most; ++m) {
    const bool is_back = gap(best) < kRounding * flow_.energy_scale(trail.back());
    if (!is_back && gap(m) < kMuchCloser * gap(best)) best = m;
  }
  return best;
}

// Whether Newton's method finds a stable orbit from here.
template <int N, int H>
bool Coexistence<N, H>::find_near(const typename S::State& z, int multiple,
                                  const mechanics::LinearSystem& system) {
  Orbit<N, H> orbit;
  orbit.z = z;
  orbit.multiple = multiple;
  if (multiple > 1) flow_.set_forcing(over_multiple(system, multiple));
  shooting_.find(orbit);
  passages_ += multiple * orbit.passages;
  newton_iterations_ += orbit.newton_iterations;
  bool is_stable = false;
  if (orbit.is_found()) {
    if (orbit.stuck_throughout != 0) settle_(orbit);
    judge_stability(flow_, orbit);
    is_stable = orbit.is_stable() || std::isnan(orbit.floquet_radius);
    found_unstable_ = found_unstable_ || !is_stable;
  }
  const double peak = is_stable ? peak_of_(orbit) : 0.0;
  if (multiple > 1) flow_.set_forcing(system);
  return is_stable && keep(orbit, peak);
}

// Adds a stable orbit to those known. False where a multiple of the period is that of a shorter orbit.
template <int N, int H>
bool Coexistence<N, H>::keep(Orbit<N, H>& orbit, double peak) {
  constexpr double kSame = 1e-7;
  if (is_known(orbit.z, kSame)) return true;
  Found found;
  found.returns.push_back(orbit.z);
  for (int m = 1; m < orbit.multiple; ++m) {
    walk_.pass(found.returns.back(), 0.0, flow_.equations().period, passage_, Tangent::none);
    ++passages_;
    if (passage_.failure != nullptr) return false;
    const double gap = flow_.equations().energy_norm(passage_.end - orbit.z);
    if (gap < kSame * flow_.energy_scale(orbit.z)) return false;
    found.returns.push_back(passage_.end);
  }
  found.orbit = std::move(orbit);
  found.peak = peak;
  stable_.push_back(std::move(found));
  return true;
}

template <int N, int H>
double Coexistence<N, H>::distance(const typename S::State& z, const Found& found) const {
  double least = HUGE_VAL;
  for (const auto& state : found.returns)
    least = std::min(least, flow_.equations().energy_norm(z - state) / flow_.energy_scale(state));
  return least;
}

template <int N, int H>
bool Coexistence<N, H>::is_known(const typename S::State& z, double within) const {
  return std::ranges::any_of(stable_, [&](const Found& found) { return distance(z, found) < within; });
}

// The linear response, rest, and states of several times their displacements and the places of the bends.
template <int N, int H>
typename Sizes<N, H>::State Coexistence<N, H>::random_start(int index,
                                                            const mechanics::LinearSystem& system) {
  constexpr double kReach[] = {1.5, 4.0, 8.0};
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  typename S::State z = mechanics::steady_response(system, 0.0);
  z.segment(n, n) *= eq.step;
  if (!z.allFinite()) z.setZero();
  if (index == 0) return z;
  const double places = eq.bends.count() > 0 ? eq.bends.place.cwiseAbs().maxCoeff() : 0.0;
  const double at_rest = (eq.K_inverse * eq.force).cwiseAbs().rowwise().sum().maxCoeff();
  const double size = std::max({z.head(n).cwiseAbs().maxCoeff(), places, at_rest});
  z.setZero();
  if (index == 1) return z;
  RepeatableNumbers numbers(index);
  const double reach = size * kReach[index % 3];
  for (Eigen::Index i = 0; i < n; ++i) z[i] = reach * numbers.next();
  for (Eigen::Index i = 0; i < n; ++i) z[n + i] = reach * flow_.fundamental_rate() * numbers.next();
  return z;
}

// The orbit that is told, found once more in its own multiple of the period.
template <int N, int H>
void Coexistence<N, H>::tell(const mechanics::LinearSystem& system, Orbit<N, H>& orbit) {
  orbit.passages = passages_;
  orbit.newton_iterations = newton_iterations_;
  orbit.coexisting = static_cast<int>(stable_.size());
  if (stable_.empty()) {
    orbit.status = Status::not_periodic;
    orbit.reason = none_stable(wanted_.starts, wanted_.most_multiple, found_unstable_);
    orbit.residual = kNone;
    return;
  }
  const bool largest = wanted_.show == OrbitsWanted::Show::largest;
  const Found& told = *std::ranges::max_element(
      stable_, {}, [&](const Found& found) { return largest ? found.peak : -found.peak; });
  if (told.orbit.multiple > 1) flow_.set_forcing(over_multiple(system, told.orbit.multiple));
  const int passages = passages_, iterations = newton_iterations_, coexisting = orbit.coexisting;
  orbit = told.orbit;
  shooting_.find(orbit);
  if (orbit.stuck_throughout != 0) settle_(orbit);
  judge_stability(flow_, orbit);
  orbit.passages += passages;
  orbit.newton_iterations += iterations;
  orbit.coexisting = coexisting;
  if (coexisting > 1 && orbit.status == Status::ok) orbit.status = Status::several;
}

template <int N, int H>
void Coexistence<N, H>::remember() {
  const Eigen::Index n = flow_.equations().masses();
  before_.clear();
  for (const Found& found : stable_) {
    before_.push_back({found.orbit.z, found.orbit.multiple});
    before_.back().z.segment(n, n) /= flow_.equations().step;
  }
}

}  // namespace frahm::periodic
