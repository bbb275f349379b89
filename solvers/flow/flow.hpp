#pragma once

#include <algorithm>
#include <vector>

#include "solvers/flow/configuration.hpp"
#include "solvers/flow/equations.hpp"
#include "solvers/flow/search_work.hpp"
#include "solvers/flow/tangent_path.hpp"
#include "solvers/mechanics/linear_system.hpp"

// The exact flow of a network whose contacts follow laws that are linear state by state (laws/law.hpp):
// between events the system is linear and its flow an exponential. Time is counted in steps (StepEquations).
//
// A Flow is the system at one set of values and one frequency, with a table of the modes met so far. It
// stores no motion: code that follows a motion has its own workspace (events/passage.hpp).
namespace frahm::periodic {

// The contacts that stick, the directions in which the others slide, and the resulting friction forces.
template <int N, int H>
struct Mode {
  ContactMask stuck = 0, positive = 0;  // positive: sliding with w^T q' > 0
  ContactMask beyond = 0;               // bends beyond their place
  std::size_t configuration = 0;
  typename Sizes<N, H>::Contacts friction;     // sigma_j F_j of contacts that slide; 0 if a state [N]
  typename Sizes<N, H>::Vector acceleration;   // due to it
  typename Sizes<N, H>::Contacts stuck_force;  // of the stuck contacts, due to it [N]
  // For a small system: Ef * friction, series_f * friction (StepTables).
  typename Sizes<N, H>::State step;
  typename Sizes<N, H>::Series series;
  Eigen::VectorXd guards;  // guard_f * friction, with stuck_force

  double sign(Eigen::Index contact) const { return contains(positive, contact) ? 1.0 : -1.0; }
};

// A stretch of a motion in one mode.
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
  typename Sizes<N, H>::Internal ds;  // rate of the internal forces [N a step]
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

// For a tangent: to the last digits, or to about 1e-3, which serves for steps of an iteration.
enum class Precision { exact, rough };

template <int N, int H>
class Flow {
 public:
  using S = Sizes<N, H>;

  // Matrices, friction limits and bends; call set_forcing before the next passage.
  void set_system(const mechanics::LinearSystem& system);
  // Motions of thousands of steps in each mode are about to be followed: tables pay for larger systems too.
  // To be called before set_system.
  void expect_many_steps() { equations_.large_from = 24; }
  void set_forcing(const mechanics::LinearSystem& system);
  // The numbers of the records [SI] (LinearSystem::recorded_force) at a phase, from which on they are
  // polynomials until the next call; no matrix is computed again. set_forcing makes them 0.
  void set_recorded(const Eigen::VectorXd& numbers, double phase);

  const StepEquations<N, H>& equations() const { return equations_; }
  const std::vector<int>& orders() const { return orders_; }
  double fundamental_rate() const { return fundamental_rate_; }  // omega h [rad a step]
  bool moving_support() const { return moving_support_; }        // some contact rubs on a prescribed node
  // The energy norm of the static response to the excitation's amplitudes, and of what moving supports drag
  // along [sqrt(J)].
  double static_norm() const { return static_norm_; }
  // The scale of residuals and errors of a state z [sqrt(J)].
  double energy_scale(const typename S::State& z) const {
    return std::max(equations_.energy_norm(z), static_norm_);
  }
  // The same for a state at `phase`, next to where recorded supports take it; of free masses, with what
  // holds them at stops.
  double energy_scale(const typename S::State& z, double phase) const;

  // For all motions that are followed on this flow; and what a step and an event add to it [s].
  SearchWork& work() { return work_; }
  double step_work() const { return step_work_; }
  double event_work() const { return event_work_; }

  // The table of modes: an index stays good until the next set_forcing.
  std::size_t mode_index(ContactMask stuck, ContactMask positive, ContactMask beyond);
  const Mode<N, H>& mode(std::size_t index) const { return modes_[index]; }
  const Configuration<N, H>& configuration(const Mode<N, H>& mode) const {
    return configurations_[mode.configuration];
  }
  // Whether a contact is at rest: it sticks, or stuck contacts hold it while it carries its limit.
  bool rests(const Mode<N, H>& mode, Eigen::Index contact) const {
    const bool is_idle = contains(configuration(mode).idle, contact) && equations_.limit[contact] > 0.0;
    return contains(mode.stuck, contact) || is_idle;
  }
  // All contacts at rest.
  ContactMask at_rest(const Mode<N, H>& mode) const {
    ContactMask result = mode.stuck;
    for (ContactMask idle = configuration(mode).idle & ~mode.stuck; idle != 0; idle &= idle - 1) {
      if (equations_.limit[first(idle)] > 0.0) result |= bit(first(idle));
    }
    return result;
  }
  // Maps velocities to those that keep these contacts stuck, orthogonally in the norm of M.
  typename S::Square keeping_stuck(ContactMask contacts) {
    return configurations_[configuration_index(contacts, 0)].projector(equations_);
  }
  // z with velocities at which these contacts are at rest at `phase`.
  typename S::State brought_to_rest(const typename S::State& z, double phase, ContactMask contacts);

