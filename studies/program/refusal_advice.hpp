#pragma once

#include <string>
#include <vector>

namespace frahm::studies {

// What has changed since the result or the logs that are in the way of a run were made, a line for each, and
// below it what to do; advice "": that which fits any other study.
std::string refusal_advice(const std::vector<std::string>& changes, const std::string& advice = "");

}  // namespace frahm::studies
