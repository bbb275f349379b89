#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/transient/forced_motion.hpp"
#include "solvers/tuning/records/record_task.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Tunings over records against fine scans of the same objective by motions computed apart.
namespace frahm::tuning::record_tuning_test {
namespace {

using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::NetworkValues;
using mechanics::Node, mechanics::NodeKind;
using transient::Record, transient::RecordedExcitation, transient::RecordOf;

constexpr double kScanned = 1e-6;     // relative, of an optimum and the least of a scan refined around it
constexpr double kCertified = 1e-6;   // largest certificate gap
constexpr double kClosedForm = 1e-7;  // relative

const auto never = [] { return false; };

// Two storeys on springs and dampers with a friction damper in each; three records shake their ground.
struct Frame {
  Network network;
  NetworkValues values{.omega = 1.0,
                       .mass = {1.0, 1.0},
                       .element = {90.0, 0.3, 0.5, 90.0, 0.3, 0.5},
                       .excitation = {{1.0, 0.0}}};
  std::vector<Record> records;

  Frame() {
    const Node ground{NodeKind::prescribed, 0}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1};
    network.masses = {"first", "second"};
    network.prescribed = {"ground"};
    network.elements = {
        {"k1", ElementType::spring, ground, first},  {"c1", ElementType::damper, ground, first},
        {"F1", ElementType::coulomb, ground, first}, {"k2", ElementType::spring, first, second},
        {"c2", ElementType::damper, first, second},  {"F2", ElementType::coulomb, first, second}};
    network.excitations = {{ExcitationKind::recorded_motion, 0, 0}};
    network.signals = {{"drift", {{ground, -1.0}, {first, 1.0}}}};
    std::mt19937 random(20261128);
    std::normal_distribution<double> normal;
    for (int r = 0; r < 3; ++r) {
      Record record{.name = "record", .of = RecordOf::acceleration, .time = {}, .values = {}};
      for (int i = 0; i <= 200; ++i) {
        record.time.push_back(0.05 * i);
        record.values.push_back(3.0 * std::sin(0.0157 * i) * normal(random));
      }
      records.push_back(record);
    }
  }

