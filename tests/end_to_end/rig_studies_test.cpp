// The rig's further studies: detailed CVT, crank, energy shares, the absorber's damping and friction.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace rig_studies_test {
namespace {

using Complex = std::complex<double>;
using runs::Map;

constexpr double pi = std::numbers::pi;
constexpr double K = 8181.0, A = 0.02955;  // [N/m], [m]

struct Rig {
  double I, c;                   // [kg], [N s/m]
  double main_damping = 1.7688;  // [N s/m]
};

struct Motion {
  Complex main, stroke;  // of the main mass and across the absorber, over the driving force [m/N]
};

// The rig without friction, by Cramer's rule.
Motion linear_motion(const Rig& rig, double omega) {
  const Complex s(0.0, omega), link = rig.I * s * s + rig.c * s + 10985.1, tmd = 12.82 * s * s;
  const Complex lower = 102.66 * s * s + rig.main_damping * s + 7.0 * K;
  const Complex main = (tmd + link) / (lower * (tmd + link) + link * tmd);
  return {main, main * tmd / (tmd + link)};
}

std::string printed(const std::vector<double>& values) {
  return fmt::format("values = [{:.17g}]", fmt::join(values, ", "));
}

TEST_CASE("rig_cvt_detailed.toml: inertance and damping follow the printed formula over the stated ratios") {
  const Map map = runs::run_study(runs::reduced("rig_cvt_detailed", {{"omega", 3}}));
  const auto &ratio = map.coordinate("ratio"), &I = map.coordinate("inertance");
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    CHECK_THAT(I[i], Catch::WithinRel(4.0 + 3.0 * ratio[i] * ratio[i], 1e-14));  // 4/d_p^2 = 1111.1
  }
  CHECK(std::abs(I.front() - 5.01) < 0.005);
  CHECK(std::abs(I.back() - 13.29) < 0.005);
  CHECK(std::abs(map.coordinate("absorber_damping").front() - 28.92) < 0.005);
  CHECK(std::abs(map.coordinate("absorber_damping").back() - 32.90) < 0.005);
}

TEST_CASE(
    "rig_cvt_detailed.toml: the responses are those of the simple model at equal inertance and damping") {
  constexpr double equality = 1e-12;  // relative
  const std::map<std::string, int> points{{"ratio", 5}, {"omega", 41}};
  const Map detailed = runs::run_study(runs::reduced("rig_cvt_detailed", points));
  std::string simple = runs::reduced("rig_atlas", points);
  simple = runs::replaced(simple, "\"26.5104 + 0.4811*I\"", "\"c\"");
  simple = runs::replaced(simple, "FP    = 0.0419", "c = 30");
  simple = runs::replaced(simple, "\"FP*K*A\"", "10.1270");
  simple = runs::replaced(simple, "from = 4.72\nto = 12.9\npoints = 42",
                          printed(detailed.coordinate("inertance")) + "\nzip = \"cvt\"");
  simple = runs::replaced(
      simple, "parameter = \"FP\"\nfrom = 0\nto = 0.3\npoints = 31",
      "parameter = \"c\"\n" + printed(detailed.coordinate("absorber_damping")) + "\nzip = \"cvt\"");
  simple = runs::replaced(simple, "[[coordinate]]\nname = \"inertance_ratio\"",
                          "[[coordinate]]\nname = \"inertance_over_main\"");
  const Map expected = runs::run_study(simple);
  for (const char* name : {"main_peak", "main_amplitude", "main_rms", "main_phase", "tmd_peak", "tmd_phase",
                           "tmd_spring_stroke", "tmd_friction_energy", "guide_energy", "tmd_friction_stops",
                           "guide_regime", "floquet_radius", "transmitted_force"}) {
    INFO(name);
    REQUIRE(detailed[name].size() == 5 * 41);
    for (std::size_t i = 0; i < 5 * 41; ++i) {
      CHECK_THAT(detailed[name][i],
                 Catch::WithinAbs(expected[name][i], equality * std::abs(expected[name][i])));
    }
  }
}

// The study of the crank with the exciter's first harmonic alone.
std::string with_harmonic_exciter(const std::string& study) {
  const std::string motion = "profile = \"crank\"\ncrank = \"A\"\nrod = \"L\"";
  return runs::replaced(study, motion, "amplitude = \"A\"\nphase = { value = -90, unit = \"degree\" }");
}

