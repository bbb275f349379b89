#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/transient/record.hpp"

namespace frahm::transient {

// The course of a network's records: polynomials from one of their times to the next, exactly.
class RecordCourse {
 public:
  // records: one for each recorded component of the excitation. They need not live longer. Throws
  // mechanics::MechanicsError for a component without its record, for a record of another kind, and for one
  // that is no course: too few samples, times that do not ascend, numbers that are not finite.
  RecordCourse(const mechanics::Network& network, std::span<const RecordedExcitation> records);

  // All times of all records [s], ascending.
  const std::vector<double>& times() const { return times_; }
  // The four numbers of each record (LinearSystem::recorded_force) from times()[i] on, until the next; from
  // the last time on, behind it. Before its first time a record is 0.
  const Eigen::VectorXd& numbers(std::size_t i) const { return numbers_[i]; }
  // Of each number, the largest (LinearSystem::recorded_size).
  const Eigen::VectorXd& sizes() const { return sizes_; }
  // Between one time and the next [s], where all are alike but for rounding; else 0.
  double interval() const { return interval_; }
  // Sizes and interval (LinearSystem::recorded_size, recorded_interval).
  void tell(mechanics::LinearSystem& system) const;

 private:
  void bound_numbers();
  void find_interval();

  std::vector<double> times_;
  std::vector<Eigen::VectorXd> numbers_;
  Eigen::VectorXd sizes_;
  double interval_ = 0.0;
};

// Whether the motion is known behind the record's end: its support rests there, or the record is a force or
// an acceleration.
bool is_known_behind(const Record& record);

}  // namespace frahm::transient
