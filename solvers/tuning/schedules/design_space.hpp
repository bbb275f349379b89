#pragma once

#include <span>
#include <vector>

#include "solvers/tuning/task.hpp"

namespace frahm::tuning {

// How the design parameters follow from the variables x of an optimisation: one variable for a constant, one
// for each knot of a schedule, which is linear in between (weights of the two knots about a point).
class DesignSpace {
 public:
  // Throws mechanics::MechanicsError for bounds that are not finite or reversed, and knots out of order.
  explicit DesignSpace(const std::vector<DesignParameter>& parameters);

  struct Share {
    std::size_t variable = 0;
    double weight = 0.0;  // d parameter / d variable
  };
  // A parameter at one point of the band.
  struct Interpolation {
    Share shares[2];
    int count = 0;
    double value = 0.0;
    double slope_left = 0.0, slope_right = 0.0;  // d value / d band, on either side of a knot
  };

  std::size_t variables() const { return owner_.size(); }
  std::size_t parameters() const { return parameters_.size(); }
  const DesignParameter& parameter(std::size_t p) const { return parameters_[p]; }
  std::size_t parameter_of(std::size_t variable) const { return owner_[variable]; }
  std::size_t first(std::size_t p) const { return first_[p]; }
  std::size_t count(std::size_t p) const { return first_[p + 1] - first_[p]; }
  bool has_schedule() const { return variables() > parameters(); }

  Interpolation interpolation(std::size_t p, double band, std::span<const double> x) const;

  // Variables that make each parameter the same everywhere, within its bounds. value: one per parameter.
  std::vector<double> constant_design(std::span<const double> value) const;
  // Values of the band parameter at which some schedule has a knot, ascending.
  std::vector<double> knots() const;
  // A range of the band without its leaps: the stretches between them, ascending; a leap's sides end them.
  std::vector<Band> stretches(const Band& band) const;

 private:
  std::vector<DesignParameter> parameters_;
  std::vector<std::size_t> first_;  // variable of each parameter, and the end
  std::vector<std::size_t> owner_;  // parameter of each variable
};

}  // namespace frahm::tuning
