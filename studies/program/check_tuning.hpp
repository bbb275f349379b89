#pragma once

#include <iosfwd>

#include "studies/program/check_command.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// check_command() of a study of kind "tune": its task, the time to expect, the array, the modes as stated.
// Computes its first start for some seconds.
int check_tuning(const CheckOptions& options, Study read, std::ostream& out);

}  // namespace frahm::studies
