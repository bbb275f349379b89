#include "solvers/response/common_divisor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "solvers/algebra/no_value.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/quantities/contact_history.hpp"

namespace frahm::periodic {
namespace {

using mechanics::Excitation;
using mechanics::Network;
using mechanics::NetworkValues;

// Whether the quantity is taken at the reference order and needs a component there that is not zero.
bool needs_reference_component(Measure measure) {
  switch (measure) {
    case Measure::phase:
    case Measure::element_phase:
    case Measure::magnification:
    case Measure::transmissibility:
    case Measure::force_transmissibility:
      return true;
    default:
      return false;
  }
}

// Whether the quantity is a count, -1 where there is none.
bool is_count(Measure measure) {
  return measure == Measure::stops || measure == Measure::reversals || measure == Measure::events ||
         measure == Measure::period_multiple;
}

// If g does not divide the reference order, any order of the excitation serves as reference order: no
// quantity is then taken from it.
Network divided(Network network, int g) {
  const bool divides = network.reference_order % g == 0;
  int lowest = std::numeric_limits<int>::max();
  for (Excitation& excitation : network.excitations) {
    excitation.order /= g;
    if (excitation.order > 0) lowest = std::min(lowest, excitation.order);
  }
  network.reference_order = divides ? network.reference_order / g : lowest;
  return network;
}

// The quantities and, after them, the stops from which the regimes among them follow.
std::vector<Quantity> with_stops(std::vector<Quantity> quantities) {
  const std::size_t asked = quantities.size();
  for (std::size_t i = 0; i < asked; ++i) {
    if (quantities[i].measure == Measure::regime) quantities.push_back({Measure::stops, quantities[i].index});
  }
  return quantities;
}

class DividedOrders final : public ResponseSolver {
 public:
  // solver: gives the quantities with_stops().
  DividedOrders(int divisor, int reference_order, std::vector<Quantity> quantities,
                std::unique_ptr<ResponseSolver> solver)
      : divisor_(divisor),
        reference_order_(reference_order),
        quantities_(std::move(quantities)),
        solved_(with_stops(quantities_).size()),
        solver_(std::move(solver)) {}

  void set_values(const NetworkValues& values) override { solver_->set_values(quickened(values)); }
  void set_forcing(const NetworkValues& values) override { solver_->set_forcing(quickened(values)); }
  void forget() override { solver_->forget(); }
  void begin_row() override { solver_->begin_row(); }
  const ResponseSummary& solve() override {
    summary_ = solver_->solve();
    multiple_ = summary_.multiple;
    summary_.multiple = whole_periods(multiple_);
    return summary_;
  }

  void start_from(std::span<const KnownOrbit> known) override { solver_->start_from(known); }
  std::vector<KnownOrbit> known() const override { return solver_->known(); }
  void tell(int which) override {
    solver_->tell(which);
    multiple_ = solver_->multiple();
  }
  int multiple() const override { return whole_periods(multiple_); }
  std::vector<std::complex<double>> multipliers() override {
    std::vector<std::complex<double>> result = solver_->multipliers();
    for (std::complex<double>& each : result) each = std::pow(each, divisor_ / std::gcd(multiple_, divisor_));
    return result;
  }

  void quantities(std::span<double> out) override {
    of_part_.resize(solved_);
    solver_->quantities(of_part_);
    convert(of_part_, multiple_, out);
  }

