#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solvers/events/walk.hpp"
#include "solvers/quantities/step_samples.hpp"
#include "solvers/transient/motion.hpp"

namespace frahm::transient {

// A motion from given initial values on the exact flow, as sensors show it at given times, with its exact
// derivatives along changes of system, excitation and initial values: through stops, releases and reversals,
// up to rest and on from there (quantities/passage_sensitivity.hpp).
//
// Where a contact slides from rest at the very start, the derivative by a velocity is that of starts that
// slide the same way: against it the contact would reverse first.
class MotionSensitivity {
 public:
  // times: ascending [s]; the motion begins at the first, at least one. `observed` must outlive it.
  MotionSensitivity(std::span<const periodic::Observed> observed, std::vector<double> times, Watch watch);

  // Matrices and forcing, and their derivatives along each direction (system_derivative.hpp).
  void set_system(const mechanics::LinearSystem& system, std::span<const mechanics::LinearSystem> by);
  // The numbers of the records now, at this phase (RecordCourse::numbers). jumps: the velocity of a support
  // jumps, at a time that no parameter moves.
  void set_recorded(const Eigen::VectorXd& numbers, double phase, bool jumps = false) {
    flow_.set_recorded(numbers, phase);
    jumps_ = jumps;
  }

  // To be called once, after set_system. by: of each direction; an empty vector means zeros.
  void start(const InitialState& initial, std::span<const InitialState> by);

  double time() const { return time_; }  // [s]
  // Moves on to `time` [s]; phase: omega t of the fundamental now [rad]. Passages are at most `longest` [s],
  // so that what counts as rest shrinks with the motion.  False: failure() says why.
  bool advance(double time, double phase, double longest);
  // All masses are held and nothing changes any more.
  bool is_at_rest() const;
  // Fills the samples that are left with the state now.
  void finish();

  const char* failure() const { return failure_; }             // null: none
  const char* why_no_derivative() const { return why_none_; }  // "": there is one
  const periodic::ObservedMotion& motion() const { return motion_; }

 private:
  static constexpr int kAny = Eigen::Dynamic;
  using Flow = periodic::Flow<kAny, kAny>;
  using State = typename Flow::S::State;
  using Step = periodic::PassageStep<kAny, kAny>;

  // Along one direction.
  struct Direction {
    explicit Direction(const Flow& flow) : sensitivity(flow) {}
    periodic::StepDerivative<kAny, kAny> by;
    periodic::PassageSensitivity<kAny, kAny> sensitivity;
    State delta;
  };
  // How the passage before ended.
  struct Ending {
    std::size_t mode = 0;
    periodic::Instant<kAny, kAny> at;
  };

  bool pass(double length, double phase);
  void differentiate();
  void begin(const Step& first);
  const char* cross_border(const Step& first);
  const char* cross_jump(const Step& first) const;
  bool lets_go_inside(periodic::ContactMask released) const;
  void keep_ending(const Step& last);
  void sample(std::size_t step, double end);

  Flow flow_;
  periodic::Walk<kAny, kAny> walk_;
  periodic::PassageSteps<kAny, kAny> steps_;
  periodic::Passage<kAny, kAny> passage_;  // the current one
  std::vector<Direction> directions_;
  State z_;
  double time_ = 0.0, passage_start_ = 0.0;  // [s]
  double steps_taken_ = 0.0;
  bool begun_ = false, jumps_ = false;
  Ending ending_;
  const char* failure_ = nullptr;
  const char* why_none_ = "";

  std::vector<double> times_;
  std::size_t next_sample_ = 0;
  periodic::StepSamples<kAny, kAny> samples_;
  std::span<const periodic::Observed> observed_;
  periodic::ObservedMotion motion_;
  std::vector<periodic::Polynomial> powers_;  // of the current step fractions
  Watch watch_;
};

}  // namespace frahm::transient
