#include "studies/map/row_solver.hpp"

#include <utility>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::studies {
namespace {

// The values of a point that could not be set up.
std::vector<double> values_of_failure(std::span<const periodic::Quantity> quantities) {
  std::vector<double> values;
  for (const periodic::Quantity& quantity : quantities)
    values.push_back(periodic::missing_value(quantity.measure, periodic::Status::failed));
  return values;
}

}  // namespace

RowSolver::RowSolver(const Study& study, const mechanics::Network& network, StudyValues values,
                     std::vector<periodic::Quantity> quantities, bool matrices_change)
    : parameters_(study.parameters),
      values_(std::move(values)),
      missing_(values_of_failure(quantities)),
      matrices_change_(matrices_change),
      response_(network, std::move(quantities)),
      point_(missing_.size()) {}

void RowSolver::begin_row() {
  matrices_set_ = false;
  turn();
}

void RowSolver::set_parameters(std::span<double> parameters) {
  evaluate(values_, parameters_, parameters, numbers_);
}

std::span<const double> RowSolver::solve(std::string& reason) {
  reason.clear();
  turn_where_frequency_does();
  try {
    set_point();
  } catch (const mechanics::MechanicsError& error) {
    reason = error.what();
    matrices_set_ = false;
    return missing_;
  }
  const periodic::ResponseSummary& summary = response_.solve();
  if (summary.status == periodic::Status::failed) reason = summary.reason;
  response_.quantities(point_);
  return point_;
}

// Along a row the solver extrapolates over the frequency, which must change in one direction: with axes that
// advance together it may turn back or pause, and without a frequency axis it is constant.
void RowSolver::turn_where_frequency_does() {
  const double step = numbers_.omega - omega_;
  const bool onwards = points_onwards_ == 1 ? step != 0.0 : step * direction_ > 0.0;
  if (points_onwards_ == 0 || !onwards) {
    response_.begin_row();
    points_onwards_ = 0;
  }
  direction_ = step;
  omega_ = numbers_.omega;
  ++points_onwards_;
}

void RowSolver::set_point() {
  if (matrices_set_ && !matrices_change_) {
    response_.set_forcing(numbers_);
  } else {
    response_.set_values(numbers_);
    matrices_set_ = true;
  }
}

}  // namespace frahm::studies
