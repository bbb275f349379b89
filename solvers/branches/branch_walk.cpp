#include "solvers/branches/branch_walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "solvers/branches/doubling_origin.hpp"
#include "solvers/branches/part_of_branch.hpp"

namespace frahm::periodic {
namespace {

struct StepLimits {
  double first = 1e-3;       // all of the scaled arclength
  double least = 1e-10;      // below, the branch has a corner or is lost
  double kink = 1e-6;        // below, the tangent may turn by any angle: the map has a kink at a grazing
  double most_angle = 0.15;  // between the tangents of neighbours [rad], that a curve is drawn smoothly
  double most_shift = 0.3;   // of a step: how far Newton's method may move its end
  double corner = 1e-5;      // from a corner, the first place beyond
  double most_size = 1e9;    // of a state whose energy is that of the start: what is larger has no bound
};

// Follows a branch one way.
class BranchWalk {
 public:
  BranchWalk(BranchMap& map, const BranchWanted& wanted, const FoundOnBranch& found)
      : map_(map), wanted_(wanted), found_(found) {}

  BranchEnd follow(const BranchPlace& first) {
    here_ = first;
    firsts_ = {first};
    add_later_firsts();
    passed_ = {here_.y};
    step_ = limits_.first;
    if (leaves_range(here_.y, here_.tangent)) return BranchEnd::range;
    for (int points = 1; points < wanted_.most_points;) {
      auto next = take_step();
      if (next && begins_before(*next)) return BranchEnd::origin;
      const bool at_end = next && is_at_end(*next);
      const bool closes = next && !at_end && points >= kLeastLoop && closes_by(*next);
      auto special = next ? between(*next) : std::nullopt;
      if (!special) {
        if (const auto end = shorten_step()) return *end;
        continue;
      }
      ++points;
      const bool is_new = accept(*next, std::move(*special));
      if (at_end) return BranchEnd::range;
      if (closes) return BranchEnd::closed;
      if (!is_new) return BranchEnd::joined;
      if (here_.y.norm() > limits_.most_size) return BranchEnd::unbounded;
      if (here_.section_is_near_event) move_section(here_.better_section);
      if (here_.rests_at_limit) leave_limit();
    }
    return BranchEnd::points;
  }

 private:
  static constexpr int kLeastLoop = 10;

  static bool is_at_end(const BranchPlace& place) {
    const double p = place.y[place.y.size() - 1];
    return p <= 0.0 || p >= 1.0;
  }

  static bool leaves_range(const Eigen::VectorXd& y, const Eigen::VectorXd& tangent) {
    const double p = y[y.size() - 1], rate = tangent[y.size() - 1];
    return (p <= 0.0 && rate <= 0.0) || (p >= 1.0 && rate >= 0.0);
  }

  // Predicts along the tangent and corrects across it; beyond the range, at its end. Nothing where the step
  // is too long.
  std::optional<BranchPlace> take_step() const {
    Eigen::VectorXd predicted = here_.y + step_ * here_.tangent, across = here_.tangent;
    const Eigen::Index last = predicted.size() - 1;
    if (predicted[last] < 0.0 || predicted[last] > 1.0) {
      const double end = predicted[last] < 0.0 ? 0.0 : 1.0;
      predicted = here_.y + (end - here_.y[last]) / here_.parameter_rate() * here_.tangent;
      predicted[last] = end;
      across = Eigen::VectorXd::Unit(last + 1, last);
    }
    auto next = correct(map_, predicted, across, here_.tangent);
    if (!next || !next->is_single || takes_less_time(*next)) return std::nullopt;
    if (next->y[last] < 0.0 || next->y[last] > 1.0) return std::nullopt;
    if (next->grazes && next->events != here_.events) return std::nullopt;  // its tangent is of neither side
    if (across[last] == 1.0) next->y[last] = predicted[last];
    const double shift = (next->y - predicted).norm() / step_;
    const double angle = std::acos(std::clamp(here_.tangent.dot(next->tangent), -1.0, 1.0));
    const bool serves = angle <= limits_.most_angle && shift <= limits_.most_shift;
    return serves || (step_ <= limits_.kink && shift <= 2.0) ? next : std::nullopt;
  }

  // Whether the branch begins on the way to the next place, where orbits of half the period double theirs.
  bool begins_before(const BranchPlace& next) const {
    const auto origin = origin_of_doubling(map_, here_, next);
    if (origin) found_({here_, nullptr, {*origin}});
    return origin.has_value();
  }

