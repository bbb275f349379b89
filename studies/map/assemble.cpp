#include "studies/map/assemble.hpp"

#include <fmt/format.h>

#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "results/map_writer.hpp"
#include "studies/map/array_tasks.hpp"
#include "studies/map/tile_record.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_failures_told = 1000;  // in the record; their number is told anyway

struct Stopped {};  // thrown through the engine, which has no other way to end its walk over the tiles

// Writes tiles into the map, and notes the points that failed.
class TileWriting {
 public:
  TileWriting(const MapPlan& plan, results::MapWriter& writer) : plan_(plan), writer_(writer) {}

  void write(std::uint64_t tile, std::span<const std::byte> bytes) {
    const MapBox box = plan_.grid.box(tile);
    const std::uint64_t points = box.points();
    decode(bytes, points * plan_.variables.size(), record_);
    for (std::size_t q = 0; q < plan_.variables.size(); ++q) {
      writer_.write_block(q, box.start, box.count, std::span(record_.values).subspan(q * points, points));
    }
    for (const FailedPoint& point : record_.failed) tell(box, point);
  }

  std::uint64_t failed() const { return failed_; }
  const std::vector<std::string>& told() const { return told_; }

 private:
  void tell(const MapBox& box, const FailedPoint& point) {
    if (++failed_ > most_failures_told) return;
    std::vector<std::uint64_t> index(box.start.size());
    std::uint64_t place = point.place;
    for (std::size_t d = index.size(); d-- > 0; place /= box.count[d]) {
      index[d] = box.start[d] + place % box.count[d];
    }
    told_.push_back(fmt::format("{}: {}", point_text(plan_.study, index), point.reason));
  }

  const MapPlan& plan_;
  results::MapWriter& writer_;
  TileRecord record_;
  std::uint64_t failed_ = 0;
  std::vector<std::string> told_;
};

void refuse_gaps(const AssemblyOptions& options, const std::vector<std::uint64_t>& missing,
                 std::uint64_t tiles) {
  if (missing.empty() || options.partial) return;
  throw engine::IoError(
      options.output,
      fmt::format("{} of its {} tiles are in no shard log yet (the first is tile {}){}", missing.size(),
                  tiles, missing.front(), missing_tasks_text(options.logs, missing)));
}

}  // namespace

Assembly assemble(const MapPlan& plan, const RunRecord& run, const AssemblyOptions& options) {
  const engine::AssemblyLock lock(options.output);
  const engine::TileIndex index =
      engine::index_tiles(options.logs, plan.log_header(), [](std::uint64_t, std::span<const std::byte>) {});
  const auto missing = engine::missing_tiles(index);
  Assembly assembly{.finished = false, .tiles = index.places.size(), .missing_tiles = missing.size()};
  if (!missing.empty()) assembly.missing_tasks = missing_tasks_text(options.logs, missing);
  refuse_gaps(options, missing, assembly.tiles);
  try {
    results::MapWriter writer(options.output, map_layout(plan, run));
    TileWriting writing(plan, writer);
    engine::for_each_tile(index, [&](std::uint64_t tile, std::span<const std::byte> bytes) {
      if (options.stop_asked()) throw Stopped{};
      writing.write(tile, bytes);
    });
    write_orbits(plan, writer);
    write_resonances(plan, writer);
    writer.write_texts("provenance", provenance(plan, run, writing.told(), missing.size()));
    writer.finish();
    assembly.finished = true;
    assembly.failed_points = writing.failed();
  } catch (const Stopped&) {
    return assembly;
  }
  if (missing.empty()) engine::remove_logs(options.logs);
  return assembly;
}

}  // namespace frahm::studies
