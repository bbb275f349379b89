#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/known_answers/free_oscillator.hpp"
#include "tests/solvers/fitted_motions.hpp"

// Grey boxes where the sum of squares has several minima or none to be found, and what they say of their
// fits.
namespace frahm::identification::grey_box_minima_test {
namespace {

// The rig's absorber by itself: 3 N s/m, 10985.1 N/m and 15 N, released from 30 mm; at rest after 1.2 s.
const mechanics::Network kNetwork = transient::FreeOscillator{}.network();
const std::vector<Place> kPlaces = {element("c", 1), element("k", 0), element("F", 2),
                                    initial_displacement(0)};

Model absorber(double c, double k, double F, double x_0) {
  return {{.omega = 1.0, .mass = {12.82}, .element = {k, c, F}}, {{x_0}, {0.0}}};
}
const Model kTruth = absorber(3.0, 10985.1, 15.0, 0.03);

// Displacement and, if wanted, velocity over 1.5 s, with noise.
TimeRecord decay(const Model& model, double displacement_noise, double velocity_noise, unsigned seed) {
  const transient::Samples history =
      transient::free_decay(kNetwork, model.values, model.initial, {.duration = 1.496, .samples = 375})
          .history;
  TimeRecord record{
      "decay", MotionKind::free, history.time, {{"x", 0, Signal::displacement, history.displacement[0]}}, {}};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (double& x : record.channels[0].values) x += displacement_noise * normal(random);
  if (!(velocity_noise > 0.0)) return record;
  record.channels.push_back({"v", 0, Signal::velocity, history.velocity[0]});
  for (double& v : record.channels[1].values) v += velocity_noise * normal(random);
  return record;
}

GreyBoxTask task_of(const TimeRecord& record, const Model& start) {
  GreyBoxTask task{.network = kNetwork,
                   .model_at = model_with({kTruth}, kPlaces),
                   .parameters = started_off(start, kPlaces, {1.0, 1.0, 1.0, 1.0}),
                   .records = {record}};
  const double upper[] = {50.0, 20000.0, 100.0, 0.1};
  for (std::size_t i = 0; i < 4; ++i) {
    task.parameters[i].lower = i == 1 ? 5000.0 : 0.0;
    task.parameters[i].upper = upper[i];
  }
  return task;
}

// sum ((y - f) / sigma)^2 of displacement and velocity
double chi_squared(const Identification& found, double displacement_noise, double velocity_noise) {
  double sum = 0.0;
  for (const FittedSeries& series : found.records.front().series) {
    const double sigma = series.name == "x" ? displacement_noise : velocity_noise;
    for (std::size_t i = 0; i < series.measured.size(); ++i)
      sum += std::pow((series.measured[i] - series.fitted[i]) / sigma, 2.0);
  }
  return sum;
}

bool has_note(const Identification& found, const std::string& part) {
  for (const std::string& note : found.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

constexpr double kAlike = 0.01;  // of a sum of squares that has a standard deviation of 39: the same minimum

// Fits that only grow along the record end with another number of half swings in a third of these.
TEST_CASE("A noisy decay that has come to rest is fitted as well from afar as from the truth", "[long]") {
  constexpr double kDisplacement = 1e-4, kVelocity = 3e-2;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TimeRecord record = decay(kTruth, kDisplacement, kVelocity, seed);
    const Identification found = grey_box(task_of(record, absorber(1.0, 10900.0, 14.0, 0.0295)));
    const Identification reference = grey_box(task_of(record, kTruth));
    INFO("seed " << seed);
    REQUIRE(found.failure.empty());
    CHECK(found.converged);
    CHECK(chi_squared(found, kDisplacement, kVelocity) <
          chi_squared(reference, kDisplacement, kVelocity) + kAlike);
  }
}

void check_truth(const Identification& found) {
  Model truth = kTruth;
  INFO(found.failure);
  REQUIRE(found.failure.empty());
  CHECK(found.converged);
  {
    INFO("note: " << (found.notes.empty() ? "" : found.notes.front()));
    CHECK(found.notes.empty());
  }
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    INFO(kPlaces[i].name << " = " << found.estimates[i].value);
    CHECK(std::abs(found.estimates[i].value / kPlaces[i].of(truth) - 1.0) < 1e-10);
  }
}

TEST_CASE("Friction that holds the model where it starts is lowered until it moves") {
  const TimeRecord record = decay(kTruth, 0.0, 0.0, 1);
  check_truth(grey_box(task_of(record, absorber(1.0, 10900.0, 70.0, 0.0015))));
  check_truth(grey_box(task_of(record, absorber(43.61, 5277.8, 70.75, 0.00012))));
  check_truth(grey_box(task_of(record, absorber(43.22, 9180.4, 44.71, 0.005726))));
}

TEST_CASE("A start that is right stays so") {
  check_truth(grey_box(task_of(decay(kTruth, 0.0, 0.0, 1), kTruth)));
}

// Pushed by 40 N at 25 rad/s from rest: friction above that holds the mass.
TEST_CASE("A forced motion is found from friction that holds the model, and from none") {
  mechanics::Network network = kNetwork;
  network.excitations = {{mechanics::ExcitationKind::force, 0, 1}};
  Model truth = absorber(3.0, 10985.1, 15.0, 0.0);
  truth.values.omega = 25.0;
  truth.values.excitation = {{40.0, 0.0}};
  const std::vector<Place> places(kPlaces.begin(), kPlaces.begin() + 3);
  const TimeRecord record = displacements("pushed", MotionKind::forced, network, truth, 3.0, 601);
  const std::vector<double> starts[] = {{3.0, 10985.0, 45.0}, {10.0, 11000.0, 60.0}, {0.0, 5001.0, 0.0}};
  for (const std::vector<double>& start : starts) {
    GreyBoxTask task{.network = network,
                     .model_at = model_with({truth}, places),
                     .parameters = {{"c", "1", start[0], 0.0, 50.0, false},
                                    {"k", "1", start[1], 5e3, 2e4, false},
                                    {"F", "1", start[2], 0.0, 100.0, false}},
                     .records = {record}};
    const Identification found = grey_box(task);
    INFO("from F = " << start[2] << ": c, k, F = " << found.estimates[0].value << ", "
                     << found.estimates[1].value << ", " << found.estimates[2].value);
    CHECK(found.converged);
    for (std::size_t i = 0; i < places.size(); ++i)
      CHECK(std::abs(found.estimates[i].value / places[i].of(truth) - 1.0) < 1e-9);
  }
}

TEST_CASE("A model that friction not fitted holds has not converged, and says that nothing moves") {
  GreyBoxTask task = task_of(decay(kTruth, 0.0, 0.0, 1), kTruth);
  task.model_at = model_with({absorber(3.0, 10985.1, 5000.0, 0.03)}, {kPlaces[0], kPlaces[1]});
  task.parameters.resize(2);
  const Identification found = grey_box(task);
  CHECK(!found.converged);
  CHECK(has_note(found, "nothing moves"));
  CHECK(has_note(found, "of record 'decay'"));
}

// Their covariance is that of the Fisher information, J^T J by central differences of the exact motions.
TEST_CASE("Sensors of very different noise are weighed so that the errors are the least possible") {
  const double steps = 1e-6;
  Model truth = kTruth;
  Eigen::MatrixXd J[2] = {Eigen::MatrixXd(375, 4), Eigen::MatrixXd(375, 4)};
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    Model above = kTruth, below = kTruth;
    const double step = steps * kPlaces[i].of(truth);
    kPlaces[i].of(above) += step;
    kPlaces[i].of(below) -= step;
    // Without noise that matters, but with the velocity.
    const TimeRecord high = decay(above, 0.0, 1e-300, 1), low = decay(below, 0.0, 1e-300, 1);
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t n = 0; n < 375; ++n)
        J[c](static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(i)) =
            (high.channels[c].values[n] - low.channels[c].values[n]) / (2.0 * step);
    }
  }
  const auto noise = GENERATE(std::pair{1e-4, 3e-2}, std::pair{1e-4, 3e-5}, std::pair{1e-4, 1e-7});
  const Eigen::MatrixXd information = J[0].transpose() * J[0] / (noise.first * noise.first) +
                                      J[1].transpose() * J[1] / (noise.second * noise.second);
  const Eigen::MatrixXd least = information.inverse();
  const Identification found = grey_box(
      task_of(decay(kTruth, noise.first, noise.second, 20261125), absorber(1.0, 10900.0, 14.0, 0.0295)));
  REQUIRE(found.failure.empty());
  // Three standard deviations of a standard deviation of 375 values.
  constexpr double kSample = 3.0 / 27.4;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double ratio = found.estimates[static_cast<std::size_t>(i)].standard_error / std::sqrt(least(i, i));
    INFO(kPlaces[static_cast<std::size_t>(i)].name << ": " << ratio);
    CHECK(std::abs(ratio - 1.0) < kSample);
  }
}

