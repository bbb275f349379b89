#include "studies/map/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "results/map_writer.hpp"
#include "studies/map/branch_group.hpp"
#include "studies/map/entry_check.hpp"
#include "studies/map/first_modes.hpp"
#include "studies/map/statistics_group.hpp"
#include "studies/map/tile_entry.hpp"
#include "studies/map/tornado_group.hpp"
#include "studies/page/finish_result.hpp"
#include "studies/provenance/array_tasks.hpp"
#include "studies/provenance/assembly_stage.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_failures_listed = 1000;  // in the record, which also has their number

// The points that failed, in the order of their tiles.
class Failures {
 public:
  // A point of a tile.
  void add(const MapBox& box, const FailedPoint& point) {
    ++number_;
    if (first_.size() < most_failures_listed) first_.push_back({index_of(box, point.offset), point.reason});
  }
  void add(const Failures& later) {
    number_ += later.number_;
    const std::size_t room = most_failures_listed - first_.size();
    first_.insert(first_.end(), later.first_.begin(),
                  later.first_.begin() + static_cast<std::ptrdiff_t>(std::min(room, later.first_.size())));
  }

  std::uint64_t number() const { return number_; }
  std::vector<std::string> texts(const Study& study) const {
    std::vector<std::string> texts;
    for (const Failure& failure : first_)
      texts.push_back(fmt::format("{}: {}", point_text(study, failure.index), failure.reason));
    return texts;
  }

 private:
  struct Failure {
    std::vector<std::uint64_t> index;
    std::string reason;
  };

  static std::vector<std::uint64_t> index_of(const MapBox& box, std::uint64_t offset) {
    std::vector<std::uint64_t> index(box.start.size());
    for (std::size_t d = index.size(); d-- > 0; offset /= box.count[d])
      index[d] = box.start[d] + offset % box.count[d];
    return index;
  }

  std::uint64_t number_ = 0;
  std::vector<Failure> first_;
};

// One chunk of the map, made from its tiles.
struct MadeChunk {
  std::optional<results::EncodedChunk> data;  // nothing if none of its tiles is finished
  Failures failures;
  std::vector<std::vector<double>> borders = {};  // their rows
};

// Makes chunks; each thread has one.
class ChunkMaking {
 public:
  ChunkMaking(const MapPlan& plan, const results::MapLayout& layout, const engine::TileIndex& index,
              engine::TileReader& reader)
      : plan_(plan), index_(index), reader_(reader), chunk_(layout) {}

  MadeChunk make(std::uint64_t number) {
    const MapBox box = plan_.grid.chunk_box(number);
    MadeChunk made;
    bool any = false;
    chunk_.begin(box.start);
    std::uint64_t tile = plan_.grid.tile_of(box.start);
    for (std::uint64_t points = 0; points < box.points(); ++tile) {
      const MapBox tile_box = plan_.grid.box(tile);
      points += tile_box.points();
      if (!index_.has(tile)) continue;
      put(tile, tile_box, made);
      any = true;
    }
    if (any) made.data = chunk_.encoded();
    return made;
  }

 private:
  void put(std::uint64_t tile, const MapBox& box, MadeChunk& made) {
    const std::uint64_t points = box.points();
    decode(reader_.read(tile, bytes_), points * plan_.variables.size(), entry_);
    for (std::size_t q = 0; q < plan_.variables.size(); ++q)
      chunk_.put(q, {box.start, box.count}, std::span(entry_.values).subspan(q * points, points));
    for (const FailedPoint& point : entry_.failed) made.failures.add(box, point);
    if (!entry_.borders) return;
    for (const Border& border : *entry_.borders) made.borders.push_back(border_row(plan_.study, box, border));
  }

  const MapPlan& plan_;
  const engine::TileIndex& index_;
  engine::TileReader& reader_;
  results::MapChunk chunk_;
  engine::Bytes bytes_;
  TileEntry entry_;
};

// Writes the map and its borders. Returns the points that failed.
Failures write_map(const MapPlan& plan, const results::MapLayout& layout, const engine::TileIndex& index,
                   const AssemblyOptions& options, results::MapWriter& writer) {
  Failures failures;
  const std::size_t borders =
      plan.study.sweep() && plan.study.sweep()->borders ? create_borders(plan, writer) : 0;
  engine::TileReader reader(index);
  const auto make_work = [&]() -> engine::PieceWork {
    // Shared, as a PieceWork has to be copyable.
    auto making = std::make_shared<ChunkMaking>(plan, layout, index, reader);
    return [making, borders, &failures, &writer](std::uint64_t number) {
      return [made = making->make(number), borders, &failures, &writer] {
        if (made.data) writer.write_chunk(*made.data);
        for (const std::vector<double>& row : made.borders) writer.append_ragged(borders, row);
        failures.add(made.failures);
      };
    };
  };
  carry_out({.name = "writing",
             .pieces = plan.grid.chunks(),
             .points = plan.grid.points(),
             .points_of = [&](std::uint64_t chunk) { return plan.grid.chunk_box(chunk).points(); },
             .make_work = make_work},
            options);
  return failures;
}

// Finds the finished tiles: each record of each log is read and checked.
engine::TileIndex read_logs(const MapPlan& plan, const AssemblyOptions& options) {
  StageProgress progress("reading", plan.grid.points(), options.progress);
  return engine::index_tiles(options.logs, plan.log_header(),
                             [&](std::uint64_t tile, std::span<const std::byte> entry) {
                               if (options.stop_asked()) throw AssemblyStopped{};
                               check_entry(plan, tile, entry);
                               progress.add(plan.grid.box(tile).points());
                             });
}

void refuse_gaps(const AssemblyOptions& options, const std::vector<std::uint64_t>& missing,
                 std::uint64_t tiles) {
  if (missing.empty() || options.partial) return;
  throw engine::IoError(options.output, fmt::format("{} of its {} tiles are in no shard log yet (the first "
                                                    "is tile {}){}; --partial makes a file of the others",
                                                    missing.size(), tiles, missing.front(),
                                                    missing_tasks_text(options.logs, missing)));
}

// Makes the complete file at its final path.
Assembly make_file(const MapPlan& plan, const RunFacts& run, const AssemblyOptions& options) {
  const engine::TileIndex index = read_logs(plan, options);
  const auto missing = engine::missing_tiles(index);
  refuse_gaps(options, missing, index.places.size());
  const results::MapLayout layout = map_layout(plan, run);
  results::MapWriter writer(options.output, layout);
  const Failures failures = write_map(plan, layout, index, options, writer);
  write_statistics(plan, layout, index, options, writer);
  if (plan.study.sweep()) {
    write_tornado(plan, layout, options, writer);
    write_orbits(plan, options, writer);
    write_resonances(plan, options, writer);
    write_branches(plan, index, options, writer);
  } else {
    write_histories(plan, options, writer);
  }
  write_modes(plan.study, writer);
  finish_result(writer, plan, layout, run, failures.texts(plan.study), missing.size());
  return {.finished = true,
          .tiles = index.places.size(),
          .missing_tiles = missing.size(),
          .missing_tasks = missing.empty() ? "" : missing_tasks_text(options.logs, missing),
          .failed_points = failures.number()};
}

}  // namespace

Assembly assemble(const MapPlan& plan, const RunFacts& run, const AssemblyOptions& options,
                  const engine::OutputLock&) {
  try {
    const Assembly assembly = make_file(plan, run, options);
    if (assembly.missing_tiles == 0) remove_used_logs(options);
    return assembly;
  } catch (const AssemblyStopped&) {
    return {};
  }
}

}  // namespace frahm::studies
