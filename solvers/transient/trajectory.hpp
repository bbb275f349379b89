#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/events/walk.hpp"
#include "solvers/transient/energy_account.hpp"
#include "solvers/transient/largest_values.hpp"
#include "solvers/transient/motion.hpp"
#include "solvers/transient/turning_points.hpp"

namespace frahm::transient {

using Flow = periodic::Flow<Eigen::Dynamic, Eigen::Dynamic>;

// What is kept of a motion in addition to its stops; the rest costs nothing.
struct Kept {
  bool extrema = true;                         // the turning points of each mass and signal
  EnergyDetail energies = EnergyDetail::each;  // the energy budget
  bool rest = true;                            // where the motion rests or tends to
  LargestValues* largest = nullptr;            // these too; must outlive the trajectory
};

// A motion from given initial values on the exact flow, passage after passage, with its records: the extrema
// of each mass and signal, the stops of each contact, the state at given times.
class Trajectory {
 public:
  // times: at which the state is recorded, ascending [s].  `assembly` must outlive the trajectory.
  Trajectory(const mechanics::Assembly& assembly, std::vector<double> times, Watch watch, Kept kept = {});

  // The forcing is about to last for thousands of steps (Flow::expect_many_steps); before set_system.
  void expect_many_steps() { flow_.expect_many_steps(); }

  // Matrices and forcing, or only another forcing, from now on. The state is carried over; stuck contacts
  // stay stuck (a support whose velocity jumps takes them along). phase: omega t of the fundamental now.
  void set_system(const mechanics::LinearSystem& system, double phase);
  void set_forcing(const mechanics::LinearSystem& system, double phase);

  // The numbers of the records now, at this phase, from which on they are polynomials
  // (RecordCourse::numbers). jumps: the velocity of a support jumps, and who sticks and slides is found
  // again; the masses keep their velocities.
  void set_recorded(const Eigen::VectorXd& numbers, double phase, bool jumps = false);

  // The excitation's frequency now, and how fast it rises [rad/s], [rad/s^2]; the forcing has one for a
  // while.
  void set_frequency(double omega, double alpha);

  // To be called once, after set_system. Throws mechanics::MechanicsError for values that are not finite, out
  // of the range of InitialState, or not one for each mass.
  void start(const InitialState& initial);

  // Moves on by `duration` [s] > 0; `phase` as above. False: failure() says why, nothing moves any more.
  bool advance(double duration, double phase);
  // Whether another `duration` [s] is within the limit of one computation; false: as advance().
  bool can_last(double duration);
  const char* failure() const { return failure_; }

  // Sets all masses at rest where they tend to: for a motion that has died away and does not drift.
  void come_to_rest();

  // Fills the samples that are left with the state now.
  void finish();

  double time() const { return time_; }                   // [s]
  double step() const { return flow_.equations().step; }  // [s]

  // For a mass or signal (mechanics/coordinates.hpp) now [m].
  double displacement(std::size_t coordinate) const;
  double energy_norm() const { return flow_.equations().energy_norm(z_); }  // [sqrt(J)]
  // The energy norm of the state's distance from where its mode would come to rest, or from its steady drift
  // [sqrt(J)].
  double distance_from_rest() const;
  // Of a motion that dies away: no stop or point of a table lies on what is left of its way.
  bool goes_on_freely() const;
  bool friction_slides() const;              // some contact with friction slides now
  bool is_at_rest() const;                   // all masses are held, and nothing changes any more
  bool has_crept() const { return crept_; }  // a contact's velocity died away without ever reaching zero
  double held_since() const { return held_since_; }  // [s], of all masses; NaN: some mass is free

  // Where the masses are at rest, or tend to while the contacts stick and slide as they do: the state there,
  // displacements [m] first. Free masses that drift have their velocity then, and their place now.
  Flow::S::State tends_to() const;

  const TurningPoints& turning_points(std::size_t coordinate) const { return turning_points_[coordinate]; }
  const std::vector<Stop>& stops(std::size_t contact) const { return stops_[contact]; }
  const std::vector<Touch>& touches(std::size_t bend) const { return touches_[bend]; }
  const Samples& samples() const { return samples_; }
  EnergyBudget energy_budget() { return account_.budget(energy_now()); }  // of the motion so far

 private:
  using State = typename Flow::S::State;
  using Oscillators = typename Flow::S::Oscillators;
  using Step = periodic::PassageStep<Eigen::Dynamic, Eigen::Dynamic>;

