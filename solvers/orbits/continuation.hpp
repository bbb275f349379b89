#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solvers/mechanics/steady_response.hpp"
#include "solvers/orbits/shooting.hpp"

// Continuation of orbits along the frequency: each search starts from an extrapolation of the orbits before
// it. The section stays away from events.
namespace frahm::periodic {

template <int N, int H>
class Continuation {
 public:
  using S = Sizes<N, H>;

  explicit Continuation(Flow<N, H>& flow) : flow_(flow), shooting_(flow) {}

  // Discards all known orbits: the next search starts from the linear response without friction.
  void forget() {
    shooting_.forget();
    begin_row();
    has_row_start_ = false;
    section_ = 0.0;
  }
  // Starts a new row of frequencies: the next search starts from the orbit that began the row before.
  void begin_row() {
    known_ = 0;
    at_row_start_ = true;
  }

  // Finds the orbit of the flow, which is set to this system.
  void find(const mechanics::LinearSystem& system, Orbit<N, H>& orbit);
  // The same from the response without friction, at this section.
  void find_from(double section, const mechanics::LinearSystem& system, Orbit<N, H>& orbit) {
    orbit.half_period = system.odd_response;
    orbit.section = section;
    orbit.z = response_without_friction(system, section);
    shooting_.find(orbit);
  }

 private:
  struct Known {
    double omega = 0.0;
    typename S::State z;         // displacements [m], velocities [m/s], at the section
    std::uint64_t sequence = 0;  // of the modes the orbit goes through
  };

  void predict(const mechanics::LinearSystem& system, Orbit<N, H>& orbit);
  void find_from_rest(Orbit<N, H>& orbit);
  typename S::State response_without_friction(const mechanics::LinearSystem& system, double phase) const;
  bool move_section(Orbit<N, H>& orbit) const;
  void remember(double omega, const Orbit<N, H>& orbit);
  static std::uint64_t mode_sequence(const Flow<N, H>& flow, const Orbit<N, H>& orbit);

  Flow<N, H>& flow_;
  Shooting<N, H> shooting_;
  static constexpr std::size_t kHistory = 8;
  std::array<Known, kHistory> history_;  // latest first
  std::size_t known_ = 0;
  Known row_start_;
  bool has_row_start_ = false, at_row_start_ = true;
  double section_ = 0.0, row_section_ = 0.0;
};

template <int N, int H>
void Continuation<N, H>::find(const mechanics::LinearSystem& system, Orbit<N, H>& orbit) {
  predict(system, orbit);
  orbit.multiple = orbit.coexisting = 1;
  orbit.unsettled = 0;
  shooting_.find(orbit);
  if (orbit.status == Status::failed && known_ > 0) {  // once more, without the known orbits
    forget();
    predict(system, orbit);
    shooting_.find(orbit);
  }
  if (orbit.status == Status::failed && orbit.passage.failure == nullptr) find_from_rest(orbit);
  if (orbit.status == Status::failed) {
    known_ = 0;
    return;
  }
  const bool moved = move_section(orbit);
  if (moved) {
    shooting_.find(orbit);
    known_ = 0;
    section_ = orbit.section;
    if (orbit.status == Status::failed) return;
  }
  remember(system.omega, orbit);
}

template <int N, int H>
void Continuation<N, H>::predict(const mechanics::LinearSystem& system, Orbit<N, H>& orbit) {
  const Eigen::Index n = flow_.equations().masses();
  const double omega = system.omega;
  orbit.half_period = system.odd_response;
  if (at_row_start_ && has_row_start_) {
    history_[0] = row_start_;
    section_ = row_section_;
    known_ = 1;
  }
  orbit.section = section_;
  // Without friction the linear response is the orbit (the one wanted, if no damping allows several).
  const bool has_friction = (flow_.equations().limit.array() > 0.0).any();
  if (known_ == 0 || !has_friction) {
    orbit.z = response_without_friction(system, orbit.section);
    return;
  }
  // Lagrange's polynomial through the orbits that went through the same modes; of a large system, whose
  // orbits rarely do, at least a straight line through two.
  std::size_t points = flow_.equations().is_large() ? std::min<std::size_t>(known_, 2) : 1;
  while (points < known_ && history_[points].sequence == history_[0].sequence) ++points;
  orbit.z.setZero(flow_.equations().states());
  for (std::size_t i = 0; i < points; ++i) {
    double above = 1.0, below = 1.0;
    for (std::size_t k = 0; k < points; ++k) {
      if (k == i) continue;
      above *= omega - history_[k].omega;
      below *= history_[i].omega - history_[k].omega;
    }
    orbit.z += (above / below) * history_[i].z;
  }
  orbit.z.segment(n, n) *= flow_.equations().step;
}

// Newton's method may lead so far out that friction holds the masses there, and the map brings them back by
// no more than the stroke of a support in a period. From rest the map itself leads to the neighbourhood of
// the orbit.
template <int N, int H>
void Continuation<N, H>::find_from_rest(Orbit<N, H>& orbit) {
  constexpr int kMaps = 16;
  if (!flow_.equations().monotone) return;  // the map does not lead to an orbit by itself
  forget();
  orbit.section = section_;
  orbit.z.setZero();
  shooting_.find(orbit, 0, kMaps);
}

// The steady state without friction; the state at rest if it is not finite. With friction the steady state
// only starts the search, so a very large one is replaced by the state at rest too.
template <int N, int H>
typename Sizes<N, H>::State Continuation<N, H>::response_without_friction(
    const mechanics::LinearSystem& system, double phase) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  typename S::State z = mechanics::steady_response(system, phase);
  z.segment(n, n) *= eq.step;
  const bool is_start = (eq.limit.array() > 0.0).any();
  const double limit = 1e6 * flow_.static_norm();
  if (!z.allFinite() || (is_start && eq.energy_norm(z) > limit)) z.setZero();
  return z;
}