TEST_CASE(
    "rig_crank.toml: a free main mass is moved by a seventh of the exciter's mean, and at most 3.1 mm in "
    "peak") {
  const std::string study = runs::reduced("rig_crank", {});
  const Map crank = runs::run_study(study);
  const std::string comparison =
      "[compare]                               # the harmonic exciter at each point, "
      "beside the crank\ntaylor_order = 1\nquantities = [\"main_peak\", "
      "\"main_mean\"]\n";
  const Map harmonic = runs::run_study(with_harmonic_exciter(runs::replaced(study, comparison, "")));
  double mean = 0.0;  // of a(theta), by the trapezoidal rule
  for (int i = 0; i < 64; ++i) {
    const double c = A * std::cos(2.0 * pi * i / 64);
    mean += (std::sqrt(0.12 * 0.12 - c * c) - 0.12) / 64;
  }
  const auto& rpm = crank.coordinate("omega");
  double largest = 0.0, at = 0.0;
  for (std::size_t i = 0; i < crank["main_peak"].size(); ++i) {
    const bool is_free = i / rpm.size() % 3 == 0;  // FP = 0
    if (is_free) CHECK_THAT(crank["main_mean"][i], Catch::WithinAbs(mean / 7.0, 1e-13));
    const double difference = std::abs(crank["main_peak"][i] - harmonic["main_peak"][i]);
    CHECK_THAT(crank["main_peak_compared"][i], Catch::WithinRel(harmonic["main_peak"][i], 1e-10));
    CHECK_THAT(crank["main_peak_difference"][i], Catch::WithinAbs(difference / crank["main_peak"][i], 1e-10));
    if (difference > largest) at = rpm[i % rpm.size()];
    largest = std::max(largest, difference);
  }
  CHECK(std::abs(mean / 7.0 - -0.2629e-3) < 1e-7);
  CHECK(std::abs(largest - 3.051e-3) < 1e-6);
  CHECK(at == 112.0);
  for (const double balance : crank["energy_balance"]) CHECK(balance < 1e-9);
}

TEST_CASE(
    "rig_crank.toml: a stuck absorber rides on the main mass and the second harmonic is the linear one") {
  // Main guide free, absorber so rough that it never slides: one mass of M + m.
  std::string study = runs::reduced("rig_crank", {{"omega", 31}});
  study = runs::replaced(study, "force = 15.0109", "force = 1e6");
  study = runs::replaced(study, "values = [0, 0.0419, 0.15]", "values = [0]");
  const Map crank = runs::run_study(study);
  const auto& rpm = crank.coordinate("omega");
  for (std::size_t i = 0; i < rpm.size(); ++i) {
    double square = 0.0;
    for (int n = 1; n <= 20; ++n) {
      Complex harmonic = 0.0;
      for (int j = 0; j < 128; ++j) {
        const double theta = 2.0 * pi * j / 128, c = A * std::cos(theta);
        const double a = A * std::sin(theta) + std::sqrt(0.12 * 0.12 - c * c) - 0.12;
        harmonic += a * std::polar(2.0 / 128, -n * theta);
      }
      const Complex s(0.0, n * rpm[i] * pi / 30.0);
      square += 0.5 * std::norm(K * harmonic / (115.48 * s * s + 1.7688 * s + 7.0 * K));
    }
    const double mean = crank["main_mean"][i];
    INFO(rpm[i] << " rpm");
    CHECK_THAT(crank["main_rms"][i], Catch::WithinRel(std::sqrt(mean * mean + square), 1e-10));
  }
}

TEST_CASE("rig_energy_shares.toml: shares add up to 1, and a guide of two reversals loses 4 F X a period") {
  const Map map = runs::run_study(runs::reduced("rig_energy_shares", {}));
  const auto& amplitudes = map.coordinate("A");
  for (std::size_t i = 0; i < map["status"].size(); ++i) {
    const double amplitude = amplitudes[i % amplitudes.size()] / 1000.0;
    INFO("point " << i);
    // The main mass is held exactly while K A <= D.
    CHECK((map["guide_regime"][i] == 5.0) == (K * amplitude <= 10.1270));
    if (map["guide_regime"][i] == 5.0) {
      CHECK(map["tmd_damper_energy_share"][i] == 0.0);  // nothing moves
      continue;
    }
    const double sum = map["guide_energy_share"][i] + map["guide_damper_energy_share"][i] +
                       map["tmd_damper_energy_share"][i] + map["tmd_friction_energy_share"][i];
    CHECK_THAT(sum, Catch::WithinAbs(1.0, 1e-10));
    if (map["guide_reversals"][i] != 2.0) continue;
    const double lost = 4.0 * 10.1270 * map["main_amplitude"][i];
    CHECK_THAT(map["guide_energy_share"][i], Catch::WithinRel(lost / map["energy_input"][i], 1e-9));
  }
}

TEST_CASE(
    "rig_energy_shares.toml: at large amplitude the shares are those of the linear response, falling as "
    "1/A") {
  std::string study = runs::reduced("rig_energy_shares", {});
  study =
      runs::replaced(study, "from = 0.5\nto = 500\npoints = 61\nspacing = \"log\"", "values = [1e5, 1e6]");
  const Map map = runs::run_study(study);
  const Rig rig{6.36, 26.5104 + 0.4811 * 6.36};
  std::size_t point = 0;
  for (const double rpm : map.coordinate("omega")) {
    const double omega = rpm * pi / 30.0;
    const Motion motion = linear_motion(rig, omega);
    for (const double mm : map.coordinate("A")) {
      const double force = K * mm / 1000.0, main = force * std::abs(motion.main);
      const double stroke = force * std::abs(motion.stroke);
      // Energy a period of a damper: pi c omega X^2
      const double energy = pi * omega * (1.7688 * main * main + rig.c * stroke * stroke);
      const double guide = 4.0 * 10.1270 * main / energy, tmd = 4.0 * 15.0109 * stroke / energy;
      INFO(rpm << " rpm, A = " << mm << " mm");
      // Friction lessens the motion by about the share that it takes.
      const double loose = 2.0 * (guide + tmd);
      CHECK_THAT(map["guide_energy_share"][point], Catch::WithinRel(guide, loose));
      CHECK_THAT(map["tmd_friction_energy_share"][point], Catch::WithinRel(tmd, loose));
      ++point;
    }
  }
}

