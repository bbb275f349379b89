#include "studies/tuning/assemble_tuning.hpp"

#include <fmt/format.h>

#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "results/map_writer.hpp"
#include "studies/page/finish_result.hpp"
#include "studies/provenance/array_tasks.hpp"
#include "studies/provenance/assembly_stage.hpp"
#include "studies/provenance/provenance.hpp"
#include "studies/tuning/optimum_check.hpp"
#include "studies/tuning/optimum_columns.hpp"
#include "studies/tuning/optimum_entry.hpp"

namespace frahm::studies {
namespace {

void refuse_gaps(const AssemblyOptions& options, const std::vector<std::uint64_t>& missing,
                 std::uint64_t starts) {
  if (missing.size() == starts)
    throw engine::IoError(options.output, fmt::format("none of its {} starts is in a shard log yet", starts));
  if (missing.empty() || options.partial) return;
  throw engine::IoError(
      options.output,
      fmt::format("{} of its {} starts are in no shard log yet{}; --partial makes a file of the others",
                  missing.size(), starts, missing_tasks_text(options.logs, missing)));
}

void write_file(const StudyPlan& plan, const RunFacts& run, const std::filesystem::path& output,
                const TuningResult& result, std::uint64_t missing) {
  const results::MapLayout layout = file_layout(plan, run);
  results::MapWriter writer(output, layout);
  writer.write_columns(optimum_group, optimum_columns(plan.study, result));
  writer.write_texts(optimum_group, optimum_texts(plan.study, result));
  if (plan.study.tune()->trade_off) writer.write_columns(front_group, front_columns(plan.study, result));
  finish_result(writer, plan, layout, run, {}, missing);
}

}  // namespace

std::optional<TuningResult> assemble_tuning(const StudyPlan& plan, const RunFacts& run,
                                            const AssemblyOptions& options, const engine::OutputLock&) {
  const engine::TileIndex index = engine::index_tiles(
      options.logs, plan.log_header(),
      [&](std::uint64_t, std::span<const std::byte> entry) { check_start(plan.study, entry); });
  const std::vector<std::uint64_t> missing = engine::missing_tiles(index);
  refuse_gaps(options, missing, plan.tiles);
  std::vector<StartResult> starts;
  engine::for_each_tile(index, [&](std::uint64_t start, std::span<const std::byte> bytes) {
    starts.push_back({start, decode_optima(bytes)});
  });
  if (options.stop_asked()) return std::nullopt;
  TuningResult result = tuning_result(plan.study, std::move(starts), options.stop_asked);
  if (options.stop_asked()) return std::nullopt;
  write_file(plan, run, options.output, result, missing.size());
  if (missing.empty()) remove_used_logs(options);
  return result;
}

}  // namespace frahm::studies