// Moves the section to the middle of the longest stretch without events when an event has come within 2 % of
// the map's length, or within 0.5 % in a large system, whose events are many. Returns whether it did; the
// orbit then holds the state there.
template <int N, int H>
bool Continuation<N, H>::move_section(Orbit<N, H>& orbit) const {
  const double length = (orbit.half_period ? 0.5 : 1.0) * flow_.equations().period;
  const auto& segments = orbit.passage.segments;
  const double first = segments.front().length, last = segments.back().length;
  const double near = (flow_.equations().is_large() ? 0.005 : 0.02) * length;
  const bool near_event = segments.size() > 1 && (first <= near || last <= near);
  if (!near_event && !orbit.passage.starts_at_event) return false;
  if (segments.size() == 1) {
    orbit.z = flow_.state_within(segments.front(), orbit.section, 0.5 * length);
    orbit.section =
        std::fmod(orbit.section + 0.5 * length * flow_.fundamental_rate(), 2.0 * std::numbers::pi);
    return true;
  }

  double longest = first + last, middle = 0.5 * (first - last);
  const Segment<N, H>* in = middle >= 0.0 ? &segments.front() : &segments.back();
  for (std::size_t i = 1; i + 1 < segments.size(); ++i) {
    if (segments[i].length <= longest) continue;
    longest = segments[i].length;
    middle = segments[i].start + 0.5 * longest;
    in = &segments[i];
  }
  if (longest < 0.05 * length) return false;  // events everywhere: no better section
  const double place = middle >= 0.0 ? middle : middle + length;
  orbit.z = flow_.state_within(*in, orbit.section, place - in->start);
  orbit.section = std::fmod(orbit.section + place * flow_.fundamental_rate(), 2.0 * std::numbers::pi);
  return true;
}

template <int N, int H>
void Continuation<N, H>::remember(double omega, const Orbit<N, H>& orbit) {
  const Eigen::Index n = flow_.equations().masses();
  // A repeated frequency discards the older orbits: a polynomial goes through each frequency only once.
  for (std::size_t i = 0; i < known_; ++i) {
    if (history_[i].omega == omega) known_ = i;
  }
  for (std::size_t i = std::min(known_, kHistory - 1); i > 0; --i) history_[i] = history_[i - 1];
  known_ = std::min(known_ + 1, kHistory);
  Known& latest = history_[0];
  latest.omega = omega;
  latest.z = orbit.z;
  latest.z.segment(n, n) /= flow_.equations().step;
  latest.sequence = mode_sequence(flow_, orbit);
  if (at_row_start_) {  // replaces the start of this row, an orbit of another row
    known_ = 1;
    row_start_ = latest;
    row_section_ = section_;
    has_row_start_ = true;
    at_row_start_ = false;
  }
}

template <int N, int H>
std::uint64_t Continuation<N, H>::mode_sequence(const Flow<N, H>& flow, const Orbit<N, H>& orbit) {
  std::uint64_t sequence = 0;
  for (const Segment<N, H>& segment : orbit.passage.segments) {
    const Mode<N, H>& mode = flow.mode(segment.mode);
    sequence = (sequence ^ (mode.stuck * 2 + mode.positive * 0x9E3779B97F4A7C15ULL + 1)) * 0x100000001B3ULL;
    sequence = (sequence ^ mode.beyond) * 0x100000001B3ULL;
  }
  return sequence;
}

}  // namespace frahm::periodic
