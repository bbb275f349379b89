#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solvers/identification/identification.hpp"
#include "solvers/transient/motion.hpp"
#include "studies/reading/study/study.hpp"

// A study of kind "identify": the solver's answer to it.
namespace frahm::studies {

struct IdentificationResult {
  std::optional<identification::Identification> first;  // the stage that the fit started from, if any
  identification::Identification fit;
};

// What `watch` throws is passed on. Throws StudyError, with the reason, if nothing can be found from the
// data, and for a parameter that cannot take the estimate it names.
IdentificationResult identify(const Study& study, const transient::Watch& watch = {});

}  // namespace frahm::studies
