#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/events/box_minimum.hpp"
#include "solvers/flow/configuration.hpp"
#include "solvers/flow/equations.hpp"

// The exact flow of a network with Coulomb friction. Between events the system is linear and its flow is an
// exponential; events are the zeros of sliding velocities and the instants at which a stuck contact's force
// reaches its limit. Time is counted in steps (StepEquations).
namespace frahm::periodic {

// Which contacts stick and in which direction the others slide, with the friction forces that follow.
template <int N, int H>
struct Mode {
  ContactMask stuck = 0, positive = 0;  // positive: sliding with w^T q' > 0
  std::size_t configuration = 0;
  typename Sizes<N, H>::Contacts friction;     // sigma_j F_j of the sliding contacts [N]
  typename Sizes<N, H>::Vector acceleration;   // Af * friction
  typename Sizes<N, H>::State step;            // Ef * friction
  typename Sizes<N, H>::Series series;         // series_f * friction
  typename Sizes<N, H>::Contacts stuck_force;  // Lf * friction

  double sign(Eigen::Index contact) const { return contains(positive, contact) ? 1.0 : -1.0; }
};

// A stretch of an orbit in one mode.
template <int N, int H>
struct Segment {
  double start = 0.0, length = 0.0;  // [steps]
  std::size_t mode = 0;
  typename Sizes<N, H>::State z;  // at its start
};

// State, acceleration and forcing at one instant.
template <int N, int H>
struct Instant {
  typename Sizes<N, H>::State z;
  typename Sizes<N, H>::Vector a;
  typename Sizes<N, H>::Internal ds;  // rate of the Maxwell forces [N a step]
  typename Sizes<N, H>::Oscillators u, du;
};

// Taylor polynomials of state and oscillators over the step that starts at an instant, a column each.
template <int N, int H>
struct Expansion {
  typename Sizes<N, H>::StatePolynomials z;
  typename Sizes<N, H>::OscillatorPolynomials u;

  // sum_i weight_i * polynomial of displacement i
  template <class Weights>
  Polynomial displacement(const Weights& weight) const {
    return z.leftCols(weight.size()) * weight;
  }
  template <class Weights>
  Polynomial velocity(const Weights& weight) const {
    return z.middleCols(weight.size(), weight.size()) * weight;
  }
  template <class Weights>
  Polynomial internal_force(const Weights& weight) const {
    return z.rightCols(weight.size()) * weight;
  }
};

// The flow over a stretch of time from one state.
template <int N, int H>
struct Passage {
  typename Sizes<N, H>::State end;
  typename Sizes<N, H>::StateSquare tangent;  // d end / d start, product of flow and saltation matrices
  std::vector<Segment<N, H>> segments;
  int events = 0;
  double margin = 1.0;  // how far the nearest event is from happening otherwise, relative; 0 = grazing
  bool starts_at_event = false;   // a contact comes through rest at the very start, outside the tangent
  const char* failure = nullptr;  // why the passage could not be completed
};

template <int N, int H>
class Flow {
 public:
  using S = Sizes<N, H>;

  // Matrices and friction limits; call set_forcing before the next passage.
  void set_system(const mechanics::LinearSystem& system);
  void set_forcing(const mechanics::LinearSystem& system);
  // Each harmonic's cos + i sin at phase 0, in the order of the system's, in the place of 1, until the next
  // set_forcing: the same forcing with other amplitudes and phases, without any of its matrices anew.
  void set_oscillators(std::span<const std::complex<double>> at_zero) {
    equations_.oscillators_at_zero.assign(at_zero.begin(), at_zero.end());
  }

  // The flow from state z at `phase` (omega t) [rad] over `length` steps.
  void pass(const typename S::State& z, double phase, double length, Passage<N, H>& passage);

  // Contacts that stick whatever their force, to try whether they stick throughout. None by default.
  void hold_contacts(ContactMask contacts) { held_ = contacts; }
  // z with the velocities of these contacts' rest at `phase`.
  typename S::State brought_to_rest(const typename S::State& z, double phase, ContactMask contacts);

