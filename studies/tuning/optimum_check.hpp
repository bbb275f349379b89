#pragma once

#include <cstddef>
#include <span>

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Checks the record of a start of a tuning that comes from a log: that its optima are of this study's
// parameters, scenarios and records. Throws engine::BadEntry.
void check_start(const Study& study, std::span<const std::byte> bytes);

}  // namespace frahm::studies
