#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "results/map_reader.hpp"
#include "studies/map/earlier_axes.hpp"
#include "studies/map/map_plan.hpp"

namespace frahm::studies {

// The points of a map that an earlier result of the same physics holds, on any grid: reused by content, the
// SI values of their parameters. Not reused are points that failed or were not computed there, and points
// with all values missing, unless the status is `unbounded` or is the only variable.
//
// Shared by all threads; one at a time reads the file, as HDF5 requires. Chunks are read when they are
// needed; memory is bounded by one chunk for each thread and the chunk cache of HDF5.
class KnownPoints {
 public:
  // plan: of the new map; must outlive this.  file: finished or partial.  Throws engine::ResumeRefused for a
  // result of another system, StudyError where no point can be common, results::StoreError.
  KnownPoints(const MapPlan& plan, const std::filesystem::path& file);

  // Writes the values of the tile's known points to `values` (of a TileEntry) and marks these points in
  // `known`, which has an entry for each point of the box.  Throws results::StoreError for damaged data.
  void take(const MapBox& box, std::span<double> values, std::vector<char>& known);

  // Reads once all that the tiles first, first + step, ... will take, so that a damaged file is refused
  // before anything is computed. Throws as take().
  void check(std::uint64_t first, std::uint64_t step);

  EarlierResult source() const { return source_; }
  std::uint64_t taken() const { return taken_; }  // points so far
  // How many points of the earlier map's grid are not in the new map.
  std::uint64_t off_grid() const { return points_off_grid(dimensions_); }

 private:
  // A point of a tile that the earlier map has.
  struct Found {
    std::uint64_t chunk = 0;    // number of its chunk in the earlier map
    std::uint64_t offset = 0;   // in the earlier map, row-major
    std::uint64_t in_tile = 0;  // offset in the tile
  };

  std::vector<Found> find(const MapBox& box) const;
  void read_chunk(std::span<const Found> points, std::uint64_t points_of_tile, std::span<double> values);
  // Throws results::StoreError for a value that no run can record.
  void check_possible(std::size_t variable, double value, const Found& point) const;
  std::vector<double> read_variable(std::size_t variable, const MapBox& box) const;
  MapBox box_around(std::span<const Found> points) const;
  bool is_answer(std::span<const double> values, std::uint64_t points_of_tile, std::uint64_t in_tile) const;

  const MapPlan& plan_;
  std::filesystem::path file_;
  results::MapReader reader_;
  EarlierResult source_;
  std::vector<EarlierDimension> dimensions_;  // of the earlier map
  std::vector<std::size_t> variables_;        // in the earlier map, of each of the plan's
  std::vector<std::size_t> statuses_;         // the plan's variables that are statuses
  std::optional<std::size_t> own_status_;     // the status of the study's own response
  std::vector<std::size_t> answers_;          // the other variables of this response
  std::mutex reading_;
  std::atomic<std::uint64_t> taken_ = 0;
};

}  // namespace frahm::studies
