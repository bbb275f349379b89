#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/fingerprint.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The earlier result from which a map takes over points.
struct EarlierResult {
  std::string file;      // as given
  std::string identity;  // hex text, unique to the result
};

// A study of any kind, ready to be computed, with all that identifies its record and its shard logs.
struct StudyPlan {
  Study study;                   // with the values of --set
  std::vector<std::string> set;  // as given: name=value
  engine::Fingerprint fingerprint = {};
  std::uint64_t tiles = 0;                                 // of the job; 0: not a job
  std::optional<EarlierResult> grown_from = std::nullopt;  // of a map only
  std::string course = {};  // of a branch only: what is followed from where to where, a line for each

  // The header of its shard logs. Points taken over differ in their last digits from points computed here, so
  // the logs of a growing map differ from those of the same map computed again or grown from another result.
  engine::LogHeader log_header() const { return header_of_logs(grown_from ? grown_from->identity : ""); }
  // The same for a map grown from the result with this identity; empty: from none.
  engine::LogHeader header_of_logs(const std::string& identity) const;
};

// Throws StudyError for a value of --set that an axis, the band or the scenarios of the study override: it
// would have no effect.
void refuse_overruled(const Study& study, const std::vector<std::string>& set);

// The plan of a study without a map; the caller sets its tiles. Throws as refuse_overruled().
StudyPlan plan_without_map(Study study, std::vector<std::string> set);

}  // namespace frahm::studies
