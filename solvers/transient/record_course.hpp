#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/transient/record.hpp"

namespace frahm::transient {

// The course of a network's records: polynomials from one of their times to the next, exactly.
class RecordCourse {
 public:
  // records: one for each recorded component of the excitation. They need not live longer. Corners hold their
  // last value until `until` [s], the end of the motion. Throws
  // mechanics::MechanicsError for a component without its record, for a record of another kind, and for one
  // that is no course: too few samples, times that do not ascend, numbers that are not finite, a spline that
  // strays from its samples (why_no_spline), a velocity that may not jump (why_no_jump).
  RecordCourse(const mechanics::Network& network, std::span<const RecordedExcitation> records,
               double until = 0.0);

  // All times of all records [s], ascending.
  const std::vector<double>& times() const { return times_; }
  // The four numbers of each record (LinearSystem::recorded_force) from times()[i] on, until the next; from
  // the last time on, after it. Before its first time a record is 0.
  const Eigen::VectorXd& numbers(std::size_t i) const { return numbers_[i]; }
  // Whether the velocity of a support jumps at times()[i], or corners step there.
  bool jumps_at(std::size_t i) const { return jumps_[i] != 0; }
  // For each number, the largest (LinearSystem::recorded_size).
  const Eigen::VectorXd& sizes() const { return sizes_; }
  // Between one time and the next [s], where all are equal apart from rounding; otherwise 0.
  double interval() const { return interval_; }
  // Sizes and interval (LinearSystem::recorded_size, recorded_interval).
  void tell(mechanics::LinearSystem& system) const;

 private:
  void find_jumps(const Record& record, std::span<const std::array<double, 4>> course);
  void bound_numbers();
  void find_interval();

  std::vector<double> times_;
  std::vector<Eigen::VectorXd> numbers_;
  std::vector<char> jumps_;  // at each time
  Eigen::VectorXd sizes_;
  double interval_ = 0.0;
};

// Whether the motion is known after the record's end: its support rests there, or the record is a force, an
// acceleration or a list of corners.
bool is_known_behind(const Record& record);

// The least and the largest value of a displacement between two neighbouring samples, and when.
struct Reach {
  double least = 0.0, least_at = 0.0, most = 0.0, most_at = 0.0;
};
// Between its samples, one after the other. The record must have as many as it needs.
std::vector<Reach> reaches(const Record& displacement);

// Why the spline through the samples is not what they mean: between two of them it leaves the range of the
// four about it by more than a quarter of the record's range, as at the corners of a step. Empty: it does
// not, or is no spline.
std::string why_no_spline(const Record& record);

// The name of an inerter that hangs on a support, whose velocity cannot jump. Empty: none does.
std::string inerter_on(const mechanics::Network& network, std::size_t support);

// Why the velocity of a support cannot jump: an inerter hangs on it, which would need an infinite force.
// Empty: none does.
std::string why_no_jump(const mechanics::Network& network, std::size_t support);

}  // namespace frahm::transient
