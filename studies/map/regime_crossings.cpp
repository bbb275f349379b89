#include "studies/map/regime_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "solvers/algebra/no_value.hpp"

namespace frahm::studies {
namespace {

using periodic::Regime;

// [rad] A shorter stop does not count in the regimes (1e-9 of a period); one little longer is about to
// vanish.
constexpr double shortest_event = 2e-9 * std::numbers::pi;
constexpr double nearly_vanished = 3.0;
// From the change of regimes to the zero of the event; a larger correction is due to rounding.
constexpr double most_correction = 1e-4;
// Parts of parts that are searched where third regimes are met: 2^5 crossings of an edge at most.
constexpr int deepest_part = 5;
// Probes around a forecast, each farther than the one before; after that the forecast is dropped.
constexpr int most_forecast_steps = 4;
constexpr double widening = 4.0;
// Steps by extrapolation that may leave more than half of the bracket, one after the other.
constexpr int most_poor_steps = 2;

// How rich in events a regime is. An event that vanishes at a crossing is seen on the richer side.
int richness(Regime regime) {
  return regime == Regime::one_stop ? 1 : regime == Regime::multi_stop ? 2 : 0;
}

// One crossing between two positions of different regimes.
class Bracket {
 public:
  Bracket(double low, Regime below, double high, Regime above,
          const std::optional<CrossingForecast>& forecast = std::nullopt)
      : first_(low), last_(high), low_(low), high_(high), below_(below), above_(above), forecast_(forecast) {}

  double width() const { return high_ - low_; }
  bool is_narrow() const { return width() <= crossing_width; }
  bool holds(Regime regime) const { return regime == below_ || regime == above_; }
  // The position where the briefest event has vanished, if this was seen.
  RegimeCrossing crossing() const;
  double high() const { return high_; }
  Regime above() const { return above_; }

  // The next position to probe.
  double proposal();
  // Narrows the bracket to the point.
  void narrow(double at, const RegimePoint& point);
  // The part below `at`, where another regime was met.
  void cut(double at, Regime regime) {
    last_ = high_ = at;
    above_ = regime;
    seen_.clear();
    estimate_.reset();
    forecast_.reset();
  }

 private:
  struct Seen {
    double at, briefest;
  };

  double vanishing_place() const;
  std::optional<double> extrapolated() const;
  std::optional<double> forecast();

  double first_, last_;  // the whole part that is searched
  double low_, high_;
  Regime below_, above_;
  std::vector<Seen> seen_;          // on the richer side, the last three
  std::optional<double> estimate_;  // the last one of the crossing
  double error_ = 0.0;              // of the estimate, by its last change
  int poor_steps_ = 0;
  std::optional<CrossingForecast> forecast_;  // nothing once the crossing is known to lie near, or not to
  int forecast_steps_ = 0;
};

// Where the briefest event vanishes: the position as a polynomial of its length. The length is proportional
// to the distance, or to its square root, where a velocity only just touches zero; the quadratic polynomial
// covers both.
double Bracket::vanishing_place() const {
  double at = 0.0;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    double weight = 1.0;
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      if (k != i) weight *= seen_[k].briefest / (seen_[k].briefest - seen_[i].briefest);
    }
    at += weight * seen_[i].at;
  }
  return at;
}

std::optional<double> Bracket::extrapolated() const {
  if (seen_.size() < 2) return std::nullopt;
  const double at = vanishing_place();
  if (!(at > low_ && at < high_)) return std::nullopt;
  return at;
}

RegimeCrossing Bracket::crossing() const {
  double at = 0.5 * (low_ + high_);
  const bool vanishes = std::ranges::any_of(
      seen_, [](const Seen& seen) { return seen.briefest < nearly_vanished * shortest_event; });
  if (vanishes && seen_.size() == 3) {
    const double there = std::clamp(vanishing_place(), first_, last_);
    if (std::abs(there - at) < most_correction) at = there;
  }
  return {at, below_, above_};
}

// At the forecast, then farther and farther on the side of the crossing.
std::optional<double> Bracket::forecast() {
  if (!forecast_) return std::nullopt;
  double at = forecast_->at;
  const bool was_seen = forecast_steps_ > 0;
  if (was_seen) at = at <= low_ ? low_ + forecast_->reach : high_ - forecast_->reach;
  if (was_seen) forecast_->reach *= widening;
  ++forecast_steps_;
  const bool encloses = low_ > 0.0 && high_ < 1.0;
  if (!encloses && forecast_steps_ <= most_forecast_steps && at > low_ && at < high_) return at;
  forecast_.reset();
  poor_steps_ = 0;
  return std::nullopt;
}

