#include "solvers/tuning/stages/leap_place.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/stages/design_tuning.hpp"
#include "solvers/tuning/stages/path_search.hpp"

namespace frahm::tuning {
namespace {

constexpr int kMoves = 16;  // of the place, at most
constexpr double kFalls =
    1e-7;  // of the worst peak, relative: by which the last move may miss what it promised
constexpr double kClose = 1e-5;      // of the band: the tangents of places as close promise what there is
constexpr double kNarrow = 1e-9;     // of the band: where two places are closer the leap is found
constexpr double kFirstMove = 1e-3;  // of the band, a part of the way between the path's places
constexpr double kGrowth = 4.0;      // of the moves until the worst peak rises
constexpr double kBeyond = 3.0;      // times the way to where the tangents meet
constexpr double kApart = 3.0;       // leap widths between a leap and the next knot

std::size_t leaping_parameter(const Task& task) {
  const auto leaps = [](const DesignParameter& p) { return p.schedule && p.schedule->may_leap; };
  return static_cast<std::size_t>(std::ranges::find_if(task.parameters, leaps) - task.parameters.begin());
}

double leap_width(const Task& task) {
  return kLeapWidth * std::max(std::abs(task.band.from), std::abs(task.band.to));
}

// A design at the knots of another leap: each side goes on with its last value.
std::vector<double> moved(const Task& from, const Task& to, const std::vector<double>& x) {
  const std::size_t p = leaping_parameter(from);
  const Schedule &before = *from.parameters[p].schedule, &after = *to.parameters[p].schedule;
  const DesignSpace space(from.parameters);
  const double left_end = before.knots[*before.leap], right_end = before.knots[*before.leap + 1];
  std::vector<double> at = x;
  for (std::size_t k = 0; k < after.knots.size(); ++k) {
    const double knot = after.knots[k];
    const double held = k <= *after.leap ? std::min(knot, left_end) : std::max(knot, right_end);
    at[space.first(p) + k] = space.interpolation(p, held, x).value;
  }
  return at;
}

// The best schedules with a leap at its place.
struct LeapAt {
  Task task;
  Exchange::Result result;
  double place = 0.0;
  double slope = 0.0;  // d worst / d place

  bool is_tuned() const { return result.has_step && result.outcome != Outcome::stopped; }
  double worst() const { return result.scan.worst; }
};

// d worst / d place by the envelope theorem: as the leap moves, each of its sides goes on along the band, and
// all else is at its best already. The sum over the active points at the sides of multiplier dX/dband.
double slope_by_place(const Task& task, const std::vector<QuantityLimit>& limits,
                      const Exchange::Result& result, Effort& effort,
                      const std::function<bool()>& stop_asked) {
  const Schedule& schedule = *task.parameters[leaping_parameter(task)].schedule;
  const double left = schedule.knots[*schedule.leap], right = schedule.knots[*schedule.leap + 1];
  const double near = 0.1 * (right - left);
  DesignTuning tuning(task, limits, effort, stop_asked);
  double sum = 0.0;
  for (std::size_t i = 0; i < result.step.active.size(); ++i) {
    const ActivePoint& point = result.step.active[i];
    const bool at_left = std::abs(point.at - left) < near, at_right = std::abs(point.at - right) < near;
    const double multiplier = result.step.solution.constraint_multipliers[result.step.rows.first + i];
    if ((!at_left && !at_right) || multiplier <= 0.0) continue;
    BandCurve curve(task, tuning.space(), tuning.curves()[point.curve], effort);
    if (curve.solve(result.x, point.at, Derivatives::along_band) != TunedResponse::State::solved) continue;
    sum += multiplier * (at_left ? curve.slope_left(point.side) : curve.slope_right(point.side));
  }
  return sum;
}

LeapAt tuned_at(Task task, const std::vector<QuantityLimit>& limits, const std::vector<double>& x,
                Effort& effort, const std::function<bool()>& stop_asked) {
  LeapAt at{.task = std::move(task), .result = {}};
  const Schedule& schedule = *at.task.parameters[leaping_parameter(at.task)].schedule;
  at.place = 0.5 * (schedule.knots[*schedule.leap] + schedule.knots[*schedule.leap + 1]);
  at.result = DesignTuning(at.task, limits, effort, stop_asked).schedules_from(x);
  if (at.is_tuned()) at.slope = slope_by_place(at.task, limits, at.result, effort, stop_asked);
  return at;
}

// Where the tangents of two places meet, the one falling towards the other.
struct Meeting {
  double place = 0.0, worst = 0.0;
};
Meeting tangents_meet(const LeapAt& falls, const LeapAt& rises) {
  // w_f + s_f (p - p_f) = w_r + s_r (p - p_r)
  const double from_falls = (rises.worst() - falls.worst() - rises.slope * (rises.place - falls.place)) /
                            (falls.slope - rises.slope);
  return {falls.place + from_falls, falls.worst() + falls.slope * from_falls};
}

// The lowest place downhill of a first one: in growing moves until the worst peak rises again, then between
// the two places about the lowest. A leap is best where both its sides are equally high, a kink of the worst
// peak: there the tangents of the two meet. Where that does not halve the way between them, a place beyond
// follows, to come upon the other side of the kink.
class Descent {
 public:
  Descent(const Task& task, const LeapAt& first) : task_(task), lowest_(first) { join(first); }

  const LeapAt& lowest() const { return lowest_; }

  // The next place to look at; none where no move helps.
  std::optional<double> next() {
    promised_ = kNone;
    if (!falls_ && !rises_) return std::nullopt;
    if (falls_ && rises_) return between();
    const double place = falls_ ? falls_->place + step_ : rises_->place - step_;
    step_ *= kGrowth;
    if (place <= task_.band.from || place >= task_.band.to) return std::nullopt;
    return place;
  }

