#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "solvers/response/periodic_response.hpp"
#include "solvers/tuning/exchange/seen_orbits.hpp"
#include "solvers/tuning/schedules/design_space.hpp"
#include "solvers/tuning/task.hpp"

namespace frahm::tuning {

// Which derivatives a response is solved with: none, by the band's parameter along the schedules, or that and
// those by every design parameter.
enum class Derivatives { none, along_band, all };

// What a tuning took, and what it met on its way.
struct Effort {
  std::uint64_t orbits = 0, gradients = 0;
  std::vector<SeenOrbits> seen;  // of each scenario; of a network that may have several responses
};

// Which of several responses counts.
enum class Worst { largest, smallest };

// Responses of one scenario of a task at designs and frequencies one after the other, each search starting
// from the orbit before. Of several stable orbits the worst one found counts; where none is found, the worst
// over 64 periods of the motions that were followed: such a point has a value but no derivative.
class TunedResponse {
 public:
  // task, space, effort: must outlive the response. quantities: a peak with its side.
  TunedResponse(const Task& task, const DesignSpace& space, std::size_t scenario,
                const std::vector<periodic::Quantity>& quantities, Effort& effort,
                Worst worst = Worst::largest);

  enum class State { solved, unbounded, failed };
  // Solves at the design x and a point of the band. If a derivative is needed and the orbit grazes, the orbit
  // at a frequency one part in 1e9 next to it is found instead.
  State solve(std::span<const double> x, double band, Derivatives derivatives);
  // All quantities at each of many places at once, faster than one by one; NaN where there is no response.
  // Not of a network that may have several.
  std::span<const double> solve_row(std::span<const double> x, std::span<const double> places);
  // A row ends early, its other places without a value, once this is true. It must outlive the response.
  void end_rows_when(const std::function<bool()>& stop_asked) { response_.end_rows_when(stop_asked); }
  const std::string& reason() const { return reason_; }  // of the last solve, if not solved

  double value(std::size_t quantity) const { return value_[quantity]; }
  // d quantity / d parameter at the current point, the frequency and the other parameters held. Solved with
  // all derivatives.
  double derivative(std::size_t quantity, std::size_t parameter) const {
    return derivative_[parameter * value_.size() + quantity];
  }
  // d quantity / d band along the schedules, on either side of a knot.
  double slope_left(std::size_t quantity) const { return slope_[quantity].left; }
  double slope_right(std::size_t quantity) const { return slope_[quantity].right; }
  // x(t + T/2) = -x(t): both sides of every peak are equal.
  bool is_symmetric() const { return is_symmetric_; }
  // The worst one may change from one orbit to another, and the curve jumps there.
  bool may_jump() const { return may_jump_; }
  // Whether the point is that of an orbit; its derivatives are 0 and its slopes NaN where it is not.
  bool is_periodic() const { return is_periodic_; }
  int coexisting() const { return coexisting_; }  // stable orbits found
  const mechanics::NetworkValues& values() const { return values_; }
  const DesignSpace::Interpolation& interpolation(std::size_t parameter) const {
    return interpolations_[parameter];
  }

 private:
  State solve_at(std::span<const double> x, double band, Derivatives derivatives);
  void set_values_at(std::span<const double> x, double band, mechanics::NetworkValues& values,
                     std::vector<mechanics::NetworkValues>* directions);
  void set_response();
  bool tell_worst(int responses);
  std::string differentiate(Derivatives derivatives);
  bool is_smooth() const;
  std::string differentiate_along_band();
  double slope(std::size_t quantity, double DesignSpace::Interpolation::*of_parameter) const;

  struct Slopes {
    double left = 0.0, right = 0.0;
  };

  const Task& task_;
  const DesignSpace& space_;
  std::size_t scenario_;
  periodic::PeriodicResponse response_;
  Effort& effort_;

  mechanics::NetworkValues values_;
  mechanics::NetworkValues set_;  // whose elements the response holds
  bool is_set_ = false;
  std::vector<mechanics::NetworkValues> row_;
  std::vector<periodic::ResponseSummary> found_;  // of the row
  std::vector<double> row_values_;                // places x quantities
  std::vector<mechanics::NetworkValues> directions_;
  std::vector<DesignSpace::Interpolation> interpolations_;
  const std::vector<periodic::Quantity> quantities_;
  const Worst worst_;
  const bool may_jump_;
  std::vector<double> at_, value_, derivative_;
  std::vector<Slopes> slope_;  // of each quantity
  std::string reason_;
  bool is_symmetric_ = false, gradient_missing_ = false, is_periodic_ = true;
  int coexisting_ = 1;
};

}  // namespace frahm::tuning
