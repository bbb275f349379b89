#pragma once

#include "results/map_writer.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The numbers of the network at the first point of a map; without axes, as the study states them.
std::vector<double> parameters_at_first_point(const Study& study);
mechanics::NetworkValues values_at_first_point(const Study& study);

// The lowest modes there, with all friction sliding, into the group /modes: frequencies, damping and the
// displacement of each mass. Nothing where the matrices have no modes.
void write_modes(const Study& study, results::MapWriter& writer);

}  // namespace frahm::studies
