#include "studies/map/map_sample.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <span>
#include <vector>

#include "results/chunk_codec.hpp"
#include "results/storage.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/map/tile_entry.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

// Dear tiles may differ in cost several times: one or two of them would tell little of the rest.
constexpr std::uint64_t enough_tiles = 8;
constexpr double most_times = 4.0;                          // of the time given
constexpr double dear_tile = 2.0, surely_dear_point = 0.5;  // [s]; check is not to keep its user waiting

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Tile numbers k x stride modulo the number of tiles are each met once, and the first few of them lie evenly
// spread, when the stride is near the golden section.
std::uint64_t spreading_stride(std::uint64_t tiles) {
  auto stride = static_cast<std::uint64_t>(0.6180339887498949 * static_cast<double>(tiles));
  while (std::gcd(stride, tiles) != 1) ++stride;
  return stride;
}

// The grid index of the k-th point of a box, row-major.
std::vector<std::uint64_t> index_in(const MapBox& box, std::uint64_t k) {
  std::vector<std::uint64_t> index = box.start;
  for (std::size_t d = index.size(); d-- > 0; k /= box.count[d]) index[d] += k % box.count[d];
  return index;
}

// Computes tiles of a map in one thread. The plan must outlive it.
class TileSampler {
 public:
  explicit TileSampler(const MapPlan& plan)
      : plan_(plan), variables_(map_layout(plan, {}).variables), kernel_(job_of(plan).make_kernel({})) {}

  // Adds a tile to the sample. Returns the seconds it took.
  double add(std::uint64_t tile, MapSample& sample);

 private:
  void add_record(const MapBox& box, MapSample& sample) const;

  const MapPlan& plan_;
  std::vector<results::Variable> variables_;
  engine::Kernel kernel_;
  engine::Bytes bytes_;
  TileEntry entry_;
};

double TileSampler::add(std::uint64_t tile, MapSample& sample) {
  bytes_.clear();
  const auto start = Clock::now();
  kernel_(tile, bytes_);
  const double seconds = seconds_since(start);
  sample.seconds += seconds;
  const MapBox box = plan_.grid.box(tile);
  decode(bytes_, box.points() * plan_.variables.size(), entry_);
  add_record(box, sample);
  return seconds;
}

void TileSampler::add_record(const MapBox& box, MapSample& sample) const {
  const std::size_t points = box.points();
  sample.points += points;
  const auto start = Clock::now();
  for (std::size_t q = 0; q < variables_.size(); ++q) {
    const auto values = std::span(entry_.values).subspan(q * points, points);
    const results::Bytes raw = results::to_storage(variables_[q], values);
    sample.raw_bytes += raw.size();
    const auto stored = results::encode_chunk(raw, results::element_size(variables_[q].type)).size();
    sample.stored_bytes += std::min(stored, raw.size());  // of a few numbers it is more
  }
  sample.encoding_seconds += seconds_since(start);
  if (sample.failed == 0 && !entry_.failed.empty()) {
    sample.failed_at = point_text(plan_.study, index_in(box, entry_.failed.front().offset));
    sample.reason = entry_.failed.front().reason;
  }
  sample.failed += entry_.failed.size();
}

// The same map with a tile for each point.
MapPlan in_single_points(const MapPlan& plan) {
  MapPlan points = plan;
  points.grid.tile.assign(points.grid.shape.size(), 1);
  points.tiles = points.grid.tiles();
  return points;
}

}  // namespace

MapSample sample_map(const MapPlan& plan, double seconds) {
  const std::uint64_t tiles = plan.grid.tiles(), stride = spreading_stride(tiles);
  MapSample sample;
  // For expensive tiles one point alone is computed, and counts for all of its tile.
  const MapPlan single = in_single_points(plan);
  TileSampler of_points(single), of_tiles(plan);
  const auto cost_by_point = [&](std::uint64_t tile, std::uint64_t k) {  // the k-th of its points
    const MapBox box = plan.grid.box(tile);
    const double taken = of_points.add(single.grid.tile_of(index_in(box, k)), sample);
    return taken * static_cast<double>(box.points());
  };
  // The very first one also makes what all share, and a busy machine may hold up any: the least of three, at
  // the beginning, the middle and the end of the tile.
  double cost = cost_by_point(0, 0);
  const std::uint64_t last = plan.grid.box(0).points() - 1;
  for (std::uint64_t k = 1; k <= 2 && cost > dear_tile && sample.seconds < surely_dear_point; ++k)
    cost = std::min(cost, cost_by_point(0, k * last / 2));
  const bool is_dear = cost > dear_tile;
  if (is_dear)
    sample.costs.push_back({0, cost});
  else
    sample = {};
  const auto goes_on = [&](std::uint64_t k) {
    return k == 0 || sample.seconds < seconds || (k < enough_tiles && sample.seconds < most_times * seconds);
  };
  for (std::uint64_t k = is_dear ? 1 : 0; k < tiles && goes_on(k); ++k) {
    const std::uint64_t tile = k * stride % tiles;
    sample.costs.push_back({tile, is_dear ? cost_by_point(tile, 0) : of_tiles.add(tile, sample)});
  }
  return sample;
}

}  // namespace frahm::studies
