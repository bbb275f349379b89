#include "studies/map/beside_samples.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace frahm::studies {
namespace {

template <class Value>
void erase_at(std::vector<Value>& values, std::size_t index) {
  values.erase(values.begin() + static_cast<std::ptrdiff_t>(index));
}

}  // namespace

Grid grid_beside_samples(const MapPlan& plan) {
  const std::size_t samples = plan.study.map()->samples->dimension;
  Grid grid = plan.grid;
  for (auto* sizes : {&grid.shape, &grid.tile, &grid.chunk}) erase_at(*sizes, samples);
  std::erase(grid.order, samples);
  for (std::size_t& dimension : grid.order) {
    if (dimension > samples) --dimension;
  }
  return grid;
}

results::MapLayout layout_beside_samples(const MapPlan& plan, const results::MapLayout& map,
                                         std::vector<results::Variable> variables) {
  results::MapLayout layout{.axes = map.axes, .variables = std::move(variables), .chunk = map.chunk};
  erase_at(layout.axes, plan.study.map()->samples->dimension);
  erase_at(layout.chunk, plan.study.map()->samples->dimension);
  return layout;
}

GroupBesideSamples::GroupBesideSamples(results::MapWriter& writer, std::string group,
                                       results::MapLayout layout)
    : writer_(writer), name_(std::move(group)), layout_(std::move(layout)) {
  if (!layout_.axes.empty()) map_ = writer_.create_map(name_, layout_);
}

GroupBesideSamples::Chunk::Chunk(GroupBesideSamples& group, const std::vector<std::uint64_t>& start)
    : group_(group) {
  if (group.layout_.axes.empty()) {
    for (const results::Variable& variable : group.layout_.variables)
      numbers_.push_back({.variable = variable});
    return;
  }
  chunk_.emplace(group.layout_);
  chunk_->begin(start);
}

void GroupBesideSamples::Chunk::put(std::size_t variable, const MapBox& box, std::span<const double> values) {
  if (chunk_) return chunk_->put(variable, {box.start, box.count}, values);
  numbers_[variable].values.assign(values.begin(), values.end());
}

std::function<void()> GroupBesideSamples::Chunk::writing() const {
  GroupBesideSamples& group = group_;
  if (!chunk_) return [&group, numbers = numbers_] { group.writer_.write_columns(group.name_, numbers); };
  return [&group, encoded = chunk_->encoded()] { group.writer_.write_chunk(group.map_, encoded); };
}

}  // namespace frahm::studies
