#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "engine/progress.hpp"

namespace frahm::studies {

struct AssemblyOptions {
  std::filesystem::path output;
  std::vector<std::filesystem::path> logs;
  bool partial = false;  // write the finished tiles, the rest as not computed; the logs stay
  int threads = 0;       // >= 0; 0: engine::default_threads()
  engine::ProgressStyle progress = engine::ProgressStyle::none;
  std::function<bool()> stop_asked;  // called between pieces, from several threads
};

}  // namespace frahm::studies