  // Whether the step comes by the first place again: it ends there.
  bool closes_by(BranchPlace& next) const {
    const auto first =
        std::ranges::find_if(firsts_, [&](const BranchPlace& each) { return passes(each, next); });
    if (first != firsts_.end()) next = *first;
    return first != firsts_.end();
  }

  // A shorter step; from the shortest on, to another section or beyond a corner. Otherwise why the branch
  // ends.
  std::optional<BranchEnd> shorten_step() {
    step_ *= 0.5;
    if (step_ >= limits_.least || leave_slip()) return std::nullopt;
    if (meets_family()) return BranchEnd::family;
    return pass_corner() ? std::nullopt : std::optional(end_here());
  }

  // What is special between here and the next place. Nothing where the step is too long to know: one of the
  // places is not solved, or between them something happens that both ends do not show.
  std::optional<std::vector<SpecialPlace>> between(const BranchPlace& next) const {
    auto special = special_places(map_, here_, next);
    const bool is_known = std::ranges::all_of(special, &SpecialPlace::is_solved) && shows_all(next, special);
    return is_known || step_ <= limits_.kink ? std::optional(std::move(special)) : std::nullopt;
  }
  bool shows_all(const BranchPlace& next, const std::vector<SpecialPlace>& special) const {
    const auto middle = PartOfBranch(map_, here_, next).place(0.5, here_, next);
    if (!middle || !is_shown(*middle, next) || turns_twice(*middle, next)) return false;
    return std::ranges::all_of(special, [&](const SpecialPlace& each) { return is_shown(each.place, next); });
  }
  // A place between here and the next: its numbers are between theirs.
  bool is_shown(const BranchPlace& place, const BranchPlace& next) const {
    const auto is_between = [](auto value, auto a, auto b) {
      return value >= std::min(a, b) && value <= std::max(a, b);
    };
    for (std::size_t event = 0; event < place.events.size(); ++event)
      if (!is_between(place.events[event], here_.events[event], next.events[event])) return false;
    if (map_.system().monotone) return true;
    return is_between(place.unstable(), here_.unstable(), next.unstable()) &&
           is_between(place.parameter_rate() > 0.0, here_.parameter_rate() > 0.0,
                      next.parameter_rate() > 0.0);
  }
  // Whether the parabola through dp/ds at three places crosses zero between them and comes back.
  bool turns_twice(const BranchPlace& middle, const BranchPlace& next) const {
    if (map_.system().monotone) return false;
    const double a = here_.parameter_rate(), m = middle.parameter_rate(), b = next.parameter_rate();
    // dp/ds = a + slope t + bend t^2, t = 0 .. 1
    const double slope = 4.0 * m - 3.0 * a - b, bend = 2.0 * (a - 2.0 * m + b);
    const double t = -0.5 * slope / bend;  // of its extreme
    if (!(t > 0.0 && t < 1.0) || (a > 0.0) != (b > 0.0)) return false;
    return (a + 0.5 * slope * t > 0.0) != (a > 0.0);
  }

  // Whether the orbit of a place takes the multiple divided by a prime: it is on another branch, which
  // crosses this one or from which it comes.
  bool takes_less_time(const BranchPlace& place) const {
    constexpr double kSame = 1e-9;
    int left = map_.multiple();  // without the primes that were asked
    for (int part = 2; part <= left; ++part) {
      if (left % part != 0) continue;
      while (left % part == 0) left /= part;
      const Eigen::VectorXd gap = map_.gap_after(part, place.y);
      if (gap.size() > 0 && gap.norm() < kSame * std::max(1.0, place.y.norm())) return true;
    }
    return false;
  }

  // The same orbit as at the first place, seen each period of the excitation later: the branch may close
  // there.
  void add_later_firsts() {
    const double turn = 2.0 * std::numbers::pi;
    const BranchPlace first = firsts_.front();
    const Eigen::VectorXd along = Eigen::VectorXd::Unit(first.y.size(), first.y.size() - 1);
    firsts_.resize(1);
    for (int later = 1; later < map_.multiple(); ++later) {
      const double there = std::fmod(map_.section() + turn * later / map_.multiple(), turn);
      const Eigen::VectorXd y = map_.moved(first.y, there);
      if (y.size() == 0) continue;
      if (auto place = correct(map_, y, along, first.parameter_rate() * along))
        firsts_.push_back(std::move(*place));
    }
  }

