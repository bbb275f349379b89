#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/map_writer.hpp"
#include "studies/map/map_plan.hpp"

// Groups of the file that lie on all axes of a map but that of its samples.
namespace frahm::studies {

inline constexpr const char* statistics_group = "statistics";
inline constexpr const char* tornado_group = "tornado";

// The grid of a map without its dimension of samples; of no dimension, one point, if it has no other. Its
// tiles and chunks are those of the map but for that dimension.
Grid grid_beside_samples(const MapPlan& plan);

// The layout of such a group: the axes of the map without that dimension, and these variables.
results::MapLayout layout_beside_samples(const MapPlan& plan, const results::MapLayout& map,
                                         std::vector<results::Variable> variables);

// A group that is being written.
class GroupBesideSamples {
 public:
  GroupBesideSamples(results::MapWriter& writer, std::string group, results::MapLayout layout);

  const results::MapLayout& layout() const { return layout_; }

  // One of its chunks, made in any thread.
  class Chunk {
   public:
    // start: its first point.
    Chunk(GroupBesideSamples& group, const std::vector<std::uint64_t>& start);

    // values: one for each point of a box within the chunk, row-major.
    void put(std::size_t variable, const MapBox& box, std::span<const double> values);

    // What writes the chunk, in the turn of the file.
    std::function<void()> writing() const;

   private:
    GroupBesideSamples& group_;
    std::optional<results::MapChunk> chunk_;  // of a group with axes
    std::vector<results::Column> numbers_;    // of one without
  };

 private:
  results::MapWriter& writer_;
  std::string name_;
  results::MapLayout layout_;
  std::size_t map_ = 0;  // of the writer
};

}  // namespace frahm::studies