  // Tuned: the two slip forces as one, and the first spring; each in its bounds.
  RecordTask task(bool with_spring) const {
    RecordTask task;
    task.network = network;
    task.scenarios = {"alone"};
    task.parameters = {{.name = "F", .lower = 0.0, .upper = 3.0, .nominal = 0.5, .schedule = {}}};
    if (with_spring)
      task.parameters.push_back(
          {.name = "k", .lower = 60.0, .upper = 120.0, .nominal = 90.0, .schedule = {}});
    task.network_at = [this](std::size_t, std::span<const double> at, NetworkValues& now,
                             std::vector<NetworkValues>* along) {
      now = values;
      now.element[2] = now.element[5] = at[0];
      if (at.size() > 1) now.element[0] = at[1];
      if (!along) return;
      along->assign(at.size(), periodic::zero_direction(values));
      (*along)[0].element[2] = (*along)[0].element[5] = 1.0;
      if (at.size() > 1) (*along)[1].element[0] = 1.0;
    };
    for (const Record& record : records) task.records.push_back({RecordedExcitation{0, &record}});
    task.duration = 10.0;
    task.coordinate = 2;
    return task;
  }
};

double scanned(const RecordTask& task, std::vector<double> design) {
  NetworkValues values;
  task.network_at(0, design, values, nullptr);
  double worst = 0.0, sum = 0.0;
  for (const auto& records : task.records) {
    const transient::ForcedMotion motion =
        transient::forced_motion(task.network, [&](double) { return values; }, {},
                                 {.from = 1.0, .records = records, .duration = task.duration, .samples = 2});
    REQUIRE(motion.failure.empty());
    const double peak = std::abs(motion.peaks[task.coordinate].displacement);
    worst = std::max(worst, peak);
    sum += peak;
  }
  const bool is_worst = task.goal.objective == RecordObjective::worst_peak;
  return is_worst ? worst : sum / static_cast<double>(task.records.size());
}

// The least of a fine scan, then of finer ones around it.
double least_of_scan(const RecordTask& task) {
  double from = task.parameters[0].lower, to = task.parameters[0].upper, least = 1e300;
  for (int level = 0; level < 4; ++level) {
    constexpr int kPoints = 120;
    double best = from;
    for (int i = 0; i <= kPoints; ++i) {
      const double at = from + (to - from) * i / kPoints, value = scanned(task, {at});
      if (value < least) best = at;
      least = std::min(least, value);
    }
    const double width = 2.0 * (to - from) / kPoints;
    from = std::max(task.parameters[0].lower, best - width);
    to = std::min(task.parameters[0].upper, best + width);
  }
  return least;
}

Optimum best_of_starts(const RecordTask& task, std::size_t starts) {
  Optimum best;
  for (std::size_t start = 0; start < starts; ++start) {
    Optimum optimum = tune_over_records(task, start, never);
    if (start == 0 || optimum.objective < best.objective) best = std::move(optimum);
  }
  return best;
}

TEST_CASE("The tuned slip force of two storeys has the least worst and mean drift that a fine scan finds",
          "[long]") {
  const Frame frame;
  for (const RecordObjective objective : {RecordObjective::worst_peak, RecordObjective::mean_peak}) {
    RecordTask task = frame.task(false);
    task.goal.objective = objective;
    const Optimum optimum = best_of_starts(task, 6);
    const double least = least_of_scan(task);
    INFO(optimum.reason << " F = " << optimum.parameters[0].value[0] << ", " << optimum.rounds.size()
                        << " rounds, scan " << least << ", tuned " << optimum.objective);
    CHECK(optimum.outcome == Outcome::converged);
    CHECK(std::abs(optimum.certificate_gap) <= kCertified);
    CHECK(std::abs(optimum.objective - least) <= kScanned * least);
    CHECK(optimum.peaks.size() == 3);
    double multipliers = 0.0;
    for (const Peak& peak : optimum.peaks) multipliers += peak.multiplier;
    CHECK(std::abs(multipliers - 1.0) < 1e-6);
  }
}

TEST_CASE("No neighbour of a tuned slip force and stiffness has a smaller worst drift") {
  const Frame frame;
  const RecordTask task = frame.task(true);
  const Optimum optimum = best_of_starts(task, 3);
  INFO(optimum.reason << " " << optimum.parameters[0].value[0] << " " << optimum.parameters[1].value[0]
                      << ", " << optimum.rounds.size() << " rounds");
  CHECK(optimum.outcome == Outcome::converged);
  CHECK(std::abs(optimum.certificate_gap) <= kCertified);
  CHECK(std::abs(scanned(task, {optimum.parameters[0].value[0], optimum.parameters[1].value[0]}) -
                 optimum.objective) <= kScanned * optimum.objective);
  for (int direction = 0; direction < 16; ++direction) {
    const double angle = 0.4 * direction;
    for (const double step : {1e-4, 1e-3, 5e-3}) {
      const double F = std::clamp(optimum.parameters[0].value[0] + step * 3.0 * std::cos(angle), 0.0, 3.0);
      const double k =
          std::clamp(optimum.parameters[1].value[0] + step * 60.0 * std::sin(angle), 60.0, 120.0);
      CHECK(scanned(task, {F, k}) >= optimum.objective * (1.0 - kScanned));
    }
  }
}

// One mass m on a spring under a force that is suddenly there: the peak 2 P/k needs no friction, and falls
// with k: its bound holds it.
TEST_CASE("Where a bound holds the peak, its multiplier is the closed form's derivative") {
  Network network;
  network.masses = {"m"};
  network.elements = {{"k", ElementType::spring, {}, {NodeKind::mass, 0}}};
  network.excitations = {{ExcitationKind::recorded_force, 0, 0}};
  const NetworkValues values{.omega = 1.0, .mass = {1.0}, .element = {2.0}, .excitation = {{1.0, 0.0}}};
  const Record constant{.name = "P", .of = RecordOf::force, .time = {0.0, 9.0}, .values = {1.0, 1.0}};
  RecordTask task;
  task.network = network;
  task.scenarios = {"alone"};
  task.parameters = {{.name = "k", .lower = 1.0, .upper = 3.0, .nominal = 2.0, .schedule = {}}};
  task.network_at = [&](std::size_t, std::span<const double> at, NetworkValues& now,
                        std::vector<NetworkValues>* along) {
    now = values;
    now.element[0] = at[0];
    if (!along) return;
    along->assign(1, periodic::zero_direction(values));
    (*along)[0].element[0] = 1.0;
  };
  task.records = {{RecordedExcitation{0, &constant}}};
  task.duration = 9.0;
  const Optimum optimum = tune_over_records(task, 0, never);
  INFO(optimum.reason);
  CHECK(optimum.outcome == Outcome::converged);
  CHECK(optimum.parameters[0].at_bound[0] == AtBound::upper);
  CHECK(std::abs(optimum.objective - 2.0 / 3.0) <= kClosedForm);
  CHECK(std::abs(optimum.parameters[0].upper_multiplier[0] - 2.0 / 9.0) <= 1e-4);
}

// The frame with its springs as built: each sample has other factors on both.
RecordTask scattered(const Frame& frame, std::size_t samples, double share) {
  RecordTask task = frame.task(false);
  task.parameters[0].upper = 9.0;
  task.records.resize(2);
  task.duration = 6.0;
  task.goal.share = share;
  task.scenarios.assign(samples, "sample");
  std::mt19937 random(7);
  std::normal_distribution<double> normal(1.0, 0.1);
  std::vector<std::array<double, 2>> factors(samples);
  for (auto& [first, second] : factors) {
    first = normal(random);
    second = normal(random);
  }
  task.network_at = [factors, at_design = task.network_at](std::size_t s, std::span<const double> at,
                                                           NetworkValues& now,
                                                           std::vector<NetworkValues>* along) {
    at_design(s, at, now, along);
    now.element[0] *= factors[s][0];
    now.element[3] *= factors[s][1];
  };
  return task;
}

// The worst of the records in each sample, sorted; its k-th is the quantile.
double scanned_quantile(const RecordTask& task, double at, std::size_t kth) {
  std::vector<double> worst;
  NetworkValues values;
  for (std::size_t s = 0; s < task.scenarios.size(); ++s) {
    task.network_at(s, std::array{at}, values, nullptr);
    double most = 0.0;
    for (const auto& records : task.records) {
      const transient::ForcedMotion motion = transient::forced_motion(
          task.network, [&](double) { return values; }, {},
          {.from = 1.0, .records = records, .duration = task.duration, .samples = 2});
      most = std::max(most, std::abs(motion.peaks[task.coordinate].displacement));
    }
    worst.push_back(most);
  }
  std::ranges::sort(worst);
  return worst[kth - 1];
}

TEST_CASE("A tuned quantile over samples is no higher than the least of a dense scan", "[long]") {
  constexpr double kNoHigher = 1e-4;  // relative
  constexpr std::size_t kSamples = 20;
  const Frame frame;
  for (const auto& [share, kth] : {std::pair{0.8, 16UL}, std::pair{0.95, 19UL}}) {
    const RecordTask task = scattered(frame, kSamples, share);
    const Optimum optimum = best_of_starts(task, 3);
    const double F = optimum.parameters[0].value[0];
    double least = 1e300, where = 0.0;
    for (int i = 0; i <= 120; ++i) {
      const double at = 0.075 * i, value = scanned_quantile(task, at, kth);
      if (value < least) where = at;
      least = std::min(least, value);
    }
    for (int i = -30; i <= 30; ++i)
      least = std::min(least, scanned_quantile(task, std::clamp(where + 0.0025 * i, 0.0, 9.0), kth));
    INFO(optimum.reason << " F = " << F << ", " << optimum.rounds.size() << " rounds, scan " << least
                        << " at " << where << ", tuned " << optimum.objective);
    CHECK(optimum.outcome == Outcome::converged);
    CHECK(std::abs(optimum.certificate_gap) <= kCertified);
    CHECK(optimum.objective <= least * (1.0 + kNoHigher));
    CHECK(optimum.objective >= least * (1.0 - 1e-2));  // or the scan has missed it
    CHECK(std::abs(scanned_quantile(task, F, kth) - optimum.objective) <= kClosedForm * optimum.objective);
    CHECK(optimum.peaks.size() == 2 * kSamples);
  }
}

TEST_CASE("A share of all scenarios is the worst of them, and one of none or of a mean is refused") {
  const Frame frame;
  RecordTask all = scattered(frame, 3, 1.0), most = scattered(frame, 3, 0.99);
  CHECK(tune_over_records(all, 0, never).objective == tune_over_records(most, 0, never).objective);
  all.goal.share = 0.0;
  CHECK_THROWS_WITH(tune_over_records(all, 0, never), Catch::Contains("share above 0"));
  most.goal.objective = RecordObjective::mean_peak;
  CHECK_THROWS_WITH(tune_over_records(most, 0, never), Catch::Contains("worst peaks"));
}

TEST_CASE("A sample whose stiffness has no meaning is told by its name") {
  const Frame frame;
  RecordTask task = scattered(frame, 3, 1.0);
  task.scenarios = {"sample_0", "sample_1", "sample_2"};
  task.network_at = [at_sample = task.network_at](std::size_t s, std::span<const double> at,
                                                  NetworkValues& now, std::vector<NetworkValues>* along) {
    at_sample(s, at, now, along);
    if (s == 1) now.element[0] = -500.0;
  };
  CHECK_THROWS_WITH(tune_over_records(task, 0, never),
                    Catch::StartsWith("sample_1: ") && Catch::Contains("negative stiffness"));
}

TEST_CASE("A tuning over no records, or with a schedule, is refused") {
  const Frame frame;
  RecordTask task = frame.task(false);
  task.parameters[0].schedule = Schedule{{0.0, 1.0}};
  CHECK_THROWS_WITH(tune_over_records(task, 0, never), Catch::Contains("schedule"));
  task = frame.task(false);
  task.records.clear();
  CHECK_THROWS_WITH(tune_over_records(task, 0, never), Catch::Contains("needs a record"));
}

// Two storeys that are alike, side by side, and turn together; where only one of them is tuned the order
// of their turns decides, as an inerter joins them.
TEST_CASE("A tuning that starts where a motion has no derivative says why") {
  Frame frame;
  const Node ground{NodeKind::prescribed, 0}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1};
  frame.network.elements[3] = {"k2", ElementType::spring, ground, second};
  frame.network.elements[4] = {"c2", ElementType::damper, ground, second};
  frame.network.elements[5] = {"F2", ElementType::coulomb, ground, second};
  frame.network.elements.emplace_back("joint", ElementType::inerter, first, second);
  frame.values.element = {90.0, 0.3, 0.01, 90.0, 0.3, 0.01, 0.5};
  RecordTask task = frame.task(false);
  task.parameters = {{.name = "k", .lower = 60.0, .upper = 120.0, .nominal = 90.0, .schedule = {}}};
  task.network_at = [&frame](std::size_t, std::span<const double> at, NetworkValues& now,
                             std::vector<NetworkValues>* along) {
    now = frame.values;
    now.element[0] = at[0];
    if (!along) return;
    along->assign(1, periodic::zero_direction(frame.values));
    (*along)[0].element[0] = 1.0;
  };
  const Optimum optimum = tune_over_records(task, 0, never);
  CHECK(optimum.outcome == Outcome::not_converged);
  CHECK_THAT(optimum.reason, Catch::Matchers::Contains("several contacts come to rest at one instant"));
}

}  // namespace
}  // namespace frahm::tuning::record_tuning_test
