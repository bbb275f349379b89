// studies/earthquakes: a shipped record against its formula, and motions under it against small steps.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "solvers/transient/generated_records.hpp"
#include "tests/end_to_end/motion_file.hpp"
#include "tests/study_path.hpp"

namespace earthquakes_test {
namespace {

constexpr double gravity = 9.80665;  // [m/s2]

struct Quake {
  std::vector<double> time, acceleration;  // [s], [m/s2]
};

Quake shipped_quake() {
  Quake quake;
  std::ifstream file(FRAHM_SOURCE_DIR "/studies/earthquakes/synthetic_quake.csv");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    quake.time.push_back(std::stod(line));
    quake.acceleration.push_back(gravity * std::stod(line.substr(line.find(',') + 1)));
  }
  return quake;
}

TEST_CASE("synthetic_quake.csv is what its header says") {
  namespace transient = frahm::transient;
  constexpr double digits = 0.51e-7 * gravity;  // as written
  const Quake quake = shipped_quake();
  const transient::RandomSampling sampling{.duration = 30.0, .rate = 50.0, .seed = 1940, .stream = 4};
  const std::vector<double> made = transient::ground_acceleration(
      sampling, {.intensity = 0.01,
                 .ground_frequency = 15.6,
                 .ground_damping = 0.6,
                 .corner_frequency = 1.5,
                 .corner_damping = 0.6,
                 .envelope = {transient::Envelope::Shape::jennings, 2.0, 12.0, 0.2}});
  double peak = 0.0;
  for (const double a : made) peak = std::max(peak, std::abs(a));
  REQUIRE(quake.time.size() == made.size());
  for (std::size_t i = 0; i < made.size(); ++i)
    CHECK(std::abs(quake.acceleration[i] - made[i] * 0.319 * gravity / peak) < digits);
}

// z'' = -(c z' + k z + s)/m - a(t),  s' = k_b z' within |s| <= F, else s = +-F: drift z in small steps of
// Runge and Kutta's fourth order, the slider cut back after each.
struct Frame {
  double m = 1e4, k = 1.6e6, c = 5e3, k_b = 1.6e6, limit = 1e4;
};

std::vector<double> drift_at_samples(const Frame& frame, const Quake& quake, double duration) {
  constexpr int steps = 2000;  // in an interval of the record
  const double interval = quake.time[1], h = interval / steps;
  double z = 0.0, v = 0.0, s = 0.0;
  std::vector<double> drift{0.0};
  const auto intervals = static_cast<std::size_t>(std::llround(duration / interval));
  for (std::size_t i = 0; i < intervals; ++i) {
    const bool shakes = i + 1 < quake.time.size();  // behind its end the ground stands still
    for (int n = 0; n < steps; ++n) {
      const auto acceleration = [&](double part, double zz, double vv) {
        const double a =
            shakes ? std::lerp(quake.acceleration[i], quake.acceleration[i + 1], (n + part) / steps) : 0.0;
        const double brace = std::clamp(s + frame.k_b * (zz - z), -frame.limit, frame.limit);
        return -(frame.c * vv + frame.k * zz + brace) / frame.m - a;
      };
      const double a1 = acceleration(0.0, z, v), v2 = v + 0.5 * h * a1;
      const double a2 = acceleration(0.5, z + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2;
      const double a3 = acceleration(0.5, z + 0.5 * h * v2, v3), v4 = v + h * a3;
      const double a4 = acceleration(1.0, z + h * v3, v4);
      const double moved = h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
      s = std::clamp(s + frame.k_b * moved, -frame.limit, frame.limit);
      z += moved;
      v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    drift.push_back(z);
  }
  return drift;
}

TEST_CASE(
    "quake_frame.toml: the drift is that of an independent integration, with the brace slipping and "
    "without") {
  constexpr double steps = 2e-5;  // of the peak: the error of the small steps where the brace changes
  const Quake quake = shipped_quake();
  for (const bool slips : {true, false}) {
    Frame frame;
    if (!slips) frame.limit = 1e9;
    const runs::MotionFile file(
        study_path("quake_frame"), "transient",
        slips ? std::vector<std::string>{} : std::vector<std::string>{"--set", "F=1e9 N"});
    const std::vector<double> expected = drift_at_samples(frame, quake, 35.0);
    const std::vector<double>& drift = file["drift_displacement"];
    REQUIRE(drift.size() == expected.size());
    double peak = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < drift.size(); ++i) {
      peak = std::max(peak, std::abs(expected[i]));
      worst = std::max(worst, std::abs(drift[i] - expected[i]));
    }
    INFO("slips " << slips << ", peak " << peak << ", at the end " << expected.back() << ", peak of the file "
                  << file["drift_peak"][0]);
    CHECK(worst < steps * peak);
    CHECK(file["drift_peak"][0] >= peak * (1.0 - steps));
    CHECK(file["drift_peak"][0] < peak * 1.01);  // samples at 50 Hz
    CHECK(file["energy_balance"][0] < 1e-9);
    CHECK_THAT(1000.0 * file["drift_peak"][0], Catch::WithinAbs(slips ? 26.170 : 33.825, 0.005));
    if (slips) CHECK_THAT(1000.0 * drift.back(), Catch::WithinAbs(0.699, 0.005));
  }
}

// The largest |z| of  z'' + 2 zeta w z' + w^2 z = -a(t)  for an acceleration linear from sample to sample,
// exactly at times much closer than the samples (Nigam and Jennings 1969): from (z, v), with z_p = A + B t
// that follows the line,
//   z = z_p + e^(-zeta w t) (C cos w_d t + D sin w_d t).
double linear_peak(const Quake& quake, double period, double zeta, double duration) {
  constexpr int parts = 200;  // of an interval of the record
  const double w = 2.0 * std::numbers::pi / period, w_d = w * std::sqrt(1.0 - zeta * zeta);
  const double interval = quake.time[1], h = interval / parts;
  const double fade = std::exp(-zeta * w * h), turn_c = std::cos(w_d * h), turn_s = std::sin(w_d * h);
  double z = 0.0, v = 0.0, peak = 0.0;
  for (std::size_t i = 0; static_cast<double>(i) * interval < duration - 0.5 * interval; ++i) {
    const bool shakes = i + 1 < quake.time.size();
    const double first = shakes ? quake.acceleration[i] : 0.0,
                 last = shakes ? quake.acceleration[i + 1] : 0.0;
    const double slope = (last - first) / interval;
    for (int n = 0; n < parts; ++n) {
      const double a = first + slope * h * n;
      const double B = -slope / (w * w), A = (-a - 2.0 * zeta * w * B) / (w * w);
      const double C = z - A, D = (v - B + zeta * w * C) / w_d;
      const double c = fade * (C * turn_c + D * turn_s), s = fade * (D * turn_c - C * turn_s);
      z = A + B * h + c;
      v = B - zeta * w * c + w_d * s;
      peak = std::max(peak, std::abs(z));
    }
  }
  return peak;
}

TEST_CASE(
    "response_spectrum.toml: without friction the spectrum of an independent integration, with it below") {
  constexpr double between_steps = 2e-4;  // of a peak at the shortest period: (pi h/T)^2/2, h = 0.1 ms
  const Quake quake = shipped_quake();
  std::string text = runs::reduced("response_spectrum", {{"T", 9}});
  const std::string name = "synthetic_quake.csv";
  text.replace(text.find("\"" + name) + 1, name.size(),
               std::string(FRAHM_SOURCE_DIR) + "/studies/earthquakes/" + name);
  const runs::Map map = runs::run_study(text);
  const std::vector<double> damping{0.02, 0.05, 0.1};
  const std::size_t periods = 9, points = periods * damping.size();
  REQUIRE(map["relative_peak"].size() == 3 * points);
  for (std::size_t j = 0; j < damping.size(); ++j) {
    for (std::size_t i = 0; i < periods; ++i) {
      const double period = 0.02 * std::pow(500.0, static_cast<double>(i) / 8.0);
      const std::size_t at = j * periods + i;
      INFO("T = " << period << " s, zeta = " << damping[j]);
      CHECK_THAT(map["relative_peak"][at],
                 Catch::WithinRel(linear_peak(quake, period, damping[j], 35.0), between_steps));
      CHECK(map["friction_slips"][2 * points + at] >= 1.0);
    }
    // A stiff oscillator follows the ground: omega^2 S_d is close to the peak of its acceleration.
    CHECK_THAT(map["relative_pseudo_acceleration"][j * periods], Catch::WithinRel(0.319 * gravity, 0.05));
  }
  for (std::size_t i = 0; i < 3 * points; ++i) {
    const double period = 0.02 * std::pow(500.0, static_cast<double>(i % periods) / 8.0);
    const double omega = 2.0 * std::numbers::pi / period, peak = map["relative_peak"][i];
    CHECK_THAT(map["relative_pseudo_velocity"][i], Catch::WithinRel(omega * peak, 1e-12));
    CHECK_THAT(map["relative_pseudo_acceleration"][i], Catch::WithinRel(omega * omega * peak, 1e-12));
  }
  for (std::size_t i = 0; i < 3 * points; ++i) CHECK(map["energy_balance"][i] < 1e-9);
}

TEST_CASE("newmark_block.toml: the block slips V^2/(2 mu g) (1 - mu g/a)") {
  constexpr double exact = 1e-12;  // relative
  const double m = 2000.0, deceleration = 0.12 * gravity, a = 3.0, V = 1.5;
  const double slip = V * V / (2.0 * deceleration) * (1.0 - deceleration / a);
  const runs::MotionFile file(study_path("newmark_block"), "transient");
  CHECK_THAT(file["slip_displacement"].back(), Catch::WithinRel(slip, exact));
  CHECK_THAT(file["slip_peak"][0], Catch::WithinRel(slip, exact));
  CHECK_THAT(file["friction_energy"][0], Catch::WithinRel(m * deceleration * slip, exact));
  CHECK_THAT(file["final_energy"][0], Catch::WithinRel(0.5 * m * V * V, exact));
  const auto &onset = file["friction_stop_onset"], &release = file["friction_release"];
  REQUIRE(onset.size() == 1);
  CHECK_THAT(onset[0], Catch::WithinRel(V / deceleration, exact));
  CHECK(std::isnan(release[0]));
}

}  // namespace
}  // namespace earthquakes_test
