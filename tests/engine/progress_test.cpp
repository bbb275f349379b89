#include "engine/progress.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <iostream>
#include <sstream>

#include "tests/engine/sample_job.hpp"

namespace progress_test {
using namespace frahm::engine;
using namespace std::chrono_literals;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

// A progress whose clock the test sets.
struct Watched {
  explicit Watched(ProgressForm form)
      : progress(form, out, [this] { return Progress::Clock::time_point(time); }) {}

  std::ostringstream out;
  Progress::Clock::duration time = 0s;
  Progress progress;
};

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("plain progress says points, rate, time left and failures") {
  Watched watched(ProgressForm::plain);
  watched.time = 10s;
  watched.progress.update({.points = 3000, .done = 1500, .resumed = 500, .failed = 7});
  CHECK(watched.out.str() == " 50.0 %  1500/3000 points  100 points/s  15 s left  7 without a result\n");
}

TEST_CASE("points found in an earlier result are told and do not count as computed") {
  Watched watched(ProgressForm::plain);
  watched.progress.update({.points = 3000, .done = 1000, .reused = 1000});
  watched.time = 40s;
  watched.progress.update({.points = 3000, .done = 2000, .resumed = 200, .reused = 1000});
  // Tiles in hand have counted what they found before they are done:
  watched.time = 80s;
  watched.progress.update({.points = 3000, .done = 1000, .resumed = 200, .reused = 1000});
  CHECK(watched.out.str() ==
        " 33.3 %  1000/3000 points  1000 reused\n"
        " 66.6 %  2000/3000 points  20 points/s  50 s left  1000 reused\n"
        " 33.3 %  1000/3000 points  1000 reused\n");
}

TEST_CASE("plain progress writes at once, every 30 s and at the end") {
  Watched watched(ProgressForm::plain);
  for (watched.time = 0s; watched.time < 65s; watched.time += 100ms) watched.progress.update({.points = 10});
  CHECK(lines(watched.out.str()) == 3);
  watched.progress.finish({.points = 10, .done = 10});
  CHECK(lines(watched.out.str()) == 4);
  CHECK_THAT(watched.out.str(), EndsWith("100.0 %  10/10 points  0.154 points/s\n"));
}

TEST_CASE("a percentage is rounded down: 100 % means done") {
  Watched watched(ProgressForm::plain);
  watched.progress.update({.points = 100'000, .done = 99'999, .resumed = 99'999});
  CHECK_THAT(watched.out.str(), StartsWith(" 99.9 %"));
}

TEST_CASE("nothing is said about a rate before the first point of this run") {
  Watched watched(ProgressForm::plain);
  watched.time = 5s;
  watched.progress.update({.points = 100, .done = 40, .resumed = 40});
  CHECK(watched.out.str() == " 40.0 %  40/100 points\n");
}

TEST_CASE("a bar is redrawn on one line ten times a second at most") {
  Watched watched(ProgressForm::bar);
  for (watched.time = 0s; watched.time < 1s; watched.time += 10ms)
    watched.progress.update({.points = 4, .done = 1});
  const std::string text = watched.out.str();
  CHECK(std::count(text.begin(), text.end(), '\r') == 10);
  CHECK(lines(text) == 0);
  CHECK_THAT(text, StartsWith("\r[=====---------------]  25.0 %"));
  watched.progress.finish({.points = 4, .done = 4});
  CHECK_THAT(watched.out.str(), Contains("[====================] 100.0 %") && EndsWith("\n"));
}

TEST_CASE("only a coloured bar has colours, another one when points have failed") {
  Watched plain(ProgressForm::bar);
  plain.progress.update({.points = 4, .done = 1, .failed = 1});
  CHECK_THAT(plain.out.str(), !Contains("\x1b[3"));
  Watched green(ProgressForm::coloured_bar);
  green.progress.update({.points = 4, .done = 1});
  CHECK_THAT(green.out.str(), Contains("\x1b[32m"));
  Watched yellow(ProgressForm::coloured_bar);
  yellow.progress.update({.points = 4, .done = 1, .failed = 1});
  CHECK_THAT(yellow.out.str(), Contains("\x1b[33m"));
}

TEST_CASE("json progress is one object a line") {
  Watched watched(ProgressForm::json);
  watched.progress.update({.points = 200});
  watched.time = 4s;
  watched.progress.finish({.points = 200, .done = 100, .resumed = 20, .failed = 3});
  CHECK(
      watched.out.str() ==
      R"({"event":"progress","points":200,"done":0,"resumed":0,"reused":0,"failed":0,"percent":0.000,"seconds":0.000,)"
      R"("points_per_second":null,"seconds_left":null})"
      "\n"
      R"({"event":"end","points":200,"done":100,"resumed":20,"reused":0,"failed":3,"percent":50.000,"seconds":4.000,)"
      R"("points_per_second":20,"seconds_left":5})"
      "\n");
}

TEST_CASE("the progress of a stage names it") {
  std::ostringstream plain, json;
  const auto now = [] { return Progress::Clock::time_point(); };
  Progress(ProgressForm::plain, plain, now, "writing").update({.points = 200});
  Progress(ProgressForm::json, json, now, "writing").update({.points = 200});
  CHECK(plain.str() == "writing   0.0 %  0/200 points\n");
  CHECK_THAT(json.str(), StartsWith(R"({"event":"progress","stage":"writing","points":200,)"));
}

TEST_CASE(
    "work whose points take long tells its evaluations and its time, and calls the points by their name") {
  std::ostringstream plain, json;
  Progress::Clock::duration time = 0s;
  const auto now = [&] { return Progress::Clock::time_point(time); };
  Progress of_plain(ProgressForm::plain, plain, now, "", "starts"),
      of_json(ProgressForm::json, json, now, "", "starts");
  of_plain.update({.points = 2, .evaluations = 0});
  of_json.update({.points = 2, .evaluations = 0});
  CHECK_THAT(json.str(), Contains(R"("counted":"starts","evaluations":0,)"));
  time = 95s;
  of_plain.update({.points = 2, .done = 1, .evaluations = 12345});
  of_json.update({.points = 2, .done = 1, .evaluations = 12345});
  CHECK(plain.str() ==
        "  0.0 %  0/2 starts\n"
        " 50.0 %  1/2 starts  12345 evaluations in 1 min 35 s  1 min 35 s left\n");
  CHECK_THAT(json.str(), Contains(R"("counted":"starts","evaluations":12345,)"));
}

TEST_CASE("progress of form none is silent") {
  Watched watched(ProgressForm::none);
  watched.progress.update({.points = 1});
  watched.progress.finish({.points = 1, .done = 1});
  CHECK(watched.out.str().empty());
}

TEST_CASE("a job of no points is done") {
  Watched watched(ProgressForm::plain);
  watched.progress.finish({});
  CHECK(watched.out.str() == "100.0 %  0/0 points\n");
}

TEST_CASE("times are said in two figures") {
  CHECK(readable_time(0.2) == "1 s");
  CHECK(readable_time(59.5) == "1 min 0 s");
  CHECK(readable_time(250) == "4 min 10 s");
  CHECK(readable_time(12000) == "3 h 20 min");
  CHECK(readable_time(190800) == "2 d 5 h");
  CHECK_NOTHROW(readable_time(1e300));
}

TEST_CASE("a run reports to stderr from its first to its last point") {
  const Scratch scratch;
  RunOptions options = quiet(scratch);
  options.progress = ProgressStyle::json;
  std::ostringstream caught;
  auto* before = std::cerr.rdbuf(caught.rdbuf());
  run(sample_job(20), options);
  std::cerr.rdbuf(before);
  CHECK_THAT(caught.str(), StartsWith(R"({"event":"progress")") && Contains(R"({"event":"end")"));
  CHECK_THAT(caught.str(), Contains(R"("percent":100.000)"));
}
}  // namespace progress_test
