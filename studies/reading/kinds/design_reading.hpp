#pragma once

#include <cstddef>

#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/study/study.hpp"

// The tables of a tuning.
namespace frahm::studies {

// Whether the numbers of the network depend on a parameter.
bool network_depends_on(const Study& study, std::size_t parameter);

// The tables of a tuning, in this order, once its band is known.
void read_designs(TuneReading& reading);
void read_limits(TuneReading& reading);
void read_scenarios(TuneReading& reading);
void read_columns(TuneReading& reading);

}  // namespace frahm::studies
