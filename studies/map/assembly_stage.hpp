#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "engine/in_order.hpp"
#include "studies/map/assembly_options.hpp"

namespace frahm::studies {

// A part of an assembly: pieces made by a team of threads, and used in their order.
struct AssemblyStage {
  std::string name;                      // for the progress: "writing"
  std::uint64_t pieces = 0, points = 0;  // in all
  std::function<std::uint64_t(std::uint64_t piece)> points_of;
  std::function<engine::PieceWork()> make_work;  // called once in each thread
};

// An assembly was asked to stop.
struct AssemblyStopped {};

// Carries a stage out, with progress on stderr if it takes longer than a second. Throws AssemblyStopped, and
// what the work throws.
void carry_out(const AssemblyStage& stage, const AssemblyOptions& options);

}  // namespace frahm::studies
