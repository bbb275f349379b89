#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/tile_index.hpp"
#include "results/map_writer.hpp"
#include "solvers/branches/branch.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/provenance/assembly_options.hpp"

namespace frahm::studies {

// Writes the group /branches of a file (results/FORMAT.md), a branch after the other.
class BranchGroup {
 public:
  // along: the parameter of the branches, index in Parameters::list.  beside: parameters whose value each
  // branch states.  quantities: of the branches' points. Study and writer must outlive it.
  BranchGroup(const Study& study, std::size_t along, std::vector<std::size_t> beside,
              const std::vector<periodic::Quantity>& quantities, results::MapWriter& writer);

  // parameters: of the branch, SI, in the order of Parameters::list.
  void append(std::span<const double> parameters, const periodic::Branch& branch);

 private:
  std::vector<std::vector<double>> samples(const periodic::Branch& branch) const;

  const Study& study_;
  std::size_t along_;
  std::vector<std::size_t> beside_, elements_;
  std::size_t columns_ = 0;
  results::MapWriter& writer_;
  std::size_t table_ = 0;
};

// The parameters of a sweep's axes but for one.
std::vector<std::size_t> axis_parameters_beside(const Study& study, std::size_t along);

// The branches that the study asks for, followed from the orbits of the map's finished tiles; nothing if it
// asks for none. Throws AssemblyStopped.
void write_branches(const MapPlan& plan, const engine::TileIndex& index, const AssemblyOptions& options,
                    results::MapWriter& writer);

}  // namespace frahm::studies
