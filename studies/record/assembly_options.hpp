#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "engine/progress.hpp"

namespace frahm::studies {

struct AssemblyOptions {
  std::filesystem::path output;
  std::vector<std::filesystem::path> logs;
  bool partial = false;  // write what there is, the rest as not computed; the logs are kept then
  int threads = 0;       // >= 0; 0: engine::default_threads()
  engine::ProgressStyle progress = engine::ProgressStyle::none;
  std::function<bool()> stop_asked;  // looked at between pieces, from several threads
};

}  // namespace frahm::studies
