// The bottleneck path against every path of small landscapes.
#include "solvers/tuning/schedules/bottleneck_path.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/algebra/no_value.hpp"

namespace bottleneck_path_test {
using frahm::kInfinity;
using frahm::tuning::bottleneck_path;
using frahm::tuning::BottleneckPath;

namespace {

using Levels = std::vector<std::size_t>;

constexpr double rounding = 1e-14;  // of heights about 1 between two columns

struct Landscape {
  Eigen::MatrixXd heights;
  std::vector<std::size_t> bends, most_step;
};

Landscape drawn(std::mt19937& numbers, Eigen::Index rows, Eigen::Index columns) {
  std::uniform_real_distribution<double> height(0.0, 1.0);
  Landscape landscape{Eigen::MatrixXd(rows, columns), {0}, {}};
  for (double& each : landscape.heights.reshaped()) each = height(numbers);
  for (Eigen::Index row = 1; row + 1 < rows; ++row) {
    if (numbers() % 3 != 0) landscape.bends.push_back(static_cast<std::size_t>(row));
  }
  landscape.bends.push_back(static_cast<std::size_t>(rows - 1));
  for (std::size_t k = 0; k + 1 < landscape.bends.size(); ++k) landscape.most_step.push_back(numbers() % 4);
  return landscape;
}

// The height of a path at every row, but for a piece left out; infinite where it is too steep.
double worst_of(const Landscape& landscape, const Levels& levels, std::size_t leap) {
  double worst = landscape.heights(0, static_cast<Eigen::Index>(levels[0]));
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    const auto from = static_cast<double>(levels[k]), to = static_cast<double>(levels[k + 1]);
    const std::size_t first = landscape.bends[k], last = landscape.bends[k + 1];
    if (k != leap && std::abs(to - from) > static_cast<double>(landscape.most_step[k])) return kInfinity;
    for (std::size_t row = k == leap ? last : first + 1; row <= last; ++row) {
      const double level =
          from + (to - from) * static_cast<double>(row - first) / static_cast<double>(last - first);
      const auto below = static_cast<Eigen::Index>(std::floor(level)), at = static_cast<Eigen::Index>(row);
      const Eigen::Index above = std::min(below + 1, landscape.heights.cols() - 1);
      const double part = level - std::floor(level);
      worst =
          std::max(worst, (1.0 - part) * landscape.heights(at, below) + part * landscape.heights(at, above));
    }
  }
  return worst;
}

double sum_of(const Landscape& landscape, const Levels& levels) {
  double sum = 0.0;
  for (std::size_t k = 0; k < levels.size(); ++k)
    sum += landscape.heights(static_cast<Eigen::Index>(landscape.bends[k]),
                             static_cast<Eigen::Index>(levels[k]));
  return sum;
}

// Calls for every choice of levels at the bends, with no leap or one over each piece.
template <class Call>
void for_each_path(const Landscape& landscape, bool may_leap, const Call& call) {
  const auto columns = static_cast<std::size_t>(landscape.heights.cols());
  const std::size_t pieces = landscape.most_step.size();
  Levels levels(landscape.bends.size(), 0);
  while (true) {
    for (std::size_t leap = may_leap ? 0 : pieces; leap <= pieces; ++leap)
      call(levels, worst_of(landscape, levels, leap));
    std::size_t digit = 0;
    while (digit < levels.size() && ++levels[digit] == columns) levels[digit++] = 0;
    if (digit == levels.size()) return;
  }
}

}  // namespace

TEST_CASE("no path of a small landscape is lower than the bottleneck path, which has the height it says") {
  std::mt19937 numbers(22);
  for (int draw = 0; draw < 200; ++draw) {
    const bool may_leap = draw % 2 == 1;
    const Landscape landscape = drawn(numbers, 2 + draw % 5, 2 + draw % 4);
    const BottleneckPath path =
        bottleneck_path(landscape.heights, landscape.bends, landscape.most_step, may_leap);
    double least = kInfinity;
    for_each_path(landscape, may_leap, [&](const Levels&, double worst) { least = std::min(least, worst); });
    INFO("draw " << draw);
    CHECK_THAT(path.worst, Catch::WithinAbs(least, rounding));
    const double own = worst_of(landscape, path.levels, path.leap.value_or(landscape.most_step.size()));
    CHECK_THAT(own, Catch::WithinAbs(path.worst, rounding));
    if (!may_leap) CHECK_FALSE(path.leap);
  }
}

TEST_CASE("of the lowest paths the bottleneck path has the least sum at its bends") {
  std::mt19937 numbers(7);
  for (int draw = 0; draw < 100; ++draw) {
    const Landscape landscape = drawn(numbers, 5, 4);
    const BottleneckPath path = bottleneck_path(landscape.heights, landscape.bends, landscape.most_step);
    double least = kInfinity;
    for_each_path(landscape, false, [&](const Levels& levels, double worst) {
      if (worst <= path.worst + rounding) least = std::min(least, sum_of(landscape, levels));
    });
    CHECK_THAT(sum_of(landscape, path.levels), Catch::WithinAbs(least, 10.0 * rounding));
  }
}

TEST_CASE("where a wall of points without a height crosses the landscape there is no path") {
  Eigen::MatrixXd heights = Eigen::MatrixXd::Ones(3, 4);
  heights.row(1).setConstant(kInfinity);
  const std::size_t bends[] = {0, 1, 2}, steps[] = {3, 3};
  CHECK(std::isinf(bottleneck_path(heights, bends, steps, true).worst));
}

TEST_CASE("a leap crosses a slope limit that the path has to keep elsewhere") {
  Eigen::MatrixXd heights(2, 3);
  heights << 1, 5, 9,  //
      9, 5, 2;
  const std::size_t bends[] = {0, 1}, steps[] = {1};
  CHECK(bottleneck_path(heights, bends, steps).worst == 5.0);
  const BottleneckPath leaping = bottleneck_path(heights, bends, steps, true);
  CHECK(leaping.worst == 2.0);
  CHECK(leaping.leap == 0U);
  CHECK(leaping.levels == std::vector<std::size_t>{0, 2});
}
}  // namespace bottleneck_path_test