double Bracket::proposal() {
  if (const auto at = forecast()) return *at;
  const double middle = 0.5 * (low_ + high_);
  if (poor_steps_ >= most_poor_steps) {
    poor_steps_ = 0;
    return middle;
  }
  const std::optional<double> estimate = extrapolated();
  // A second position to extrapolate from is more likely near the first.
  if (seen_.size() == 1) return seen_.front().at == low_ ? low_ + 0.25 * width() : high_ - 0.25 * width();
  if (!estimate) return middle;
  // On the far side of the estimate, so that the bracket closes from both ends.
  if (!estimate_) {
    error_ = 0.1 * width();
  } else if (*estimate != *estimate_) {
    error_ = std::abs(*estimate - *estimate_);
  }
  const double step = std::clamp(error_, 0.3 * crossing_width, 0.25 * width());
  estimate_ = estimate;
  const bool low_is_far = *estimate - low_ > high_ - *estimate;
  const double at = low_is_far ? *estimate - step : *estimate + step;
  return at > low_ && at < high_ ? at : middle;
}

void Bracket::narrow(double at, const RegimePoint& point) {
  const double before = width();
  (point.regime == below_ ? low_ : high_) = at;
  poor_steps_ = width() > 0.5 * before ? poor_steps_ + 1 : 0;
  const Regime richer = richness(below_) > richness(above_) ? below_ : above_;
  if (point.regime != richer || richness(below_) == richness(above_) ||
      !(point.briefest > 0.0 && std::isfinite(point.briefest)))
    return;
  std::erase_if(seen_, [&](const Seen& seen) { return seen.briefest == point.briefest; });
  if (seen_.size() == 3) seen_.erase(seen_.begin());
  seen_.push_back({at, point.briefest});
}

// Appends the crossings of a part; its own parts are searched in turn.
void search(Bracket bracket, int depth, const std::function<RegimePoint(double)>& probe,
            std::vector<RegimeCrossing>& crossings) {
  while (!bracket.is_narrow()) {
    const double at = bracket.proposal();
    const RegimePoint point = probe(at);
    if (bracket.holds(point.regime)) {
      bracket.narrow(at, point);
      continue;
    }
    const Bracket upper(at, point.regime, bracket.high(), bracket.above());
    bracket.cut(at, point.regime);
    if (!has_regime(point.regime)) return;
    if (depth < deepest_part) {
      search(bracket, depth + 1, probe, crossings);
      return search(upper, depth + 1, probe, crossings);
    }
  }
  crossings.push_back(bracket.crossing());
}

}  // namespace

bool has_regime(Regime regime) {
  return regime != Regime::not_computed && regime != Regime::no_friction;
}

RegimePoint regime_point(Regime regime, const std::vector<periodic::Stretch>& stretches,
                         std::size_t element) {
  const auto sticks = [&](const periodic::Stretch& stretch) { return stretch.contacts[element] == "sticks"; };
  double briefest = kInfinity;
  // From the first change between sticking and sliding once around.
  const std::size_t n = stretches.size();
  std::size_t first = 0;
  while (first < n && sticks(stretches[first]) == sticks(stretches[(first + n - 1) % n])) ++first;
  if (first == n) return {regime, kNone};
  double length = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const periodic::Stretch& stretch = stretches[(first + i) % n];
    length += stretch.length;
    if (sticks(stretch) == sticks(stretches[(first + i + 1) % n])) continue;
    if (length > shortest_event) briefest = std::min(briefest, length);
    length = 0.0;
  }
  return {regime, briefest};
}

std::vector<RegimeCrossing> find_crossings(Regime first, Regime last,
                                           const std::function<RegimePoint(double)>& probe,
                                           const std::optional<CrossingForecast>& forecast) {
  std::vector<RegimeCrossing> crossings;
  if (first != last && has_regime(first) && has_regime(last))
    search(Bracket(0.0, first, 1.0, last, forecast), 0, probe, crossings);
  return crossings;
}

}  // namespace frahm::studies
