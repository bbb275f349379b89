#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

#include "engine/run.hpp"

// Values of options that are more than a number. All throw StudyError, naming the option, for an invalid
// value.
namespace frahm::studies {

// "3/16": shard 3 of 16, counted from 0.
engine::Shard shard_of(std::string_view text);

// The share of an array task of Slurm, from SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _MAX and _STEP; the whole work
// outside of one. variable: reads the environment, null where it has no such variable.
engine::Shard shard_of_array_task(const std::function<const char*(const char*)>& variable);

// "90s", "50m", "2h", "1.5d"; > 0. option: its name, for messages.
std::chrono::duration<double> time_span_of(std::string_view option, std::string_view text);

}  // namespace frahm::studies
