#pragma once

#include <optional>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/exchange/tuned_response.hpp"

namespace frahm::tuning {

// A curve over the band that a design has to keep low: the weighted objective, which stays under the worst
// peak t, or a scaled response that stays under 1.
struct CurveKind {
  enum class Of {
    objective,    // weight X                        <= t
    upper_limit,  // 1 + (X - limit)/|limit|         <= 1
    lower_limit,  // 1 + (limit - X)/|limit|         <= 1
    dominated,    // X / X of the constant design    <= 1
  };
  Of of = Of::objective;
  std::size_t scenario = 0;
  std::size_t limit = 0;  // which of the limits
  periodic::Quantity quantity;
  Band band;
  double bound = 0.0;            // of a limit
  std::vector<double> constant;  // design of `dominated`
  double excess = 0.0;           // relative, by which a limit may be broken where no design meets all

  // The curve's upper bound, if it is not t. Where the constant design is already the best, a dominating
  // design can only equal it: a small tolerance lets the optimiser do so.
  double most() const { return 1.0 + (of == Of::dominated ? kTouch : excess); }
  static constexpr double kTouch = 1e-8;
};

// Evaluates the curve at one design and frequency after the other. If the orbit has no symmetry a peak has
// two sides, each with its own smooth value.
class BandCurve {
 public:
  // All must outlive the curve.
  BandCurve(const Task& task, const DesignSpace& space, const CurveKind& kind, Effort& effort);

  TunedResponse::State solve(std::span<const double> x, double band, Derivatives derivatives);
  // The larger side at each of many places at once; NaN where it has no value. Of an objective or a limit of
  // a network without several responses.
  void values(std::span<const double> x, std::span<const double> places, std::vector<double>& out);
  // As of a TunedResponse.
  void end_rows_when(const std::function<bool()>& stop_asked) { response_.end_rows_when(stop_asked); }
  const std::string& reason() const { return reason_; }

  // The larger side, or one of two (0: most, 1: least).
  static constexpr std::size_t larger = 2;
  double value(std::size_t side) const;
  double derivative(std::size_t side, std::size_t parameter) const;  // d value / d parameter, all else held
  double slope_left(std::size_t side) const;                         // d value / d band along the schedules
  double slope_right(std::size_t side) const;
  // Sides that need a bound each: both of a peak without symmetry, otherwise only the first. Of several
  // orbits the worst has the larger side, which alone counts.
  std::size_t sides() const {
    return sides_ == 2 && !response_.is_symmetric() && !response_.may_jump() ? 2 : 1;
  }
  double quantity(std::size_t side) const { return response_.value(side_of(side)); }  // unscaled, unweighted

  const TunedResponse& response() const { return response_; }

 private:
  std::size_t side_of(std::size_t side) const;
  void set_scale(double band);

  const Task& task_;
  const CurveKind& kind_;
  std::size_t sides_;  // of the quantity
  TunedResponse response_;
  std::optional<TunedResponse> constant_;  // of `dominated`
  double constant_band_ = kNone;           // where it was solved last
  bool constant_has_slopes_ = false;
  double factor_ = 1.0, offset_ = 0.0;  // value = factor X + offset at the last point solved
  double factor_slope_ = 0.0;           // d factor / d band
  std::string reason_;
};

}  // namespace frahm::tuning