TEST_CASE("A variance with a share of a fixed parameter's has the degrees of freedom of both") {
  GreyBoxTask task = task_of(decay(kTruth, 1e-4, 0.0, 3), kTruth);
  const Identification alone = grey_box(task);
  task.model_at = model_with({kTruth}, {kPlaces[1], kPlaces[2], kPlaces[3], kPlaces[0]});
  task.parameters.erase(task.parameters.begin());
  task.fixed = {{"c", "1", alone.estimates[0].value, 5.0}};
  task.fixed_covariance = Eigen::MatrixXd::Constant(1, 1, 1.0);
  const Identification found = grey_box(task);
  task.fixed_covariance(0, 0) = 0.0;
  const Identification known = grey_box(task);
  REQUIRE(found.failure.empty());
  CHECK(found.estimates[3].degrees_of_freedom == 5.0);
  // Friction has its variance nearly all from the damping it stands in for.
  CHECK(found.estimates[1].degrees_of_freedom < 6.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const double V = found.covariance(place, place), V_1 = known.covariance(place, place), V_2 = V - V_1;
    const double expected = V * V / (V_1 * V_1 / 372.0 + V_2 * V_2 / 5.0);
    CHECK(known.estimates[i].degrees_of_freedom == 372.0);
    CHECK(found.estimates[i].degrees_of_freedom == Approx(expected).epsilon(1e-6));
    CHECK(found.estimates[i].degrees_of_freedom < 372.0 + 5.0);
  }
}

