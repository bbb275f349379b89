#pragma once

#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/transient/record_course.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {

// A motion whose excitation is set again, at another frequency, from time to time.
class DrivenMotion {
 public:
  // course: of the records; null where there are none. All must outlive the motion.
  DrivenMotion(const mechanics::Assembly& assembly, const ValuesAt& values_at, const InitialState& initial,
               const RecordCourse* course, std::vector<double> times, Watch watch, Kept kept);

  // From here on the excitation has frequency omega [rad/s], which changes at the rate alpha [rad/s^2], and
  // its phase is `phase`. The motion starts with the first call.
  void drive(double omega, double alpha, double phase);

  Trajectory trajectory;

 private:
  void add_angular_acceleration(double alpha);

  const mechanics::Assembly& assembly_;
  const ValuesAt& values_at_;
  const InitialState& initial_;
  const RecordCourse* course_;
  mechanics::LinearSystem system_;
  mechanics::NetworkValues built_;  // of which the system's matrices are
  bool started_ = false;
};

}  // namespace frahm::transient
