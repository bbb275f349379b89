#include "studies/map/map_sample.hpp"

#include <chrono>
#include <numeric>
#include <span>

#include "results/chunk_codec.hpp"
#include "results/storage.hpp"
#include "studies/map/map_record.hpp"
#include "studies/map/tile_record.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

// Dear tiles may differ in cost several times: one or two of them would tell little of the rest.
constexpr std::uint64_t enough_tiles = 8;
constexpr double most_times = 4.0;  // of the time given

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

void add(const MapPlan& plan, std::uint64_t tile, const TileRecord& record,
         const std::vector<results::Variable>& variables, MapSample& sample) {
  const MapBox box = plan.grid.box(tile);
  const std::size_t points = box.points();
  sample.points += points;
  const auto start = Clock::now();
  for (std::size_t q = 0; q < variables.size(); ++q) {
    const auto values = std::span(record.values).subspan(q * points, points);
    const results::Bytes raw = results::to_storage(variables[q], values);
    sample.raw_bytes += raw.size();
    sample.stored_bytes += results::encode_chunk(raw, results::element_size(variables[q].type)).size();
  }
  sample.encoding_seconds += seconds_since(start);
  if (sample.failed == 0 && !record.failed.empty()) {
    sample.failed_at = point_text(plan.study, index_in(box, record.failed.front().offset));
    sample.reason = record.failed.front().reason;
  }
  sample.failed += record.failed.size();
}

}  // namespace

MapSample sample_map(const MapPlan& plan, double seconds) {
  const std::vector<results::Variable> variables = map_layout(plan, {}).variables;
  const engine::Kernel kernel = job_of(plan).make_kernel({});
  const std::uint64_t tiles = plan.grid.tiles(), stride = spreading_stride(tiles);
  MapSample sample;
  TileRecord record;
  engine::Bytes bytes;
  const auto goes_on = [&](std::uint64_t k) {
    return k == 0 || sample.seconds < seconds || (k < enough_tiles && sample.seconds < most_times * seconds);
  };
  for (std::uint64_t k = 0; k < tiles && goes_on(k); ++k) {
    const std::uint64_t tile = k * stride % tiles;
    bytes.clear();
    const auto start = Clock::now();
    kernel(tile, bytes);
    sample.costs.push_back({tile, seconds_since(start)});
    sample.seconds += sample.costs.back().seconds;
    decode(bytes, plan.grid.box(tile).points() * plan.variables.size(), record);
    add(plan, tile, record, variables, sample);
  }
  return sample;
}

}  // namespace frahm::studies