  void instant_at(const typename S::State& z, double phase, const Mode<N, H>& mode, Instant<N, H>& at) const;
  void accelerate(const Mode<N, H>& mode, Instant<N, H>& at) const;
  // `to` = `from` one step later in the same mode. True: this took the expansion over the step, of a large
  // system, which x now has.
  bool step(const Instant<N, H>& from, const Mode<N, H>& mode, Instant<N, H>& to, Expansion<N, H>& x) const;
  void expand(const Instant<N, H>& at, const Mode<N, H>& mode, Expansion<N, H>& expansion) const;
  static void evaluate(const Expansion<N, H>& expansion, double s, typename S::State& z) {
    z.noalias() = expansion.z.transpose() * powers(s);
  }
  // Columns of states moved on by `steps` of the homogeneous flow of a mode, of a small system.
  void move_tangent(const Mode<N, H>& mode, double steps, typename S::StateSquare& tangent) const;
  // The tangent of a passage of a large system.
  void tangent_along(const TangentPath& path, Precision precision, typename S::StateSquare& tangent) const;
  // The state `elapsed` steps after the start of a segment of a passage that began at phase `section`.
  typename S::State state_within(const Segment<N, H>& segment, double section, double elapsed) const;

  // w_j^T q' + p_j^T y' of a contact [m a step], and its slope.
  ValueAndSlope sliding_speed(const Instant<N, H>& at, Eigen::Index contact) const;
  // The force of a stuck contact [N]: lambda_j, or its internal force if it has one; and its slope a step.
  ValueAndSlope stuck_force(const Instant<N, H>& at, const Mode<N, H>& mode, Eigen::Index contact) const;
  Polynomial stuck_force(const Expansion<N, H>& x, const Mode<N, H>& mode, Eigen::Index contact) const;
  // The guard of a contact over the step that starts at an instant: stuck_force while it sticks, otherwise
  // sliding_speed. Of a system with tables and of a size that is not fixed.
  Polynomial guard(const Instant<N, H>& at, const Mode<N, H>& mode, Eigen::Index contact) const;
  // The part of stuck_force that the state makes, as a form over the state: (Lq, Lv, Ls)_j.
  typename S::State stuck_force_form(const Mode<N, H>& mode, Eigen::Index contact) const;

 private:
  double bent_energy(const typename S::State& z, double phase) const;
  double energy_scale_beside(const typename S::State& z, double phase) const;
  std::vector<const HeldContacts*> held_along(const TangentPath& path) const;
  void turn_oscillators(const Instant<N, H>& from, Instant<N, H>& to) const;
  void expand_oscillators(const Instant<N, H>& at, Expansion<N, H>& x) const;
  void expand_by_recurrence(const Instant<N, H>& at, const Mode<N, H>& mode, Expansion<N, H>& x) const;
  void scale_matrices(const mechanics::LinearSystem& system);
  void reckon_work();
  void bound_tables();
  struct ConfigurationKey {
    ContactMask stuck, beyond;
    friend bool operator==(const ConfigurationKey&, const ConfigurationKey&) = default;
  };
  struct ModeKey {
    ContactMask stuck, positive, beyond;
    friend bool operator==(const ModeKey&, const ModeKey&) = default;
  };
  void set_oscillation(double omega);
  std::size_t configuration_index(ContactMask stuck, ContactMask beyond);

  StepEquations<N, H> equations_;
  SearchWork work_;
  double step_work_ = 0.0, event_work_ = 0.0;
  // The tables are searched by their keys; entries beyond the keys are of earlier systems, kept for their
  // storage.
  std::vector<ConfigurationKey> configuration_keys_;
  std::vector<Configuration<N, H>> configurations_;
  std::vector<ModeKey> mode_keys_;
  std::vector<Mode<N, H>> modes_;
  std::vector<int> orders_;
  std::vector<double> rotation_;             // cos, sin of each phase rate
  std::vector<Polynomial> rotation_series_;  // their Taylor polynomials over a step
  double fastest_rate_ = 0.0;
  double fundamental_rate_ = 0.0;
  double static_norm_ = 0.0;
  bool matrices_changed_ = true;
  bool moving_support_ = false;
};

// The sizes that are known at compile time are instantiated in flow/flow_*.cpp, each in its own file.
extern template class Flow<1, 1>;
extern template class Flow<2, 1>;
extern template class Flow<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic

#include "solvers/flow/stepper.hpp"
#include "solvers/flow/stuck_forces.hpp"
