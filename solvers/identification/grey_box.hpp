#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/identification.hpp"
#include "solvers/identification/measurement.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/transient/motion.hpp"

// Named parameters of a network fitted to measured motions: least squares of the simulated motion's distance
// from the measured one, on the exact flow with its exact derivatives through stops, releases and reversals.
namespace frahm::identification {

struct FittedParameter {
  std::string name, unit;                        // unit as of an Estimate
  double start = 0.0, lower = 0.0, upper = 0.0;  // [SI]; bounds may be infinite
  bool each_record = false;  // every record has its own value, such as what it starts from
};

// A number known from elsewhere, with its variance.
struct FixedParameter {
  std::string name, unit;
  double value = 0.0;
  double degrees_of_freedom = kInfinity;  // of that variance
};

// Numbers of the network, the values it starts from, and how they change.
struct Model {
  mechanics::NetworkValues values;
  transient::InitialState initial;  // values for each mass
};

// The model of a record. at: SI values of the fitted parameters, then of the fixed ones, in the task's order.
// derivatives: if not null, one for each entry of `at`, others held, in the layout of the model.
using ModelAt = std::function<void(std::size_t record, std::span<const double> at, Model& model,
                                   std::vector<Model>* derivatives)>;

struct GreyBoxTask {
  mechanics::Network network;
  ModelAt model_at;
  std::vector<FittedParameter> parameters;  // at least one
  std::vector<FixedParameter> fixed{};
  Eigen::MatrixXd fixed_covariance{};  // of `fixed`, in its order
  std::vector<TimeRecord> records;     // at least one
  // Fit the beginning of each record first, two periods of the model, then twice as much each time: a wrong
  // frequency slips whole periods along a record, and is corrected only while that is short. If the fit ends
  // far from the data, it is repeated from a quarter of a period on.
  bool grow = true;
  transient::Watch watch{};  // called while it works; what it throws is passed on
};

// Channels of different sizes are weighed by 1 / |y - mean y| of each series in a first fit, then by the
// residuals' own standard deviation until that settles, so that the variances are those of each sensor's
// noise. A motion that comes to rest has a minimum for each number of half swings: from the one that is
// found, others are looked for (minima.hpp). A fit at which nothing moves that should has not converged.
// Estimates: the fitted parameters in order, one of each record for those with each_record, named
// `<parameter>_<record>`; then the fixed ones, so that their covariances with the fitted ones are available:
// cov = s^2 (J^T J)^-1 + S cov_f S^T, S = -(J^T J)^-1 J^T J_f. Each has the degrees of freedom of that sum.
// Notes report a fit that has not converged, a record missed by more than 10 %, and autocorrelated residuals.
// Throws mechanics::MechanicsError where the start has no meaning, and for friction of the arctan law. Give
// bounds where possible (0 for a friction): beyond what the mechanics allows no model shows the way.
Identification grey_box(const GreyBoxTask& task);

}  // namespace frahm::identification
