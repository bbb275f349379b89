#include "solvers/transient/driven_motion.hpp"

#include <complex>
#include <utility>

#include "solvers/exact/response.hpp"

namespace frahm::transient {

DrivenMotion::DrivenMotion(const mechanics::Assembly& assembly, const ValuesAt& values_at,
                           const InitialState& initial, const RecordCourse* course, std::vector<double> times,
                           Watch watch, Kept kept)
    : trajectory(assembly, std::move(times), std::move(watch), kept),
      assembly_(assembly),
      values_at_(values_at),
      initial_(initial),
      course_(course) {}

void DrivenMotion::drive(double omega, double alpha, double phase) {
  const mechanics::NetworkValues values = values_at_(omega);
  const bool rebuild =
      !started_ || assembly_.matrices_depend_on_frequency() || !periodic::have_same_elements(values, built_);
  if (rebuild) {
    assembly_.set_values(values, system_);
    built_ = values;
  }
  assembly_.set_forcing(values, system_);
  if (course_ != nullptr) course_->tell(system_);
  add_angular_acceleration(alpha);
  if (rebuild) {
    trajectory.set_system(system_, phase);
  } else {
    trajectory.set_forcing(system_, phase);
  }
  if (!started_ && course_ != nullptr && course_->times().front() <= 0.0)
    trajectory.set_recorded(course_->numbers(0), phase);
  if (!started_) trajectory.start(initial_);
  started_ = true;
}

// y'' = (i k alpha - (k omega)^2) Y_k e^{i k phi}: the supports exert -M_s y'' through inerters, of which
// the assembly contains the second part. The first part works at the masses' velocities; the rest of its
// work is in the jumps of the supports' velocities from stair to stair.
void DrivenMotion::add_angular_acceleration(double alpha) {
  if (alpha == 0.0 || system_.motion.rows() == 0) return;
  for (std::size_t k = 0; k < system_.orders.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const std::complex<double> rate(0.0, system_.orders[k] * alpha);
    const Eigen::VectorXcd force = -rate * (system_.M_support * system_.motion.col(column));
    system_.force.col(column) += force;
    system_.applied_force.col(column) += force;
  }
}

}  // namespace frahm::transient