  // To a section at which fewer sliders slip. False: there is none.
  bool leave_slip() {
    const auto section = map_.section_of_least_slip(here_.y);
    if (!section || !move_section(*section)) return false;
    step_ = limits_.kink;
    return true;
  }

  // What sticks throughout may rest anywhere in an interval. Where the end of the interval moves on, every
  // place after this one would have a force that just reaches its limit.
  void leave_limit() {
    const Eigen::VectorXd middle = map_.at_rest_in_the_middle(here_.y);
    if (middle.size() == 0) return;
    auto place = correct(map_, middle, here_.tangent, here_.tangent);
    if (!place) return;
    here_ = std::move(*place);
    passed_.push_back(here_.y);
  }

  // Goes on where the map has a kink so sharp that the branch turns back: both of its ends are on this side
  // of the plane across the tangent. The tangent beyond the kink is that of the map there.
  bool pass_corner() {
    const Shot beyond = map_.shoot(here_.y + limits_.corner * here_.tangent);
    if (beyond.failed) return false;
    const Eigen::VectorXd ahead = branch_tangent(beyond.derivative, here_.tangent);
    for (const Eigen::VectorXd& way : {Eigen::VectorXd(-ahead), ahead}) {
      // Nearer by as much as the step is shorter, or the map jumps and the branch ends here.
      const auto next = beyond_corner(way, limits_.corner);
      if (!next || !beyond_corner(way, 0.1 * limits_.corner)) continue;
      found_({here_, &*next, {corner_before(*next)}});
      here_ = *next;
      passed_.push_back(here_.y);
      step_ = limits_.corner;
      return true;
    }
    return false;
  }

  std::optional<BranchPlace> beyond_corner(const Eigen::VectorXd& way, double distance) const {
    constexpr double kNear = 30.0;  // several events may begin together, each with its own map
    constexpr double kSame = 1e-4;
    auto next = correct(map_, here_.y + distance * way, way, way);
    if (!next || !next->is_single || next->order == here_.order) return std::nullopt;
    if (const double p = next->y[next->y.size() - 1]; p < 0.0 || p > 1.0) return std::nullopt;
    const Eigen::VectorXd on = next->y - here_.y;
    if (on.norm() > kNear * distance) return std::nullopt;
    const auto before = come_by(here_.tangent.dot(on));  // not on the way back
    if (before && (before->y - next->y).norm() < kSame * on.norm()) return std::nullopt;
    if (next->tangent.dot(on) < 0.0) next->tangent *= -1.0;
    return next;
  }

  // The place that the branch has come by, so far along the tangent (< 0) from here.
  std::optional<BranchPlace> come_by(double along) const {
    const auto from_here = [this](const Eigen::VectorXd& y) { return here_.tangent.dot(y - here_.y); };
    for (std::size_t i = passed_.size(); i-- > 1;) {
      const double near = from_here(passed_[i]), far = from_here(passed_[i - 1]);
      if (along < far || along > near || near == far) continue;
      const Eigen::VectorXd chord = passed_[i - 1] - passed_[i];
      return correct(map_, passed_[i] + (along - near) / (far - near) * chord, here_.tangent, here_.tangent);
    }
    return std::nullopt;
  }

  SpecialPlace corner_before(const BranchPlace& next) const {
    const bool turns = (here_.parameter_rate() > 0.0) != (next.parameter_rate() > 0.0);
    const SpecialKind kind = turns ? SpecialKind::corner : SpecialKind::grazing;
    if (next.events == here_.events) return {kind, here_, std::nullopt, limits_.least};
    const std::size_t event = event_before(next.events);
    return {kind, here_, element_of_event(map_.assembly(), event),
            residual_of_grazing(map_, here_, limits_.least, event)};
  }

  // The first that happens more or less often there than here.
  std::size_t event_before(const std::vector<int>& there) const {
    return static_cast<std::size_t>(std::ranges::mismatch(here_.events, there).in1 - here_.events.begin());
  }

  bool meets_family() const {
    for (double step = limits_.least; step < limits_.kink; step *= 10.0) {
      const auto next = correct(map_, here_.y + step * here_.tangent, here_.tangent, here_.tangent);
      if (next && !next->is_single) return true;
    }
    return false;
  }

