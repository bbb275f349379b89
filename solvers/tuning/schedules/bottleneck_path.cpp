#include "solvers/tuning/schedules/bottleneck_path.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::tuning {
namespace {

using Index = Eigen::Index;

// What a path has cost up to a column of a bend, and where it came from.
struct Arrival {
  double cost = kInfinity;
  std::size_t from = 0;
  bool leaps = false;  // over the piece before this bend
};

class Crossing {
 public:
  Crossing(const Eigen::MatrixXd& heights, std::span<const std::size_t> bends,
           std::span<const std::size_t> most_step, bool may_leap)
      : heights_(heights),
        bends_(bends),
        most_step_(most_step),
        layers_(may_leap ? 2 : 1),
        levels_(static_cast<std::size_t>(heights.cols())) {}

  BottleneckPath path() {
    // 1. The least worst height.
    run([](double before, double height) { return std::max(before, height); });
    BottleneckPath path;
    path.worst = arrival(bends_.size() - 1, best_end()).cost;
    if (std::isinf(path.worst)) return path;
    // 2. Of the paths that nowhere exceed it, one of least sum.
    most_ = path.worst;
    run([](double before, double height) { return before + height; });
    trace(path);
    return path;
  }

 private:
  // A column in a layer: before the leap (0) or after it (1).
  struct Place {
    std::size_t layer = 0, level = 0;
  };
  Arrival& arrival(std::size_t bend, Place place) {
    return arrivals_[(bend * layers_ + place.layer) * levels_ + place.level];
  }

  double height(std::size_t row, std::size_t level) const {
    return heights_(static_cast<Index>(row), static_cast<Index>(level));
  }

  // The highest point inside a straight piece.
  double highest_between(std::size_t piece, std::size_t from, std::size_t to) const {
    const std::size_t first = bends_[piece], last = bends_[piece + 1];
    double highest = -kInfinity;
    for (std::size_t row = first + 1; row < last; ++row) {
      const double share = static_cast<double>(row - first) / static_cast<double>(last - first);
      const double level = std::lerp(static_cast<double>(from), static_cast<double>(to), share);
      const auto below = std::min(static_cast<std::size_t>(level), levels_ - 1);
      const auto above = std::min(below + 1, levels_ - 1);
      const double part = level - static_cast<double>(below);
      const double at =
          part == 0.0 ? height(row, below) : std::lerp(height(row, below), height(row, above), part);
      highest = std::max(highest, at);
    }
    return highest;
  }

  template <class Join>
  void run(const Join& join) {
    arrivals_.assign(bends_.size() * layers_ * levels_, {});
    for (std::size_t level = 0; level < levels_; ++level) {
      if (const double start = height(0, level); start <= most_) arrival(0, {0, level}).cost = start;
    }
    for (std::size_t piece = 0; piece + 1 < bends_.size(); ++piece) {
      for (std::size_t layer = 0; layer < layers_; ++layer) go_on(piece, layer, join);
      if (layers_ == 2) leap(piece, join);
    }
  }

  template <class Join>
  void go_on(std::size_t piece, std::size_t layer, const Join& join) {
    const bool minimax = most_ == kInfinity;
    for (std::size_t to = 0; to < levels_; ++to) {
      const double here = height(bends_[piece + 1], to);
      if (!(here <= most_)) continue;
      Arrival& best = arrival(piece + 1, {layer, to});
      const std::size_t step = std::min(most_step_[piece], levels_);
      const std::size_t last = std::min(to + step, levels_ - 1);
      for (std::size_t from = to > step ? to - step : 0; from <= last; ++from) {
        double cost = join(arrival(piece, {layer, from}).cost, here);
        if (!(cost < best.cost)) continue;
        const double between = highest_between(piece, from, to);
        if (between > most_) continue;
        if (minimax) cost = std::max(cost, between);
        if (cost < best.cost) best = {cost, from, false};
      }
    }
  }

  template <class Join>
  void leap(std::size_t piece, const Join& join) {
    std::size_t from = 0;
    for (std::size_t level = 1; level < levels_; ++level) {
      if (arrival(piece, {0, level}).cost < arrival(piece, {0, from}).cost) from = level;
    }
    for (std::size_t to = 0; to < levels_; ++to) {
      const double here = height(bends_[piece + 1], to);
      const double cost = join(arrival(piece, {0, from}).cost, here);
      Arrival& best = arrival(piece + 1, {1, to});
      if (here <= most_ && cost < best.cost) best = {cost, from, true};
    }
  }

  Place best_end() {
    Place best;
    for (std::size_t layer = 0; layer < layers_; ++layer) {
      for (std::size_t level = 0; level < levels_; ++level) {
        const Place end{layer, level};
        if (arrival(bends_.size() - 1, end).cost < arrival(bends_.size() - 1, best).cost) best = end;
      }
    }
    return best;
  }

  void trace(BottleneckPath& path) {
    path.levels.resize(bends_.size());
    Place place = best_end();
    for (std::size_t bend = bends_.size(); bend-- > 0;) {
      path.levels[bend] = place.level;
      if (bend == 0) break;
      const Arrival& reached = arrival(bend, place);
      if (reached.leaps) {
        path.leap = bend - 1;
        place.layer = 0;
      }
      place.level = reached.from;
    }
  }

  const Eigen::MatrixXd& heights_;
  const std::span<const std::size_t> bends_, most_step_;
  const std::size_t layers_, levels_;
  double most_ = kInfinity;  // height that the path may have
  std::vector<Arrival> arrivals_;
};

}  // namespace

BottleneckPath bottleneck_path(const Eigen::MatrixXd& heights, std::span<const std::size_t> bends,
                               std::span<const std::size_t> most_step, bool may_leap) {
  return Crossing(heights, bends, most_step, may_leap).path();
}

}  // namespace frahm::tuning
