#pragma once

#include <vector>

#include "studies/map/beside_samples.hpp"
#include "studies/map/map_groups.hpp"

namespace frahm::studies {

// The recorded quantities of a map of samples that have first-order sensitivities; none where the study's
// responses have no derivatives (smooth laws, sweeps of the frequency).
std::vector<periodic::Quantity> tornado_quantities(const MapPlan& plan);

// The variables of /tornado: of each such quantity X its value and its first-order deviation at the mean of
// the samples, and of each uncertain parameter its part in it.
std::vector<results::Variable> tornado_variables(const MapPlan& plan);

// First-order sensitivities from the exact gradient g at the mean of the samples, at every point of the other
// axes, written to /tornado; nothing for a map without samples. With the covariance C of the samples: X_by_p
// = g_p sqrt(C_pp), the first-order variance g^T C g, and the share of p in it g_p (C g)_p / g^T C g. The
// shares add up to 1; of independent parameters each is the part of the variance that is owed to it alone, of
// correlated ones it may be negative. Points without a derivative have no values.  Throws AssemblyStopped.
void write_tornado(const MapPlan& plan, const results::MapLayout& map, const AssemblyOptions& options,
                   results::MapWriter& writer);

}  // namespace frahm::studies