TEST_CASE("Fewer values than unknowns are refused, a constant record has no fit quality") {
  TimeRecord record = decay(kTruth, 0.0, 0.0, 1);
  TimeRecord three = record;
  three.time.resize(3);
  three.channels[0].values.resize(3);
  CHECK(grey_box(task_of(three, kTruth)).failure ==
        "the records have 3 measured values for 4 unknowns: at least as many values as unknowns are needed");
  for (const double level : {0.0, 0.001}) {
    record.channels[0].values.assign(record.time.size(), level);
    const Identification found = grey_box(task_of(record, absorber(1.0, 10900.0, 14.0, 0.0295)));
    REQUIRE(found.failure.empty());
    CHECK(std::isnan(found.records[0].nrmse));
    CHECK(found.notes.empty());
  }
}

TEST_CASE("A wrong model is told by what it misses and by residuals that follow one another") {
  GreyBoxTask task = task_of(decay(kTruth, 1e-4, 0.0, 5), kTruth);
  // Without friction; the mass as heavy.
  task.model_at = model_with({absorber(3.0, 10985.1, 0.0, 0.03)}, {kPlaces[0], kPlaces[1], kPlaces[3]});
  task.parameters.erase(task.parameters.begin() + 2);
  const Identification found = grey_box(task);
  CHECK(found.converged);
  CHECK(has_note(found, "of record 'decay': a wrong model or a wrong minimum"));
  CHECK(has_note(found, "its values are correlated: the intervals are too narrow"));
}

}  // namespace
}  // namespace frahm::identification::grey_box_minima_test
