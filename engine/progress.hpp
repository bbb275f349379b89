#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace frahm::engine {

enum class ProgressStyle {
  automatic,  // a bar if stderr is a terminal, otherwise plain
  plain,      // a line every 30 s
  json,       // a JSON object on a line of its own every second
  none,
};

// The progress of a run, counted in points because tiles differ in size.
struct Tally {
  std::uint64_t points = 0;   // to do in all
  std::uint64_t done = 0;     // finished, by earlier runs too
  std::uint64_t resumed = 0;  // of these, finished by earlier runs
  std::uint64_t reused = 0;   // of those done since, not computed but found in an earlier result
  std::uint64_t failed = 0;   // of those done, the points that have no result
  // For work whose points take long: how often a model has been computed so far, by this process.
  std::optional<std::uint64_t> evaluations = {};
};

enum class ProgressForm { bar, coloured_bar, plain, json, none };

// The form of a style on this process's stderr; a bar is coloured unless NO_COLOR is set.
ProgressForm progress_form(ProgressStyle style);

// Reports on a run, at most as often as its form allows: a bar ten times a second, otherwise see
// ProgressStyle.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  // `out` must outlive it. The time of the run, from which the rate is found, begins here.
  // stage: what is done, "writing"; empty: the tiles are computed. counted: what the points are called.
  Progress(ProgressForm form, std::ostream& out, std::function<Clock::time_point()> now = Clock::now,
           std::string stage = {}, std::string counted = "points");

  void update(const Tally& tally);  // the first call always reports
  // What has to be said whatever the form, each on a line of its own: "note: rank 3 ...".
  void note(const std::vector<std::string>& texts);
  void finish(const Tally& tally);  // always reports; the last call

 private:
  void report(const Tally& tally, bool last);

  ProgressForm form_;
  std::ostream& out_;
  std::function<Clock::time_point()> now_;
  std::string stage_, counted_;
  Clock::time_point start_;
  Clock::time_point next_;  // time of the next report
};

// A span of time in its two largest units: "12 s", "4 min 10 s", "3 h 20 min", "2 d 5 h". seconds: >= 0.
std::string readable_time(double seconds);

}  // namespace frahm::engine