double worst(const Map& map, std::size_t row, std::size_t count) {
  const auto begin = map["main_peak"].begin() + static_cast<std::ptrdiff_t>(row * count);
  return *std::max_element(begin, begin + static_cast<std::ptrdiff_t>(count));
}

// Speeds with main_peak below 20 mm, on a grid of 1 rpm.
int useful_band(const Map& map, std::size_t row, std::size_t count) {
  const auto begin = map["main_peak"].begin() + static_cast<std::ptrdiff_t>(row * count);
  return static_cast<int>(std::count_if(begin, begin + static_cast<std::ptrdiff_t>(count),
                                        [](double peak) { return peak < 0.020; }));
}

TEST_CASE("rig_tmd_damping.toml: without friction the worst peak is that of the linear rig") {
  std::string study = runs::reduced("rig_tmd_damping", {});
  study = runs::replaced(study, "value = 10.1270", "value = 0");
  study = runs::replaced(study, "from = 0\nto = 90\npoints = 7", "values = [0]");
  const Map map = runs::run_study(study);
  const auto &dampings = map.coordinate("c"), &rpm = map.coordinate("omega");
  for (std::size_t i = 0; i < dampings.size(); ++i) {
    double peak = 0.0;
    for (const double each : rpm) {
      peak = std::max(peak, K * A * std::abs(linear_motion({6.36, dampings[i]}, each * pi / 30.0).main));
    }
    INFO("c = " << dampings[i]);
    CHECK_THAT(worst(map, i, rpm.size()), Catch::WithinRel(peak, 1e-10));
  }
}

// The rig with each friction force F as the damper that loses as much at its amplitude X: 4 F/(pi omega X).
double linearised_amplitude(double c, double d, double omega) {
  Rig rig{6.36, c};
  Motion motion = linear_motion(rig, omega);
  for (int i = 0; i < 200; ++i) {
    const double main = K * A * std::abs(motion.main), stroke = K * A * std::abs(motion.stroke);
    rig.main_damping += 0.5 * (1.7688 + 4.0 * 10.1270 / (pi * omega * main) - rig.main_damping);
    rig.c += 0.5 * (c + 4.0 * d / (pi * omega * stroke) - rig.c);
    motion = linear_motion(rig, omega);
  }
  return K * A * std::abs(motion.main);
}

TEST_CASE("rig_tmd_damping.toml: friction in the absorber replaces damping: worst peak and useful band") {
  const Map map = runs::run_study(runs::reduced("rig_tmd_damping", {}));
  const auto &c = map.coordinate("c"), &d = map.coordinate("d"), &rpm = map.coordinate("omega");
  double best = 1.0, best_without_friction = 1.0, widest = 0.0;
  std::array<double, 2> best_at{}, widest_at{};
  double best_c = 0.0;
  for (std::size_t i = 0; i < c.size() * d.size(); ++i) {
    const double each_c = c[i / d.size()], each_d = d[i % d.size()], peak = worst(map, i, rpm.size());
    if (peak < best) best_at = {each_c, each_d};
    best = std::min(best, peak);
    if (each_d == 0.0 && peak < best_without_friction) {
      best_c = each_c;
      best_without_friction = peak;
    }
    const double band = useful_band(map, i, rpm.size());
    if (band > widest) widest_at = {each_c, each_d};
    widest = std::max(widest, band);
    if (each_c < 20.0) continue;
    double expected = 0.0;
    for (const double speed : rpm) {
      expected = std::max(expected, linearised_amplitude(each_c, each_d, speed * pi / 30.0));
    }
    INFO("c = " << each_c << ", d = " << each_d);
    // Loose: one harmonic only. Across a rough absorber the motion is far from it: it sticks part of each
    // cycle.
    CHECK_THAT(peak, Catch::WithinRel(expected, each_d <= 60.0 ? 0.03 : 0.07));
  }
  CHECK(std::abs(best_without_friction - 0.03614) < 5e-6);
  CHECK(best_c == 180.0);
  CHECK(std::abs(best - 0.03415) < 5e-6);
  CHECK(best_at == std::array{60.0, 90.0});
  CHECK(widest == 181.0);
  CHECK(widest_at == std::array{0.0, 75.0});
}

}  // namespace
}  // namespace rig_studies_test
