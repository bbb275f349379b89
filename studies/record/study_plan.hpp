#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/fingerprint.hpp"
#include "studies/reading/study.hpp"

namespace frahm::studies {

// The result from which a map takes over the points that it has already.
struct EarlierResult {
  std::string file;      // as given
  std::string identity;  // hex text, that of no other result
};

// A study ready to be computed, of whatever kind: what its record and its shard logs are known by.
struct StudyPlan {
  Study study;                   // with the values of --set
  std::vector<std::string> set;  // as given: name=value
  engine::Fingerprint fingerprint = {};
  std::uint64_t tiles = 0;                                 // of the job; 0: it is no job
  std::optional<EarlierResult> grown_from = std::nullopt;  // of a map only

  // Of its shard logs. Points taken over differ in their last digits from those computed here, so that the
  // logs of a map that grows are not those of the same map computed from nothing, or from another result.
  engine::LogHeader log_header() const { return header_of_logs(grown_from ? grown_from->identity : ""); }
  // The same if it has grown from the result of this identity; empty: from none.
  engine::LogHeader header_of_logs(const std::string& identity) const;
};

// A value on the command line that the study overrules, by an axis, a band or its scenarios, would be
// silently without effect: throws StudyError.
void refuse_overruled(const Study& study, const std::vector<std::string>& set);

// Of a study without a map; its tiles are for the caller to say. Throws as refuse_overruled().
StudyPlan plan_without_map(Study study, std::vector<std::string> set);

}  // namespace frahm::studies
