#pragma once

#include <iosfwd>

#include "studies/program/point_command.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// `frahm point` of a map of motions: prints the motion at one point, and writes its history as CSV if a file
// is named for it. Returns 0; 3 if the motion fails. Throws StudyError for options that a motion does not
// have.
int motion_point(const PointOptions& options, Study study, std::ostream& out);

}  // namespace frahm::studies
