#include "engine/survey.hpp"

#include <algorithm>
#include <charconv>
#include <regex>
#include <string>

namespace frahm::engine {
namespace {

std::optional<std::uint64_t> number(const std::string& digits) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

WriterState state_of_writer(const std::filesystem::path& log) {
  WriterState state{.log = log, .shard = shard_of_log(log), .at_work = false, .start = {}};
  const std::optional<File> file = File::open_if_present(log);
  if (!file) return state;  // its writer has removed it
  state.at_work = file->is_locked();
  state.start = read_writer(*file);
  return state;
}

// For each log of the index the points finished by its present writer.
std::vector<std::uint64_t> points_of_writers(const Job& job, const TileIndex& index,
                                             const std::vector<WriterState>& writers) {
  std::vector<std::uint64_t> points(writers.size(), 0);
  for (std::uint64_t tile = 0; tile < index.places.size(); ++tile) {
    if (!index.has(tile)) continue;
    const auto [log, offset] = index.places[tile];
    const auto& start = writers[log].start;
    if (start && offset >= start->good_bytes) points[log] += job.points(tile);
  }
  return points;
}

// The rate of all writers at work; nothing if there is none or the rate of one is unknown.
std::optional<double> rate(const std::vector<WriterState>& writers, const std::vector<std::uint64_t>& points,
                           std::chrono::system_clock::time_point now) {
  constexpr double least_seconds = 1.0;  // a younger writer counts as not begun
  std::optional<double> sum;
  for (std::size_t i = 0; i < writers.size(); ++i) {
    if (!writers[i].at_work) continue;
    if (!writers[i].start || writers[i].start->time > now) return std::nullopt;
    const double seconds = std::chrono::duration<double>(now - writers[i].start->time).count();
    sum = sum.value_or(0.0);
    if (seconds >= least_seconds) *sum += static_cast<double>(points[i]) / seconds;
  }
  return sum;
}

}  // namespace

std::optional<Shard> shard_of_log(const std::filesystem::path& log) {
  static const std::regex form(R"(.*\.shard-([0-9]+)-of-([0-9]+)(-rank-[1-9][0-9]*)?\.frahm-log)");
  const std::string name = log.filename().string();
  std::smatch part;
  if (!std::regex_match(name, part, form)) return std::nullopt;
  const auto index = number(part[1]), count = number(part[2]);
  if (!index || !count || *index >= *count) return std::nullopt;
  return Shard{.index = *index, .count = *count};
}

Survey survey(const Job& job, const std::vector<std::filesystem::path>& logs,
              std::chrono::system_clock::time_point now) {
  Survey found;
  const LogHeader study{.fingerprint = job.fingerprint, .tiles = job.tiles};
  const TileIndex index = index_tiles(logs, study, [&](std::uint64_t tile, auto entry) {
    if (job.check) job.check(tile, entry);
    found.points.done += job.points(tile);
    if (job.failed) found.points.failed += job.failed(tile, entry);
  });
  for (std::uint64_t tile = 0; tile < job.tiles; ++tile) found.points.points += job.points(tile);
  found.missing = missing_tiles(index);
  found.unused = index.unused;
  for (const auto& log : index.logs) found.writers.push_back(state_of_writer(log));
  found.rate = rate(found.writers, points_of_writers(job, index, found.writers), now);
  const std::uint64_t left = found.points.points - found.points.done;
  if (found.rate && *found.rate > 0.0) found.seconds_left = static_cast<double>(left) / *found.rate;
  return found;
}

}  // namespace frahm::engine
