#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/map/map_plan.hpp"
#include "studies/map/map_record.hpp"

namespace frahm::studies {

struct AssemblyOptions {
  std::filesystem::path output;
  std::vector<std::filesystem::path> logs;
  bool partial = false;              // write what there is, the rest as not computed; the logs are kept then
  std::function<bool()> stop_asked;  // looked at between tiles
};

struct Assembly {
  bool finished = false;  // false: stopped; the output is as it was before
  std::uint64_t tiles = 0, missing_tiles = 0;
  std::string missing_tasks = {};  // as array_tasks.hpp tells them
  std::uint64_t failed_points = 0;
};

// Makes the result file of a plan from the finished tiles in the logs, whoever wrote them, and then removes
// these logs. The file appears complete or not at all; memory is bounded whatever the size of the map.
// Throws engine::Locked when another process is assembling it, engine::ResumeRefused for logs of another
// study, engine::IoError for tiles that are missing or damaged, results::StoreError.
Assembly assemble(const MapPlan& plan, const RunRecord& run, const AssemblyOptions& options);

}  // namespace frahm::studies
