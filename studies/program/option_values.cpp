#include "studies/program/option_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

engine::Shard shard_of(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string_view::npos) {
    const auto index = whole_number(text.substr(0, slash)), count = whole_number(text.substr(slash + 1));
    if (index && count && *index < *count) return {.index = *index, .count = *count};
  }
  throw StudyError(rules::wrong_option,
                   "--shard \"{}\": write i/n, such as 0/16 to 15/16: i is at least 0 and below n", text);
}

engine::Shard shard_of_array_task(const std::function<const char*(const char*)>& variable) {
  if (!variable("SLURM_ARRAY_TASK_ID")) return {};
  const auto read = [&](const char* name, std::uint64_t otherwise) {
    const char* text = variable(name);
    if (!text) return otherwise;
    if (const auto number = whole_number(text)) return *number;
    throw StudyError(rules::wrong_option,
                     "the environment has {} = \"{}\", which is not a whole number; give --shard i/n", name,
                     text);
  };
  const std::uint64_t id = read("SLURM_ARRAY_TASK_ID", 0), first = read("SLURM_ARRAY_TASK_MIN", 0);
  const std::uint64_t step = read("SLURM_ARRAY_TASK_STEP", 1), count = read("SLURM_ARRAY_TASK_COUNT", 1);
  const std::uint64_t last = read("SLURM_ARRAY_TASK_MAX", first + (count - 1) * step);
  // Slurm gives a set of single numbers, such as --array=1,3, the step 1, from which neither the position in
  // the set nor the share of a task follows.
  const bool is_series = step > 0 && count > 0 && last == first + (count - 1) * step;
  if (!is_series || id < first || id > last || (id - first) % step != 0) {
    throw StudyError(rules::wrong_option,
                     "array task {} of {} tasks from {} to {} in steps of {} (environment "
                     "SLURM_ARRAY_TASK_*): its share is clear only if the tasks are evenly spaced; give "
                     "--shard i/n, such as --shard $SLURM_ARRAY_TASK_ID/16 of an --array within 0-15",
                     id, count, first, last, step);
  }
  return {.index = (id - first) / step, .count = count};
}

std::chrono::duration<double> time_span_of(std::string_view option, std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  const double seconds = unit == "s"   ? 1.0
                         : unit == "m" ? 60.0
                         : unit == "h" ? 3600.0
                         : unit == "d" ? 86400.0
                                       : 0.0;
  if (error != std::errc{} || !(number * seconds > 0.0) || !std::isfinite(number * seconds)) {
    throw StudyError(rules::wrong_option, "{} \"{}\": write a time above 0 with its unit: 90s, 50m, 2h or 1d",
                     option, text);
  }
  return std::chrono::duration<double>(number * seconds);
}

std::string problem_of_word(std::string_view text, std::span<const std::string> words) {
  if (std::ranges::find(words, text) != words.end()) return "";
  return fmt::format("\"{}\" is not possible{}", text, suggestion(text, words));
}

std::string problem_of_whole_number(std::string_view text, std::int64_t least, std::int64_t most) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  if (is_number && number >= least && number <= most) return "";
  return fmt::format("\"{}\" is not a whole number from {} to {}", text, least, most);
}

std::string problem_of_number_above_zero(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  return is_number && number > 0.0 && std::isfinite(number)
             ? ""
             : fmt::format("\"{}\" is not a number above 0", text);
}

}  // namespace frahm::studies
