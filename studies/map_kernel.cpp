#include "studies/map_kernel.hpp"

#include <limits>
#include <utility>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/periodic/orbit.hpp"

namespace frahm::studies {
namespace {

using periodic::QuantityKind;

// What a point without a response has: a quantity of each kind, and the status `failed`.
std::vector<double> values_of_failure(const StudyFile& study,
                                      std::span<const periodic::Quantity> quantities) {
  std::vector<double> values;
  for (const periodic::Quantity& quantity : quantities) {
    const QuantityKind kind = periodic::describe(quantity, study.network, study.dimensionless).kind;
    const bool is_status = quantity.measure == periodic::Measure::status;
    values.push_back(is_status                     ? static_cast<double>(periodic::Status::failed)
                     : kind == QuantityKind::flag  ? 0.0
                     : kind == QuantityKind::count ? -1.0
                                                   : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

}  // namespace

MapKernel::MapKernel(const StudyFile& study, const Grid& grid, std::vector<periodic::Quantity> quantities)
    : study_(study),
      grid_(grid),
      missing_(values_of_failure(study, quantities)),
      matrices_change_in_row_(!study.frequency_dimension || study.values_depend_on_frequency),
      response_(study.network, std::move(quantities)),
      parameters_(study.parameters.nominal()),
      point_(missing_.size()) {}

void MapKernel::operator()(std::uint64_t tile, engine::Bytes& out) {
  const MapBox box = grid_.box(tile);
  record_.values.resize(missing_.size() * box.points());
  record_.failed.clear();
  response_.forget();

  const auto rows = std::span(grid_.order).first(grid_.order.size() - 1);
  index_ = box.start;
  do {
    compute_row(box);
  } while (next_point(box, rows, index_));
  encode(record_, out);
}

// The points of the row that begins at index_, along the last dimension in the order of computation.
void MapKernel::compute_row(const MapBox& box) {
  const std::size_t along = grid_.order.back();
  std::uint64_t place = 0, step = 1;  // of the row's first point in the record; from one to the next
  for (std::size_t d = 0; d < index_.size(); ++d) {
    place = place * box.count[d] + (index_[d] - box.start[d]);
    if (d > along) step *= box.count[d];
    if (d != along) studies::place(study_, d, index_[d], parameters_);
  }
  matrices_set_ = false;
  points_in_row_ = 0;
  const std::uint64_t points = box.points();
  for (std::uint64_t i = 0; i < box.count[along]; ++i) {
    studies::place(study_, along, box.start[along] + i, parameters_);
    evaluate(study_.values, study_.parameters, parameters_, values_);
    compute_point();
    for (std::size_t q = 0; q < point_.size(); ++q) record_.values[q * points + place] = point_[q];
    if (!reason_.empty()) record_.failed.push_back({place, reason_});
    place += step;
  }
}

// Fills point_, and reason_ if the point fails.
void MapKernel::compute_point() {
  reason_.clear();
  begin_row_where_frequency_turns();
  try {
    set_point();
  } catch (const mechanics::MechanicsError& error) {
    reason_ = error.what();
    point_ = missing_;
    matrices_set_ = false;
    return;
  }
  const periodic::ResponseSummary& summary = response_.solve();
  if (summary.status == periodic::Status::failed) reason_ = summary.reason;
  response_.quantities(point_);
}

void MapKernel::set_point() {
  if (matrices_set_ && !matrices_change_in_row_) {
    response_.set_forcing(values_);
  } else {
    response_.set_values(values_);
    matrices_set_ = true;
  }
}

// Along a row the solver extrapolates over the frequency, which has to go one way: axes that advance together
// may turn back or stand still, and without a frequency axis it stands still always.
void MapKernel::begin_row_where_frequency_turns() {
  const double step = values_.omega - omega_;
  const bool onwards = points_in_row_ == 1 ? step != 0.0 : step * direction_ > 0.0;
  if (points_in_row_ == 0 || !onwards) {
    response_.begin_row();
    points_in_row_ = 0;
  }
  direction_ = step;
  omega_ = values_.omega;
  ++points_in_row_;
}

}  // namespace frahm::studies
