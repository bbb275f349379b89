#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "engine/run.hpp"

// Values of options. What reads them throws StudyError, naming the option, for an invalid value.
namespace frahm::studies {

// "3/16": shard 3 of 16, counted from 0.
engine::Shard shard_of(std::string_view text);

// The share of an array task of Slurm, from SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _MAX and _STEP; the whole work
// outside of one. variable: reads the environment, null where it has no such variable.
engine::Shard shard_of_array_task(const std::function<const char*(const char*)>& variable);

// "90s", "50m", "2h", "1.5d"; > 0. option: its name, for messages.
std::chrono::duration<double> time_span_of(std::string_view option, std::string_view text);

// What to say of a value after the option's name; "" of one that is right: one of some words, a whole number
// of a range, a number > 0.
std::string problem_of_word(std::string_view text, std::span<const std::string> words);
std::string problem_of_whole_number(std::string_view text, std::int64_t least, std::int64_t most);
std::string problem_of_number_above_zero(const std::string& text);

}  // namespace frahm::studies
