// braced_frame_records.toml: twenty earthquakes x slip forces, against a sum of modes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/study_path.hpp"

namespace braced_frame_records_test {
namespace {

using std::numbers::pi;

// z'' + 2 zeta omega z' + omega^2 z = p0 + (p1 - p0) t/h from (z, v) over h, in closed form: a straight line
// and a damped oscillation.
void advance(double omega, double zeta, double p0, double p1, double h, double& z, double& v) {
  const double slope = (p1 - p0) / h / (omega * omega);
  const double level = p0 / (omega * omega) - 2.0 * zeta / omega * slope;
  const double damped = omega * std::sqrt(1.0 - zeta * zeta), fade = std::exp(-zeta * omega * h);
  const double C = z - level, D = (v - slope + zeta * omega * C) / damped;
  const double cos = std::cos(damped * h), sin = std::sin(damped * h);
  z = level + slope * h + fade * (C * cos + D * sin);
  v = slope + fade * ((D * damped - zeta * omega * C) * cos - (C * damped + zeta * omega * D) * sin);
}

// The largest sway of the roof of ten storeys without friction: the sum of its modes
//   omega_j = 2 sqrt(k/m) sin((2j - 1) pi/42), phi_j(i) = sin((2j - 1) pi i/21),
// each driven by its participation -Gamma_j a(t), at `parts` instants between two samples.
double largest_sway(const frahm::transient::Record& record) {
  constexpr int storeys = 10, parts = 100;
  constexpr double k = 35.6e6, m = 20e3, zeta = 0.02;
  struct Mode {
    double omega, participation, roof, z = 0.0, v = 0.0;
  };
  std::vector<Mode> modes;
  for (int j = 1; j <= storeys; ++j) {
    const auto shape = [&](int i) { return std::sin((2 * j - 1) * pi * i / (2 * storeys + 1)); };
    double sum = 0.0, squares = 0.0;
    for (int i = 1; i <= storeys; ++i) {
      sum += shape(i);
      squares += shape(i) * shape(i);
    }
    const double omega = 2.0 * std::sqrt(k / m) * std::sin((2 * j - 1) * pi / (4 * storeys + 2));
    modes.push_back({omega, sum / squares, shape(storeys)});
  }
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < record.time.size(); ++i) {
    const double h = (record.time[i + 1] - record.time[i]) / parts;
    for (int part = 0; part < parts; ++part) {
      const double a0 = std::lerp(record.values[i], record.values[i + 1], part / double(parts));
      const double a1 = std::lerp(record.values[i], record.values[i + 1], (part + 1) / double(parts));
      double sway = 0.0;
      for (Mode& mode : modes) {
        advance(mode.omega, zeta, -mode.participation * a0, -mode.participation * a1, h, mode.z, mode.v);
        sway += mode.roof * mode.z;
      }
      largest = std::max(largest, std::abs(sway));
    }
  }
  return largest;
}

TEST_CASE(
    "braced_frame_records.toml: without friction the roof sways as the sum of its modes in each quake") {
  constexpr double kBetweenInstants = 1e-6;  // of the peak: (omega h)^2 / 8 of the first two modes
  const frahm::studies::Study study = frahm::studies::read_study(study_path("braced_frame_records"));
  const std::vector<frahm::transient::Record>& records = study.transient()->records[0].records;
  REQUIRE(records.size() == 20);
  const runs::Map map = runs::run_study(runs::reduced("braced_frame_records", {{"F", 2}}));
  for (std::size_t i = 0; i < records.size(); ++i) {
    INFO("record " << i);
    const double expected = largest_sway(records[i]);
    CHECK(std::abs(map["sway_peak"][2 * i] / expected - 1.0) < kBetweenInstants);
  }
}

TEST_CASE("braced_frame_records.toml: the mean sway over the quakes is least where the dampers slip") {
  const runs::Map map = runs::run_study(runs::reduced("braced_frame_records", {{"F", 5}}));
  std::vector<double> mean(5, 0.0), slips(5, 0.0);
  for (std::size_t record = 0; record < 20; ++record) {
    for (std::size_t f = 0; f < 5; ++f) {
      CHECK(map["status"][5 * record + f] == 1.0);
      mean[f] += map["sway_peak"][5 * record + f] / 20.0;
      slips[f] += map["brace1_slips"][5 * record + f];
    }
  }
  const auto best = static_cast<std::size_t>(std::ranges::min_element(mean) - mean.begin());
  CHECK(best > 0);
  CHECK(mean[best] < 0.7 * mean[0]);
  CHECK(slips[best] > 20.0 * 10.0);
}

}  // namespace
}  // namespace braced_frame_records_test
