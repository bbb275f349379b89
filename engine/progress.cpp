#include "engine/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <ostream>
#include <string_view>
#include <utility>

namespace frahm::engine {
namespace {

double percent(const Tally& tally) {
  return tally.points == 0 ? 100.0
                           : 100.0 * static_cast<double>(tally.done) / static_cast<double>(tally.points);
}

// Points per second that this run computes; nothing before the first one. Points from an earlier result are
// left out: they cost next to nothing and may come first.
std::optional<double> rate(const Tally& tally, double seconds) {
  const std::uint64_t found = tally.resumed + tally.reused;
  const std::uint64_t computed = tally.done > found ? tally.done - found : 0;
  if (computed == 0 || seconds <= 0.0) return std::nullopt;
  return static_cast<double>(computed) / seconds;
}

// Seconds until all is done at the rate so far, at most where points are reused; nothing when that is
// unknown.
std::optional<double> time_left(const Tally& tally, double seconds) {
  if (tally.done >= tally.points) return 0.0;
  const std::optional<double> speed = rate(tally, seconds);
  if (!speed) return std::nullopt;
  return static_cast<double>(tally.points - tally.done) / *speed;
}

// Points that take long have no rate worth telling; what moves is the number of evaluations, and the time.
std::string movement(const Tally& tally, const std::string& counted, double seconds) {
  if (tally.evaluations.value_or(0) > 0)
    return fmt::format("  {} evaluations in {}", *tally.evaluations, readable_time(seconds));
  const auto speed = rate(tally, seconds);
  return speed ? fmt::format("  {:.3g} {}/s", *speed, counted) : "";
}

std::string text(const std::string& stage, const std::string& counted, const Tally& tally, double seconds) {
  // Rounded down: 100 % is said when all is done, not before.
  const double shown = std::floor(10.0 * percent(tally)) / 10.0;
  std::string line = stage.empty() ? "" : stage + " ";
  line += fmt::format("{:5.1f} %  {}/{} {}", shown, tally.done, tally.points, counted);
  line += movement(tally, counted, seconds);
  const auto left = time_left(tally, seconds);
  if (left && *left > 0.0) line += fmt::format("  {} left", readable_time(*left));
  if (tally.reused > 0) line += fmt::format("  {} reused", tally.reused);
  if (tally.failed > 0) line += fmt::format("  {} without a result", tally.failed);
  return line;
}

std::string bar(const Tally& tally) {
  constexpr int width = 20;  // the whole line mostly stays below 80 columns
  const int full = static_cast<int>(percent(tally) * width / 100.0);
  return fmt::format("{:=<{}}{:-<{}}", "", full, "", width - full);
}

std::string json(const std::string& stage, const std::string& counted, const Tally& tally, double seconds,
                 bool last) {
  const auto number = [](std::optional<double> value) {
    return value ? fmt::format("{:.6g}", *value) : "null";
  };
  return fmt::format(
      R"({{"event":"{}",{}"points":{},"done":{},"resumed":{},"reused":{},"failed":{},{}"percent":{:.3f},)"
      R"("seconds":{:.3f},"points_per_second":{},"seconds_left":{}}})",
      last ? "end" : "progress", stage.empty() ? "" : fmt::format(R"("stage":"{}",)", stage), tally.points,
      tally.done, tally.resumed, tally.reused, tally.failed,
      tally.evaluations ? fmt::format(R"("counted":"{}","evaluations":{},)", counted, *tally.evaluations)
                        : "",
      percent(tally), seconds, number(rate(tally, seconds)), number(time_left(tally, seconds)));
}

std::chrono::milliseconds period(ProgressForm form) {
  using namespace std::chrono_literals;
  switch (form) {
    case ProgressForm::bar:
    case ProgressForm::coloured_bar:
      return 100ms;
    case ProgressForm::json:
      return 1s;
    default:
      return 30s;
  }
}

}  // namespace

ProgressForm progress_form(ProgressStyle style) {
  if (style == ProgressStyle::none) return ProgressForm::none;
  if (style == ProgressStyle::json) return ProgressForm::json;
  const char* terminal = std::getenv("TERM");
  const bool can_redraw =
      ::isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
  if (style == ProgressStyle::plain || !can_redraw) return ProgressForm::plain;
  const char* no_color = std::getenv("NO_COLOR");  // no-color.org: set to anything but nothing
  return no_color != nullptr && *no_color != '\0' ? ProgressForm::bar : ProgressForm::coloured_bar;
}

Progress::Progress(ProgressForm form, std::ostream& out, std::function<Clock::time_point()> now,
                   std::string stage, std::string counted)
    : form_(form),
      out_(out),
      now_(std::move(now)),
      stage_(std::move(stage)),
      counted_(std::move(counted)),
      start_(now_()),
      next_(start_) {}

void Progress::update(const Tally& tally) {
  if (now_() >= next_) report(tally, false);
}

void Progress::note(const std::vector<std::string>& texts) {
  const bool is_bar = form_ == ProgressForm::bar || form_ == ProgressForm::coloured_bar;
  for (const std::string& text : texts) {
    out_ << fmt::format("{}note: {}\n", is_bar ? "\r\x1b[K" : "", text);
    out_.flush();
  }
}

void Progress::finish(const Tally& tally) {
  report(tally, true);
}

void Progress::report(const Tally& tally, bool last) {
  const Clock::time_point now = now_();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  next_ = now + period(form_);
  const std::string_view end = last ? "\n" : "";
  // Each report is one write, so that lines of several processes on one terminal stay whole.
  switch (form_) {
    case ProgressForm::bar:
      out_ << fmt::format("\r[{}] {}\x1b[K{}", bar(tally), text(stage_, counted_, tally, seconds), end);
      break;
    case ProgressForm::coloured_bar:
      out_ << fmt::format("\r\x1b[3{}m[{}]\x1b[0m {}\x1b[K{}", tally.failed > 0 ? '3' : '2', bar(tally),
                          text(stage_, counted_, tally, seconds), end);
      break;
    case ProgressForm::plain:
      out_ << text(stage_, counted_, tally, seconds) + "\n";
      break;
    case ProgressForm::json:
      out_ << json(stage_, counted_, tally, seconds, last) + "\n";
      break;
    case ProgressForm::none:
      return;
  }
  out_.flush();
}

std::string readable_time(double seconds) {
  const auto whole = [](double value) { return static_cast<std::uint64_t>(value); };
  const double longest = 86400.0 * 365.0 * 1000.0;  // beyond it the number is meaningless
  const std::uint64_t s = whole(std::ceil(std::min(seconds, longest)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  if (s < 86400) return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
  return fmt::format("{} d {} h", s / 86400, s % 86400 / 3600);
}

}  // namespace frahm::engine
