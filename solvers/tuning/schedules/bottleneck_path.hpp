#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

// A path across a landscape whose highest point is as low as possible.
namespace frahm::tuning {

struct BottleneckPath {
  std::vector<std::size_t> levels;  // column at each bend
  double worst = 0.0;               // height of its highest point; infinite: every path has such a point
  std::optional<std::size_t> leap;  // the path leaps between this bend and the next
};

// heights: rows are places along the path, columns its levels; infinite where no path may go, never NaN.
// bends: rows at which the path may turn, ascending, the first and the last row among them. In between it is
// straight, and the height there is linear between neighbouring columns.
// most_step: for each piece between bends, the most columns that it may climb or fall.
// may_leap: one piece may be left out of the path: its ends may lie on any columns.
//
// The bottleneck shortest path by dynamic programming along the rows: exact, as the path's past counts only
// by its highest point. Of the paths with the least worst height it is one of the least sum of heights at the
// bends. Source: T. C. Hu, The maximum capacity route problem, Operations Research 9 (1961) 898.
BottleneckPath bottleneck_path(const Eigen::MatrixXd& heights, std::span<const std::size_t> bends,
                               std::span<const std::size_t> most_step, bool may_leap = false);

}  // namespace frahm::tuning
