#include "studies/map/row_solver.hpp"

#include <algorithm>
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

periodic::Path path_of(const Study& study) {
  return study.sweep() != nullptr && study.sweep()->general_path ? periodic::Path::general
                                                                 : periodic::Path::fastest;
}

}  // namespace

RowSolver::RowSolver(const Study& study, const mechanics::Network& network, StudyValues values,
                     const std::vector<periodic::Quantity>& quantities,
                     const periodic::OrbitsWanted& wanted)
    : parameters_(study.parameters),
      values_(std::move(values)),
      missing_(values_of_failure(quantities)),
      response_(network, quantities, path_of(study), wanted) {}

void RowSolver::add_point(std::span<double> parameters) {
  if (points_ == numbers_.size()) numbers_.emplace_back();
  evaluate(values_, parameters_, parameters, numbers_[points_++]);
}

void RowSolver::solve() {
  found_.resize(points_);
  row_.resize(points_ * missing_.size());
  response_.solve_row(std::span(numbers_).first(points_), found_, row_);
  for (std::size_t i = 0; i < points_; ++i) {
    const auto place = row_.begin() + static_cast<std::ptrdiff_t>(i * missing_.size());
    if (found_[i].status == periodic::Status::not_computed) std::ranges::copy(missing_, place);
    // What is unbounded is no failure.
    if (found_[i].status == periodic::Status::unbounded) found_[i].reason.clear();
  }
}

std::span<const double> RowSolver::quantities(std::size_t i) const {
  return std::span(row_).subspan(i * missing_.size(), missing_.size());
}

std::span<const double> RowSolver::solve_alone(std::span<double> parameters) {
  numbers_.resize(std::max<std::size_t>(numbers_.size(), 1));
  evaluate(values_, parameters_, parameters, numbers_[0]);
  try {
    response_.set_values(numbers_[0]);
  } catch (const mechanics::MechanicsError&) {
    return missing_;
  }
  response_.begin_row();
  response_.solve();
  row_.resize(std::max(row_.size(), missing_.size()));
  response_.quantities(std::span(row_).first(missing_.size()));
  return std::span(row_).first(missing_.size());
}

}  // namespace frahm::studies
