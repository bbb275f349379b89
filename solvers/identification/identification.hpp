#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"

// Results from measurements: estimates, their uncertainty, and how well the model follows the data.
namespace frahm::identification {

// A number found from measurements.
struct Estimate {
  std::string name;       // "damping_ratio"; of a fitted parameter its name
  std::string unit;       // SI, in the form of CF: "N s m-1"; "1" without
  std::string long_name;  // what it is, in words
  double value = 0.0;     // NaN: the data do not determine it
  // One standard deviation. Infinite: not determined; NaN: unknown (no more data than unknowns).
  double standard_error = 0.0;
  double low = 0.0, high = 0.0;  // interval of kConfidence, by Student's t; -inf, inf or NaN likewise
  // For the variance behind the interval, may be infinite. NaN: those of the whole Identification.
  double degrees_of_freedom = kNone;
};
inline constexpr double kConfidence = 0.95;

// Measured values next to those of the model: the data of a residual plot.
struct FittedSeries {
  std::string name, unit;  // of what was measured: "main_displacement", "m"
  std::vector<double> measured, fitted;
};

// The series of one record over one variable.
struct FittedRecord {
  std::string name;
  std::string over, over_unit;  // "time", "s"
  std::vector<double> at;       // values of `over`, one for each of a series
  std::vector<FittedSeries> series;
  double nrmse = 0.0;  // of all its series together [%]
};

// A column of results with one value for each row of the data, such as a table of half-power frequencies.
struct RowColumn {
  std::string name, unit, long_name;
  std::vector<double> values;
};

struct Identification {
  std::string failure;    // why nothing was identified, a sentence; empty: success
  bool converged = true;  // false: a fit ended before its minimum, a note says why
  std::vector<Estimate> estimates;
  // For the estimates, in their order. Infinite on the diagonal, NaN next to it: not determined.
  Eigen::MatrixXd covariance;
  double degrees_of_freedom = 0.0;
  int iterations = 0;  // of a fit that iterates
  std::vector<FittedRecord> records;
  std::vector<RowColumn> rows;
  std::vector<std::string> notes;  // sentences: what was left out, what is held by a bound
};

// A series whose |y - mean y| is less than this part of |y| is constant: it varies by rounding only.
inline constexpr double kConstant = 1e-12;

// Fit quality, 100 (1 - |y - yhat| / |y - mean y|) [%]; the mean is each series' own. 100: exact, 0: no
// better than a constant. NaN: nothing measured varies.
double nrmse(std::span<const FittedSeries> series);

// Correlation coefficients of a covariance: NaN where one is not determined.
Eigen::MatrixXd correlation(const Eigen::MatrixXd& covariance);

// Sets standard errors and intervals of result.estimates from result.covariance and each estimate's degrees
// of freedom; an estimate without its own takes those of the whole result. An estimate with an infinite
// variance gets the value NaN.
void set_intervals(Identification& result);

// Adds an estimate computed from the existing ones: value and gradient by each of them.
void add_derived(Identification& result, Estimate estimate, const Eigen::VectorXd& gradient);

}  // namespace frahm::identification