  void solve_row(std::span<const NetworkValues> points, std::span<ResponseSummary> found,
                 std::span<double> out) override {
    row_.assign(points.begin(), points.end());
    for (NetworkValues& values : row_) quicken(values);
    of_part_.resize(solved_ * points.size());
    solver_->solve_row(row_, found, of_part_);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].status == Status::not_computed) continue;
      convert(std::span(of_part_).subspan(solved_ * i, solved_), found[i].multiple,
              out.subspan(quantities_.size() * i, quantities_.size()));
      found[i].multiple = whole_periods(found[i].multiple);
    }
  }

  void end_rows_when(const std::function<bool()>& stop_asked) override { solver_->end_rows_when(stop_asked); }

  const char* gradient(std::span<const NetworkValues> directions, std::span<double> out) override {
    of_part_.resize(solved_ * directions.size());
    const char* reason = solver_->gradient(quickened(directions), of_part_);
    is_differentiable_ = *reason == '\0';
    if (!is_differentiable_) return reason;
    for (std::size_t d = 0; d < directions.size(); ++d) {
      for (std::size_t i = 0; i < quantities_.size(); ++i)
        out[d * quantities_.size() + i] =
            derivative_of_whole_period(quantities_[i].measure, of_part_[d * solved_ + i], divisor_);
    }
    return reason;
  }

  const char* why_no_derivative(std::size_t quantity) const override {
    if (is_differentiable_ && !has_reference_ && needs_reference_component(quantities_[quantity].measure))
      return "the response has no component at the reference order";
    return solver_->why_no_derivative(quantity);
  }

  const char* observe(std::span<const double> times, std::span<const Observed> observed,
                      std::span<const NetworkValues> directions, ObservedMotion& out) override {
    return solver_->observe(times, observed, quickened(directions), out);
  }

  History history(std::span<const double> phases, SliderForces sliders) override {
    std::vector<double> quick(phases.begin(), phases.end());
    for (double& phase : quick) phase *= divisor_;
    return solver_->history(quick, sliders);
  }

  std::vector<Stretch> stretches() const override {
    const std::vector<Stretch> once = solver_->stretches();
    std::vector<Stretch> result;
    for (int turn = 0; turn < divisor_; ++turn) {
      for (const Stretch& stretch : once) {
        result.push_back(stretch);
        result.back().start = (stretch.start + 2.0 * std::numbers::pi * turn) / divisor_;
        result.back().length = stretch.length / divisor_;
      }
    }
    return result;
  }

 private:
  // omega_h, where it is not given, is that of the reference order at the user's own frequency.
  void quicken(NetworkValues& values) {
    follows_frequency_ = !(values.hysteretic_omega > 0.0);
    if (follows_frequency_) values.hysteretic_omega = reference_order_ * values.omega;
    values.omega *= divisor_;
  }

  const NetworkValues& quickened(const NetworkValues& values) {
    values_ = values;
    quicken(values_);
    return values_;
  }

  std::span<const NetworkValues> quickened(std::span<const NetworkValues> directions) {
    directions_.assign(directions.begin(), directions.end());
    for (NetworkValues& direction : directions_) {
      if (follows_frequency_) direction.hysteretic_omega = reference_order_ * direction.omega;
      direction.omega *= divisor_;
    }
    return directions_;
  }

  // A response that takes m of the g-th parts of the period takes m/gcd(m, g) whole periods, in which it
  // repeats g/gcd(m, g) times.
  int whole_periods(int multiple) const { return multiple / std::gcd(multiple, divisor_); }

  // A response over a part of the period, converted to the whole of it.  multiple: as below.
  void convert(std::span<const double> of_part, int multiple, std::span<double> out) const {
    std::size_t next_stops = quantities_.size();
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      const Measure measure = quantities_[i].measure;
      out[i] = measure == Measure::regime
                   ? regime_of_whole_period(of_part[i], of_part[next_stops++], multiple)
                   : of_whole_period(measure, of_part[i], multiple);
    }
  }

  double regime_of_whole_period(double regime, double stops, int multiple) const {
    if (regime != static_cast<double>(Regime::one_stop)) return regime;
    const auto whole = static_cast<int>(of_whole_period(Measure::stops, stops, multiple));
    return static_cast<double>(regime_of_stops(whole));
  }

  // multiple: of the g-th part of the period, that the response takes.
  double of_whole_period(Measure measure, double value, int multiple) const {
    const int times = divisor_ / std::gcd(multiple, divisor_);
    if (!has_reference_ && needs_reference_component(measure)) return kNone;
    if (!has_reference_ && measure == Measure::harmonic) return std::isnan(value) ? kNone : 0.0;
    if (measure == Measure::floquet_radius) return std::pow(value, times);
    const bool is_missing_count = value < 0.0 && is_count(measure);
    if (is_missing_count) return value;
    if (measure == Measure::period_multiple) return whole_periods(multiple);
    return derivative_of_whole_period(measure, value, times);
  }

  // A quantity of the whole period is a multiple of what was found, and so is its derivative.
  double derivative_of_whole_period(Measure measure, double value, int times) const {
    if (!has_reference_ && needs_reference_component(measure)) return kNone;
    if (!has_reference_ && measure == Measure::harmonic) return 0.0;
    if (measure == Measure::peak_phase) return value / divisor_;
    if (measure == Measure::drift) return value * divisor_;  // of one period, however many a response takes
    return is_of_a_period(measure) ? value * times : value;
  }

  int divisor_, reference_order_;
  bool has_reference_ = reference_order_ % divisor_ == 0;
  std::vector<Quantity> quantities_;
  std::size_t solved_;                      // quantities of the solver
  std::unique_ptr<ResponseSolver> solver_;  // of the divided orders
  std::vector<double> of_part_;             // what it gave last
  NetworkValues values_;                    // as it was given them
  std::vector<NetworkValues> row_;          // the same
  std::vector<NetworkValues> directions_;
  ResponseSummary summary_;
  int multiple_ = 1;  // of the response last solved
  bool follows_frequency_ = true, is_differentiable_ = false;
};

}  // namespace

int common_divisor(const Network& network) {
  int divisor = 0;
  for (const Excitation& excitation : network.excitations) divisor = std::gcd(divisor, excitation.order);
  return std::max(divisor, 1);
}

std::unique_ptr<ResponseSolver> divide_orders(
    const Network& network, std::vector<Quantity> quantities,
    const std::function<std::unique_ptr<ResponseSolver>(const Network&, std::vector<Quantity>)>& make) {
  const int divisor = common_divisor(network);
  auto solver = make(divided(network, divisor), with_stops(quantities));
  return std::make_unique<DividedOrders>(divisor, network.reference_order, std::move(quantities),
                                         std::move(solver));
}

}  // namespace frahm::periodic
