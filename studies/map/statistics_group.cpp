#include "studies/map/statistics_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "solvers/algebra/no_value.hpp"
#include "solvers/samples/scatter.hpp"
#include "studies/map/tile_entry.hpp"
#include "studies/provenance/assembly_stage.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_values = std::size_t{1} << 23U;  // of a thread at a time: 64 MB

// The recorded variables that have statistics.
std::vector<std::size_t> described_variables(const MapPlan& plan) {
  std::vector<std::size_t> described;
  for (std::size_t v = 0; v < plan.variables.size(); ++v) {
    if (has_statistics(plan.variables[v])) described.push_back(v);
  }
  return described;
}

// How many slots, each with all samples of one quantity at one point, a thread takes at a time.
std::size_t slots_together(std::size_t slots, std::size_t samples) {
  return std::clamp<std::size_t>(most_values / samples, 1, slots);
}

// How many numbers tell the scatter of one quantity.
std::size_t numbers_of_scatter(const MapPlan& plan) {
  return 5 + 3 * plan.study.map()->samples->quantiles.size();
}

// In the order of statistics_variables().
void append(const samples::Scatter& scatter, std::vector<double>& row) {
  row.assign({scatter.mean.value, scatter.mean.low, scatter.mean.high, scatter.deviation});
  for (const samples::Estimate& quantile : scatter.quantiles)
    row.insert(row.end(), {quantile.value, quantile.low, quantile.high});
  row.push_back(static_cast<double>(scatter.samples));
}

// Makes the chunks of /statistics; each thread has one.
class StatisticsMaking {
 public:
  StatisticsMaking(const MapPlan& plan, const Grid& beside, const engine::TileIndex& index,
                   engine::TileReader& reader, GroupBesideSamples& group)
      : plan_(plan),
        beside_(beside),
        index_(index),
        reader_(reader),
        group_(group),
        along_(plan.study.map()->samples->dimension),
        samples_(plan.grid.shape[along_]),
        variables_(described_variables(plan)),
        scatter_(plan.study.map()->samples->quantiles) {}

  std::function<void()> make(std::uint64_t number) {
    const MapBox box = beside_.chunk_box(number);
    GroupBesideSamples::Chunk chunk(group_, box.start);
    std::uint64_t tile = beside_.tile_of(box.start);
    for (std::uint64_t points = 0; points < box.points(); ++tile) {
      const MapBox column = beside_.box(tile);
      points += column.points();
      take(column, chunk);
    }
    return chunk.writing();
  }

 private:
  // The points of one tile apart from the axis of samples. A slot is one quantity at one of them, with all
  // its samples.
  void take(const MapBox& column, GroupBesideSamples::Chunk& chunk) {
    const std::size_t points = column.points(), slots = points * variables_.size();
    const std::size_t together = slots_together(slots, samples_), each = numbers_of_scatter(plan_);
    table_.assign(each * slots, kNone);
    for (std::size_t first = 0; first < slots; first += together) {
      const std::size_t last = std::min(slots, first + together);
      gather(column, first, last);
      for (std::size_t slot = first; slot < last; ++slot) {
        append(scatter_(std::span(values_).subspan((slot - first) * samples_, samples_)), row_);
        const std::size_t v = slot / points, p = slot % points;
        for (std::size_t s = 0; s < each; ++s) table_[(v * each + s) * points + p] = row_[s];
      }
    }
    for (std::size_t s = 0; s < each * variables_.size(); ++s)
      chunk.put(s, column, std::span(table_).subspan(s * points, points));
  }

  // The values of the slots [first, last), the samples of one after the other.
  void gather(const MapBox& column, std::size_t first, std::size_t last) {
    values_.assign((last - first) * samples_, kNone);
    std::vector<std::uint64_t> start = column.start;
    start.insert(start.begin() + static_cast<std::ptrdiff_t>(along_), 0);
    for (; start[along_] < samples_; start[along_] += plan_.grid.tile[along_]) {
      const std::uint64_t tile = plan_.grid.tile_of(start);
      if (!index_.has(tile)) continue;
      const MapBox box = plan_.grid.box(tile);
      decode(reader_.read(tile, bytes_), box.points() * plan_.variables.size(), entry_);
      for (std::size_t slot = first; slot < last; ++slot) copy(box, slot, slot - first);
    }
  }

