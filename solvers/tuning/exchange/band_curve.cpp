#include "solvers/tuning/exchange/band_curve.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::tuning {
namespace {

using periodic::Quantity;
using periodic::Side;

std::vector<Quantity> sides_of(Quantity quantity) {
  if (!periodic::has_sides(quantity.measure)) return {quantity};
  std::vector<Quantity> sides{quantity, quantity};
  sides[0].side = Side::most;
  sides[1].side = Side::least;
  return sides;
}

}  // namespace

BandCurve::BandCurve(const Task& task, const DesignSpace& space, const CurveKind& kind, Effort& effort)
    : task_(task),
      kind_(kind),
      sides_(periodic::has_sides(kind.quantity.measure) ? 2 : 1),
      response_(task, space, kind.scenario, sides_of(kind.quantity), effort,
                kind.of == CurveKind::Of::lower_limit ? Worst::smallest : Worst::largest) {
  if (kind.of == CurveKind::Of::dominated)
    constant_.emplace(task, space, kind.scenario, std::vector<Quantity>{kind.quantity}, effort);
}

TunedResponse::State BandCurve::solve(std::span<const double> x, double band, Derivatives derivatives) {
  const TunedResponse::State state = response_.solve(x, band, derivatives);
  reason_ = response_.reason();
  if (state != TunedResponse::State::solved) return state;
  if (!std::isfinite(response_.value(0))) {
    reason_ = "the quantity has no value there";
    return TunedResponse::State::failed;
  }
  set_scale(band);
  if (kind_.of != CurveKind::Of::dominated) return state;
  // The constant design does not change, so its response at a frequency is computed once.
  const bool with_slope = derivatives != Derivatives::none;
  if (band != constant_band_ || (with_slope && !constant_has_slopes_)) {
    const TunedResponse::State of_constant =
        constant_->solve(kind_.constant, band, with_slope ? Derivatives::along_band : Derivatives::none);
    reason_ = constant_->reason();
    if (of_constant != TunedResponse::State::solved) return of_constant;
    constant_band_ = band;
    constant_has_slopes_ = with_slope;
  }
  factor_ = 1.0 / constant_->value(0);
  if (with_slope)
    factor_slope_ = -factor_ * factor_ * 0.5 * (constant_->slope_left(0) + constant_->slope_right(0));
  return state;
}

// For an objective or a limit.
void BandCurve::set_scale(double band) {
  factor_ = 1.0;
  offset_ = factor_slope_ = 0.0;
  const double scale = kind_.bound != 0.0 ? std::abs(kind_.bound) : 1.0;
  switch (kind_.of) {
    case CurveKind::Of::objective:
      if (task_.weight) {
        const Weight weight = task_.weight(band);
        factor_ = weight.value;
        factor_slope_ = weight.slope;
      }
      break;
    case CurveKind::Of::upper_limit:
      factor_ = 1.0 / scale;
      offset_ = 1.0 - kind_.bound / scale;
      break;
    case CurveKind::Of::lower_limit:
      factor_ = -1.0 / scale;
      offset_ = 1.0 + kind_.bound / scale;
      break;
    case CurveKind::Of::dominated:
      break;
  }
}

void BandCurve::values(std::span<const double> x, std::span<const double> places, std::vector<double>& out) {
  const std::span<const double> found = response_.solve_row(x, places);
  out.clear();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::span<const double> of_sides = found.subspan(i * sides_, sides_);
    set_scale(places[i]);
    const double value = factor_ * *std::ranges::max_element(of_sides) + offset_;
    out.push_back(std::isfinite(value) ? value : kNone);
  }
}

std::size_t BandCurve::side_of(std::size_t side) const {
  if (side != larger) return side;
  return sides_ == 2 && response_.value(1) > response_.value(0) ? 1 : 0;
}

double BandCurve::value(std::size_t side) const {
  return factor_ * response_.value(side_of(side)) + offset_;
}

double BandCurve::derivative(std::size_t side, std::size_t parameter) const {
  return factor_ * response_.derivative(side_of(side), parameter);
}

double BandCurve::slope_left(std::size_t side) const {
  return factor_ * response_.slope_left(side_of(side)) + factor_slope_ * response_.value(side_of(side));
}

double BandCurve::slope_right(std::size_t side) const {
  return factor_ * response_.slope_right(side_of(side)) + factor_slope_ * response_.value(side_of(side));
}

}  // namespace frahm::tuning