  // Why no place continues the branch.
  BranchEnd end_here() {
    constexpr double kAtEnd = 1e-8;  // of the range
    if (leaves_range(here_.y + kAtEnd * here_.tangent / std::abs(here_.parameter_rate()), here_.tangent))
      return BranchEnd::range;
    Eigen::VectorXd beyond = here_.y + limits_.corner * here_.tangent;
    beyond[beyond.size() - 1] = std::clamp(beyond[beyond.size() - 1], 0.0, 1.0);
    try {
      map_.set(map_.parameter(beyond));
    } catch (const mechanics::MechanicsError&) {
      return BranchEnd::rule;
    }
    const Shot shot = map_.pass(beyond, Tangent::none);
    if (shot.failed) return BranchEnd::lost;
    const std::vector<int> there = count_events(map_.flow(), shot.passage);
    if (there == here_.events) return BranchEnd::lost;
    const std::size_t element = element_of_event(map_.assembly(), event_before(there));
    found_({here_, nullptr, {{SpecialKind::jump, here_, element, limits_.least}}});
    return BranchEnd::jump;
  }

  // The step that led to the first place again, or past it: where it meets the plane through this place, it
  // is there. In a wide range of the parameter other parts of the branch come near.
  bool passes(const BranchPlace& first, const BranchPlace& next) const {
    constexpr double kSame = 1e-6;
    const Eigen::VectorXd to_first = first.y - here_.y;
    const double along = here_.tangent.dot(to_first);
    const bool is_near =
        along > 0.0 && along <= here_.tangent.dot(next.y - here_.y) && to_first.norm() < 2.0 * step_ &&
        (to_first - along * here_.tangent).norm() < 0.5 * step_ && here_.tangent.dot(first.tangent) > 0.9;
    if (!is_near) return false;
    const auto place = correct(map_, here_.y + along * here_.tangent, here_.tangent, here_.tangent);
    return place && (place->y - first.y).norm() < kSame * std::max(1.0, first.y.norm());
  }

  // False: the branch is known from there on.
  bool accept(const BranchPlace& next, std::vector<SpecialPlace> special) {
    constexpr double kGrow = 1.5;
    constexpr int kFast = 4;  // Newton's steps
    const double angle = std::acos(std::clamp(here_.tangent.dot(next.tangent), -1.0, 1.0));
    const bool is_new = found_({here_, &next, std::move(special)});
    if (next.newton_iterations <= kFast && angle < 0.5 * limits_.most_angle)
      step_ = std::min(kGrow * step_, wanted_.largest_step * std::max(1.0, next.y.norm()));
    here_ = next;
    passed_.push_back(here_.y);
    return is_new;
  }

  // Away from events: where one passes the section, the curve of states there has a kink. Its tangent is
  // found from the chord of the last two places.
  bool move_section(double to) {
    if (passed_.size() < 2) return false;
    const Eigen::VectorXd before = map_.moved(passed_[passed_.size() - 2], to),
                          first = map_.moved(firsts_.front().y, to);
    const Eigen::VectorXd now = map_.moved(here_.y, to);
    if (before.size() == 0 || first.size() == 0 || now.size() == 0) return false;
    const double from = map_.section();
    map_.set_section(to);
    const Eigen::VectorXd chord = (now - before).normalized();
    const Eigen::VectorXd along = Eigen::VectorXd::Unit(now.size(), now.size() - 1);
    auto place = correct(map_, now, chord, chord);
    const auto start = correct(map_, first, along, firsts_.front().parameter_rate() * along);
    if (!place || !start) return map_.set_section(from), false;
    // The parameter goes on the same way at each section.
    if ((place->parameter_rate() > 0.0) != (here_.parameter_rate() > 0.0)) place->tangent *= -1.0;
    here_ = std::move(*place);
    firsts_ = {*start};
    add_later_firsts();
    passed_ = {before, here_.y};
    return true;
  }

  BranchMap& map_;
  const BranchWanted& wanted_;
  const FoundOnBranch& found_;
  StepLimits limits_;
  BranchPlace here_;
  std::vector<BranchPlace> firsts_;      // the first place, then those of add_later_firsts
  std::vector<Eigen::VectorXd> passed_;  // the last one is here
  double step_ = 0.0;
};

}  // namespace

BranchEnd walk_branch(BranchMap& map, const BranchWanted& wanted, const BranchPlace& first,
                      const FoundOnBranch& found) {
  const double section = map.section();
  const BranchEnd end = BranchWalk(map, wanted, found).follow(first);
  map.set_section(section);
  return end;
}

}  // namespace frahm::periodic
