#pragma once

#include "studies/motion/motion_columns.hpp"

namespace frahm::studies {

// Adds what each record drove, times its scale: <node>_recorded_acceleration (velocity, displacement, force;
// in SI) along times of its own, those of the record's samples. A second record of the same for a node has
// the suffix _2.
void add_driving_records(const Study& study, MotionColumns& columns);

}  // namespace frahm::studies