  const StepEquations<N, H>& equations() const { return equations_; }
  const std::vector<int>& orders() const { return orders_; }
  const Mode<N, H>& mode(std::size_t index) const { return modes_[index]; }
  const Configuration<N, H>& configuration(const Mode<N, H>& mode) const {
    return configurations_[mode.configuration];
  }
  double fundamental_rate() const { return fundamental_rate_; }  // omega h [rad a step]
  // The energy norm of the static response to the excitation's amplitudes [sqrt(J)].
  double static_norm() const { return static_norm_; }

  void instant_at(const typename S::State& z, double phase, const Mode<N, H>& mode, Instant<N, H>& at) const;
  void accelerate(const Mode<N, H>& mode, Instant<N, H>& at) const;
  // `to` = `from` one step later in the same mode.
  void step(const Instant<N, H>& from, const Mode<N, H>& mode, Instant<N, H>& to) const;
  void expand(const Instant<N, H>& at, const Mode<N, H>& mode, Expansion<N, H>& expansion) const;
  static void evaluate(const Expansion<N, H>& expansion, double s, typename S::State& z);
  // The state `elapsed` steps after the start of a segment of a passage that began at phase `section`.
  typename S::State state_within(const Segment<N, H>& segment, double section, double elapsed) const;
  ValueAndSlope sliding_speed(const Instant<N, H>& at, Eigen::Index contact) const;
  ValueAndSlope stuck_force(const Instant<N, H>& at, const Mode<N, H>& mode, Eigen::Index contact) const;

 private:
  struct Event {
    double at = 2.0;  // step fraction; beyond 1: none
    Eigen::Index contact = 0;
    bool release = false;  // a stuck contact lets go; otherwise a sliding one comes to rest
  };

  void scale_matrices(const mechanics::LinearSystem& system);
  std::size_t mode_index(ContactMask stuck, ContactMask positive);
  std::size_t configuration_index(ContactMask stuck);
  void set_scales(const typename S::State& z);

  void enter(const typename S::State& z, double phase, Passage<N, H>& passage);
  Event first_event(Passage<N, H>& passage);
  double first_stop(Eigen::Index contact, Passage<N, H>& passage);
  double first_release(Eigen::Index contact, Passage<N, H>& passage);
  double first_crossing(const Polynomial& p, double scale, Passage<N, H>& passage) const;
  double first_lasting_fall(const Polynomial& p, double limit, Passage<N, H>& passage) const;
  const Expansion<N, H>& expansion();
  void advance(double fraction, Passage<N, H>& passage);
  void pass_event(const Event& event, double phase, Passage<N, H>& passage);
  ContactMask arrivals(const Event& event) const;
  void choose_modes(ContactMask at_rest, Passage<N, H>& passage);
  void release_at_limits();
  void saltate(ContactMask arrived, const Instant<N, H>& before, const Mode<N, H>& mode_before,
               Passage<N, H>& passage);
  void open_segment(Passage<N, H>& passage);

  StepEquations<N, H> equations_;
  std::vector<Configuration<N, H>> configurations_;
  std::vector<Mode<N, H>> modes_;
  std::vector<int> orders_;
  std::vector<double> rotation_;             // cos, sin of each phase rate
  std::vector<Polynomial> rotation_series_;  // their Taylor polynomials over a step
  double fastest_rate_ = 0.0;
  double fundamental_rate_ = 0.0;
  double static_norm_ = 0.0;
  bool matrices_changed_ = true;
  bool moving_support_ = false;  // some contact rubs on a prescribed node

  ContactMask held_ = 0;

  // Of the passage in hand.
  typename S::Contacts speed_scale_, force_scale_;
  Instant<N, H> left_, right_;
  Expansion<N, H> expansion_;
  bool expanded_ = false;
  std::size_t mode_ = 0;
  double clock_ = 0.0;             // steps since the passage began
  ContactMask fresh_ = 0;          // sliding contacts whose velocity is zero at left_
  ContactMask just_released_ = 0;  // those whose relative acceleration is zero there too
};

// Relative tolerances of switching. A contact is at rest below kRest of the velocity scale; ties between
// sticking and sliding within kTie go to sticking, else zero-length slips would chatter for ever.
inline constexpr double kRest = 1e-11;
inline constexpr double kTie = 1e-12;

}  // namespace frahm::periodic

#include "solvers/flow/flow_setup.ipp"
#include "solvers/flow/flow_steps.ipp"
#include "solvers/events/switching.ipp"
