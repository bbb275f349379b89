#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/fingerprint.hpp"
#include "studies/reading/study_file.hpp"

namespace frahm::studies {

// A study ready to be computed, of whatever kind: what its record and its shard logs are known by.
struct StudyPlan {
  StudyFile study;               // with the values of --set
  std::vector<std::string> set;  // as given: name=value
  engine::Fingerprint fingerprint = {};
  std::uint64_t tiles = 0;  // of the job; 0: it is no job

  engine::LogHeader log_header() const { return {.fingerprint = fingerprint, .tiles = tiles}; }
};

// A value on the command line that the study overrules, by an axis, a band or its scenarios, would be
// silently without effect: throws StudyError.
void refuse_overruled(const StudyFile& study, const std::vector<std::string>& set);

}  // namespace frahm::studies