  bool has_started() const { return z_.size() > 0; }
  double energy_now() const { return account_.energy_of(z_, phase_); }  // [J]
  void take_forcing(const mechanics::LinearSystem& system, double phase, double energy_before,
                    const Eigen::VectorXd& joints);
  Eigen::VectorXd joints_now() const;  // their displacements [m]; none before the start, or of no joint
  void hold_joints(const Eigen::VectorXd& x, const Eigen::MatrixXd& damped);
  void carry_over(double old_step);
  bool pass(double length, double phase);
  void follow(Step& step);
  void follow_energies(Step& step);
  void follow_extrema(Step& step, double at);
  void follow_signals(const Step& step, double at);
  void note_mode(const periodic::Mode<Eigen::Dynamic, Eigen::Dynamic>& mode, double at, const State& z);
  void note_touches(periodic::ContactMask beyond, double at);
  void find_free_directions();
  void keep_samples(Step& step, double at);
  void keep_state(const State& z, const Eigen::VectorXd& acceleration, const Oscillators& u,
                  const std::vector<double>& dissipated);
  // Of the joints: displacements [m], and their rates a step.
  struct JointMotion {
    Eigen::VectorXd x, velocity, acceleration;
  };
  JointMotion joint_motion(const State& z, const Eigen::VectorXd& acceleration, const Oscillators& u,
                           double faster, double rising) const;
  void keep_signals(const State& z, const Eigen::VectorXd& acceleration, const Oscillators& u);
  Oscillators oscillators_now() const;
  State resting_state(const State& z) const;
  State resting_state_of_free(const State& z) const;
  // Where free masses can go in a mode: bases in columns, n rows each, and what follows from them.
  struct Ways {
    bool known = false;
    periodic::ContactMask stuck = 0, beyond = 0;  // of which it is
    Eigen::MatrixXd free{}, undamped{};           // that strain nothing; of these, that no damper takes up
    Eigen::MatrixXd held{}, damped{};             // of those beside the stuck contacts, and of the free ones
    Eigen::MatrixXd K{}, C{};  // with what is bent; C with what Maxwell elements let go in the end
    Eigen::MatrixXd compliance{}, admittance{};  // along held [m/N], along damped [m a step/N]
  };
  const Ways& ways() const;
  std::vector<double> bent(const Eigen::VectorXd& of_bends) const;
  void note_speeds();

  const mechanics::Assembly& assembly_;
  Flow flow_;
  periodic::Walk<Eigen::Dynamic, Eigen::Dynamic> walk_;
  periodic::PassageSteps<Eigen::Dynamic, Eigen::Dynamic> steps_;
  periodic::Passage<Eigen::Dynamic, Eigen::Dynamic> passage_;  // the current one
  EnergyAccount account_;
  State z_;
  double phase_ = 0.0;            // omega t of the fundamental where z_ is [rad]
  Eigen::VectorXd acceleration_;  // where z_ is [m a step^2]
  double time_ = 0.0;
  double forcing_omega_ = 0.0;                            // of the forcing [rad/s]
  double omega_ = 0.0, alpha_ = 0.0, omega_since_ = 0.0;  // true, its rise [rad/s^2], since [s]
  double steps_taken_ = 0.0;
  bool goes_on_ = false;  // z_ and the flow's table of modes are as the last passage left them
  const char* failure_ = nullptr;
  double energy_scale_ = 0.0, energy_after_ = 0.0;  // [sqrt(J)] of the current passage, and at its end
  Kept kept_;

  bool has_mode_ = false;
  periodic::ContactMask stuck_ = 0, positive_ = 0, beyond_ = 0;
  Eigen::MatrixXd free_directions_;  // of the masses, while these contacts stick
  mechanics::LinearSystem system_;   // of free masses
  mutable Ways ways_;                // of the mode that was last asked for
  Eigen::VectorXd largest_speed_;    // of each mass at the ends of passages [m a step], of free masses
  Eigen::VectorXd deceleration_;     // of each sliding contact at the end of the step before [m a step^2]
  bool crept_ = false;
  State creeps_to_;    // [m]
  double held_since_;  // [s]

  periodic::Forms<Eigen::Dynamic, Eigen::Dynamic> forms_;
  std::vector<mechanics::Incidence> signals_;
  std::vector<TurningPoints> turning_points_;  // of each coordinate
  std::vector<std::vector<Stop>> stops_;
  std::vector<std::vector<Touch>> touches_;
  std::size_t next_sample_ = 0;
  Samples samples_;
  Watch watch_;
};

}  // namespace frahm::transient