  void join(const LeapAt& found) {
    is_met_ = std::abs(found.worst() - promised_) < kFalls * found.worst();
    if (found.slope == 0.0) falls_ = rises_ = std::nullopt;  // neither side holds the worst peak
    if (found.slope < 0.0) falls_ = with_secant(found, falls_);
    if (found.slope > 0.0) rises_ = with_secant(found, rises_);
    if (found.worst() < lowest_.worst()) lowest_ = found;
  }

 private:
  // With the slope from the last place on the same side of the kink, which is the better one once they are
  // close: the multipliers, some per cent of which other points carry, serve for the first.
  static LeapAt with_secant(LeapAt found, const std::optional<LeapAt>& last) {
    if (!last || last->place == found.place) return found;
    const double slope = (found.worst() - last->worst()) / (found.place - last->place);
    if (slope * found.slope > 0.0) found.slope = slope;
    return found;
  }

  std::optional<double> between() {
    const double width = rises_->place - falls_->place;
    const double length = task_.band.to - task_.band.from;
    if ((is_met_ && width < kClose * length) || width < kNarrow * length) return std::nullopt;
    const Meeting meeting = tangents_meet(*falls_, *rises_);
    const double middle = falls_->place + 0.5 * width;
    const bool is_inside = meeting.place > falls_->place && meeting.place < rises_->place;
    const bool halves = width < 0.5 * width_;
    width_ = is_inside && halves ? width : kInfinity;  // after another place the tangents again
    if (!is_inside) return middle;
    if (!halves) {
      return meeting.place < middle
                 ? std::min(middle, falls_->place + kBeyond * (meeting.place - falls_->place))
                 : std::max(middle, rises_->place - kBeyond * (rises_->place - meeting.place));
    }
    promised_ = meeting.worst;
    return meeting.place;
  }

  const Task& task_;
  LeapAt lowest_;
  std::optional<LeapAt> falls_, rises_;  // with the place
  double step_ = kFirstMove * (task_.band.to - task_.band.from);
  double width_ = kInfinity;  // between the two, when the tangents were used last
  double promised_ = kNone;   // by the tangents
  bool is_met_ = false;       // the last place is as low as they promised
};

}  // namespace

bool may_leap(const Task& task) {
  return leaping_parameter(task) < task.parameters.size();
}

Task with_leap_at(const Task& task, double place) {
  Task leaping = task;
  Schedule& schedule = *leaping.parameters[leaping_parameter(task)].schedule;
  std::vector<double>& knots = schedule.knots;
  const double width = leap_width(task), room = kApart * width;
  place = std::clamp(place, knots.front() + room, knots.back() - room);
  const auto above = std::ranges::upper_bound(knots, place);
  const auto below = above - 1;
  if (place - *below < room) place = *below + room;
  if (*above - place < room) place = *above - room;
  schedule.leap = static_cast<std::size_t>(above - knots.begin());
  knots.insert(above, {place - 0.5 * width, place + 0.5 * width});
  return leaping;
}

Task with_knots_of(const Task& task, const Optimum& optimum) {
  Task settled = task;
  for (std::size_t p = 0; p < task.parameters.size() && p < optimum.parameters.size(); ++p) {
    std::optional<Schedule>& schedule = settled.parameters[p].schedule;
    const std::vector<double>& knots = optimum.parameters[p].knots;
    if (!schedule || knots.size() == schedule->knots.size() || knots.empty()) continue;
    schedule->knots = knots;
    const auto is_leap = [&](double left, double right) { return right - left < 1.5 * leap_width(task); };
    schedule->leap = static_cast<std::size_t>(std::ranges::adjacent_find(knots, is_leap) - knots.begin());
  }
  return settled;
}

LeapDecided decide_leap(const Task& task, const std::vector<QuantityLimit>& limits,
                        const std::vector<double>& value, Effort& effort,
                        const std::function<bool()>& stop_asked) {
  const double middle = 0.5 * (task.band.from + task.band.to);
  if (!PathSearch::serves(task)) return {with_leap_at(task, middle), {}};
  const auto path = PathSearch(task, limits, effort.orbits, stop_asked).best(value);
  if (!path) return {with_leap_at(task, middle), {}};
  Task best = with_leap_at(task, path->leap.value_or(middle));
  // The path's values at the knots, and at both sides of the leap those of the knots next to it.
  std::vector<double> x = path->x;
  const std::size_t leap = *best.parameters[leaping_parameter(task)].schedule->leap;
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(
                                  DesignSpace(task.parameters).first(leaping_parameter(task)) + leap);
  x.insert(at, {*(at - 1), *at});
  const LeapAt first = tuned_at(std::move(best), limits, x, effort, stop_asked);
  if (!first.is_tuned()) return {first.task, {}};
  Descent descent(task, first);
  for (int move = 0; move < kMoves && !stop_asked(); ++move) {
    const std::optional<double> place = descent.next();
    if (!place) break;
    Task tried = with_leap_at(task, *place);
    const std::vector<double> from = moved(descent.lowest().task, tried, descent.lowest().result.x);
    tried.solver = SolverKind::slsqp;  // goes on from a design that is nearly right at once
    LeapAt found = tuned_at(std::move(tried), limits, from, effort, stop_asked);
    found.task.solver = task.solver;
    if (!found.is_tuned()) break;
    descent.join(found);
  }
  return {descent.lowest().task, descent.lowest().result.x};
}

}  // namespace frahm::tuning