  // The samples of a tile: offset in it = (outer * count + sample) * inner + i, the point apart from the
  // samples = outer * inner + i.
  void copy(const MapBox& box, std::size_t slot, std::size_t place) {
    std::uint64_t inner = 1;
    for (std::size_t d = along_ + 1; d < box.count.size(); ++d) inner *= box.count[d];
    const std::uint64_t count = box.count[along_], points = box.points() / count;
    const std::uint64_t p = slot % points, outer = p / inner, i = p % inner;
    const std::span<const double> of_variable =
        std::span(entry_.values).subspan(variables_[slot / points] * box.points(), box.points());
    for (std::uint64_t s = 0; s < count; ++s)
      values_[place * samples_ + box.start[along_] + s] = of_variable[(outer * count + s) * inner + i];
  }

  const MapPlan& plan_;
  const Grid& beside_;
  const engine::TileIndex& index_;
  engine::TileReader& reader_;
  GroupBesideSamples& group_;
  std::size_t along_;    // the dimension of the samples
  std::size_t samples_;  // their number
  std::vector<std::size_t> variables_;
  samples::ScatterOf scatter_;

  // Workspace.
  engine::Bytes bytes_;
  TileEntry entry_;
  std::vector<double> values_, table_, row_;
};

}  // namespace

bool has_statistics(const periodic::QuantityDescription& quantity) {
  return quantity.kind == periodic::QuantityKind::real && !quantity.name.ends_with("_phase");
}

double statistics_memory(const MapPlan& plan) {
  if (!plan.study.map()->samples) return 0.0;
  const Grid beside = grid_beside_samples(plan);
  const std::size_t slots = beside.box(0).points() * described_variables(plan).size();
  if (slots == 0) return 0.0;
  const std::size_t samples = plan.grid.points() / beside.points();
  const std::size_t numbers = slots_together(slots, samples) * samples + numbers_of_scatter(plan) * slots;
  return static_cast<double>(numbers * sizeof(double));
}

std::vector<results::Variable> statistics_variables(const MapPlan& plan) {
  std::vector<results::Variable> variables;
  for (const std::size_t v : described_variables(plan)) {
    const periodic::QuantityDescription& of = plan.variables[v];
    for (const char* row : {"*_mean", "*_mean_low", "*_mean_high", "*_deviation"})
      variables.push_back(variable({row, {of.name}, {of.long_name}}, of.unit));
    for (const double share : plan.study.map()->samples->quantiles) {
      const std::vector<std::string> words{fmt::format("{:.6g} %", 100 * share), of.long_name};
      for (const char* row : {"*_q*", "*_q*_low", "*_q*_high"})
        variables.push_back(variable({row, {of.name, quantile_name(share).substr(1)}, words}, of.unit));
    }
    variables.push_back(variable({"*_samples", {of.name}, {of.long_name}}, "1", results::Type::int32));
  }
  return variables;
}

void write_statistics(const MapPlan& plan, const results::MapLayout& map, const engine::TileIndex& index,
                      const AssemblyOptions& options, results::MapWriter& writer) {
  if (!plan.study.map()->samples) return;
  std::vector<results::Variable> variables = statistics_variables(plan);
  if (variables.empty()) return;
  GroupBesideSamples group(writer, statistics_group, layout_beside_samples(plan, map, std::move(variables)));
  const Grid beside = grid_beside_samples(plan);
  engine::TileReader reader(index);
  const std::uint64_t samples = plan.grid.points() / beside.points();
  const auto make_work = [&]() -> engine::PieceWork {
    // Shared, as a PieceWork has to be copyable.
    auto making = std::make_shared<StatisticsMaking>(plan, beside, index, reader, group);
    return [making](std::uint64_t number) { return making->make(number); };
  };
  carry_out({.name = "statistics",
             .pieces = beside.chunks(),
             .points = plan.grid.points(),
             .points_of = [&](std::uint64_t chunk) { return beside.chunk_box(chunk).points() * samples; },
             .make_work = make_work},
            options);
}

}  // namespace frahm::studies
