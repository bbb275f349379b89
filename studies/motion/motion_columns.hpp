#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "results/layout.hpp"
#include "solvers/transient/motion.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "studies/provenance/result_variables.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Columns of a group, with the units of the study: in a dimensionless study only angles have one.
class MotionColumns {
 public:
  explicit MotionColumns(const Study& study) : study_(study) {}

  // dimension: "" for a single number.  values: padded with NaN to `size`.
  void add(const Named& named, std::string_view unit, const std::string& dimension,
           std::vector<double> values, std::size_t size = 0);
  void add_number(const Named& named, std::string_view unit, double value) { add(named, unit, "", {value}); }
  // A quantity of the whole motion, as a map of motions has it.
  void add_quantity(const transient::MotionQuantity& quantity, double value);

  // Adds time and, along it, displacement and velocity of each mass and signal, the signal's acceleration
  // too, and each element's dissipated energy.
  void add_samples(const transient::Samples& samples);

  // Frequencies [rad/s] in the study's unit of them.
  void add_frequencies(const Named& named, const std::string& dimension, std::vector<double> omega);

  std::vector<results::Column> take() { return std::move(columns_); }

 private:
  const Study& study_;
  std::vector<results::Column> columns_;
};

}  // namespace frahm::studies
