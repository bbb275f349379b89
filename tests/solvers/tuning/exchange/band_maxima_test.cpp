// Every local maximum of a curve over a band, however narrow, as long as the seeds know its width.
#include "solvers/tuning/exchange/band_maxima.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace band_maxima_test {
namespace {

using frahm::tuning::BandMaxima;
using frahm::tuning::CurvePoint;
using frahm::tuning::find_band_maxima;

constexpr double accuracy = 1e-9;  // of places and values: both are solved

// Magnification of one mass, 1/sqrt((1 - r^2)^2 + (2 zeta r)^2) with r = x/x0, and its slope by x.
CurvePoint magnification(double x, double x0, double zeta, double height) {
  const double r = x / x0, a = 1.0 - r * r, b = 2.0 * zeta * r;
  const double square = a * a + b * b, slope = (-4.0 * r * a + 8.0 * zeta * zeta * r) / x0;
  const double value = height / std::sqrt(square);
  return {x, value, -0.5 * value / square * slope, -0.5 * value / square * slope};
}

CurvePoint sum(CurvePoint a, const CurvePoint& b) {
  a.value += b.value;
  a.slope_left += b.slope_left;
  a.slope_right += b.slope_right;
  return a;
}

// An even grid, and about each resonance places as close as half its width.
std::vector<double> seeds(double from, double to, const std::vector<std::pair<double, double>>& resonances) {
  constexpr int intervals = 24;
  std::vector<double> places;
  for (int i = 0; i <= intervals; ++i) places.push_back(from + (to - from) * i / intervals);
  for (const auto& [x0, width] : resonances) {
    for (double away = 0.5 * width; away < (to - from) / intervals; away *= 2.0) {
      places.push_back(x0 - away);
      places.push_back(x0 + away);
    }
  }
  std::sort(places.begin(), places.end());
  std::erase_if(places, [&](double place) { return place < from || place > to; });
  return places;
}

double highest(const BandMaxima& found) {
  double most = 0.0;
  for (const CurvePoint& maximum : found.maxima) most = std::max(most, maximum.value);
  return most;
}

TEST_CASE("a peak of a millionth of the band's width is found between two broad ones") {
  // The narrow peak's foot is so low that no sample of an even grid of 10,000 places sees more than 2 % of
  // it.
  const auto curve = [](double x) {
    return sum(sum(magnification(x, 17.0, 0.05, 1.0), magnification(x, 29.0, 0.05, 1.0)),
               magnification(x, 23.456789, 1e-6, 1e-4));
  };
  double seen = 0.0;
  for (int i = 0; i <= 10000; ++i) seen = std::max(seen, curve(15.0 + 20.0 * i / 10000).value);
  const BandMaxima found =
      find_band_maxima(curve, seeds(15, 35, {{17, 0.85}, {29, 1.45}, {23.456789, 2.3e-5}}), 0.5, 1e-7);
  CHECK(seen < 0.5 * highest(found));
  CHECK(highest(found) == Approx(curve(23.456789).value).epsilon(1e-6));
  CHECK(highest(found) >= curve(23.456789).value);
}

TEST_CASE("the worst of two branches: where the higher one ends, its last point is a maximum") {
  constexpr double end = 20.123456789, place = 1e-8;  // relative: the search stops there
  const auto curve = [](double x) {
    return x <= end ? CurvePoint{x, 1.0 + 0.1 * (x - 15.0), 0.1, 0.1}
                    : CurvePoint{x, 0.5 - 0.01 * (x - 15.0), -0.01, -0.01};
  };
  const BandMaxima found = find_band_maxima(curve, seeds(15, 35, {}), 0.1, 1e-7, true);
  REQUIRE(found.maxima.size() == 1);
  CHECK(found.maxima[0].is_end);
  CHECK(found.maxima[0].at == Approx(end).epsilon(place));
  CHECK(found.maxima[0].at <= end);
}

TEST_CASE("where a branch ends before places with values but no slopes, its last point is a maximum") {
  constexpr double end = 20.123456789, place = 1e-8;
  const auto curve = [](double x) {
    return x <= end ? CurvePoint{x, 1.0 + 0.1 * (x - 15.0), 0.1, 0.1} : CurvePoint{x, 0.5, NAN, NAN};
  };
  const BandMaxima found = find_band_maxima(curve, seeds(15, 35, {}), 0.1, 1e-7, true);
  REQUIRE(found.maxima.size() == 1);
  CHECK(found.maxima[0].is_end);
  CHECK(found.maxima[0].at == Approx(end).epsilon(place));
}

TEST_CASE("random sums of resonances: no sample of 20,000 lies above the highest maximum found") {
  std::mt19937_64 random(20261121);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::pair<double, double>> resonances;
    std::vector<std::array<double, 3>> modes;
    for (int k = 0; k < 4; ++k) {
      const double x0 = 12.0 + 26.0 * uniform(random), zeta = std::pow(10.0, -1.0 - 4.0 * uniform(random));
      resonances.push_back({x0, zeta * x0});
      modes.push_back({x0, zeta, 2.0 * zeta * (0.5 + uniform(random))});
    }
    const auto curve = [&](double x) {
      CurvePoint total{x, 0.0, 0.0, 0.0};
      for (const auto& [x0, zeta, height] : modes) total = sum(total, magnification(x, x0, zeta, height));
      return total;
    };
    const BandMaxima found = find_band_maxima(curve, seeds(15, 35, resonances), 0.5, 1e-7);
    double seen = 0.0;
    for (int i = 0; i <= 20000; ++i) seen = std::max(seen, curve(15.0 + 20.0 * i / 20000).value);
    for (const auto& [x0, zeta, height] : modes) {  // and beside each resonance, where samples may miss it
      for (int i = -50; i <= 50; ++i) {
        const double x = x0 * (1.0 + zeta * i / 25.0);
        if (x >= 15.0 && x <= 35.0) seen = std::max(seen, curve(x).value);
      }
    }
    INFO("trial " << trial);
    CHECK(highest(found) >= seen * (1.0 - 1e-7));
  }
}

TEST_CASE("the two maxima of a pair of close peaks are told apart") {
  const auto curve = [](double x) {
    return sum(magnification(x, 20.0, 1e-3, 1.0), magnification(x, 20.2, 1e-3, 1.0));
  };
  const BandMaxima found = find_band_maxima(curve, seeds(15, 35, {{20.0, 0.02}, {20.2, 0.02}}), 0.5, 1e-7);
  REQUIRE(found.maxima.size() == 2);
  for (const CurvePoint& maximum : found.maxima) CHECK(std::abs(maximum.slope_left) < 1e-6);
}

TEST_CASE("kinks, the ends of the band and a flat curve") {
  const auto roof = [](double x) -> CurvePoint {
    const double left = x <= 22.0 ? 1.0 : -1.0, right = x < 22.0 ? 1.0 : -1.0;
    return {x, 10.0 - std::abs(x - 22.0), left, right};
  };
  const std::vector<double> coarse{15, 19, 27, 35}, with_kink{15, 22, 35};
  for (const auto& places : {coarse, with_kink}) {
    const BandMaxima found = find_band_maxima(roof, places, 0.5, 1e-9);
    CHECK(highest(found) == Approx(10.0).epsilon(1e-7));
  }
  const auto falling = [](double x) -> CurvePoint { return {x, 100.0 - x, -1.0, -1.0}; };
  const BandMaxima end = find_band_maxima(falling, coarse, 0.5, 1e-9);
  REQUIRE(end.maxima.size() == 1);
  CHECK(end.maxima[0].at == 15.0);
  const auto single = find_band_maxima(falling, std::vector<double>{20.0}, 0.5, 1e-9);
  REQUIRE(single.maxima.size() == 1);
  CHECK(single.maxima[0].value == 80.0);
}

TEST_CASE("a place without a value does not hide the peak beside it") {
  const auto curve = [](double x) -> CurvePoint {
    if (std::abs(x - 21.0) < 1e-3) {
      const double none = std::nan("");
      return {x, none, none, none};
    }
    return magnification(x, 20.0, 0.01, 1.0);
  };
  std::vector<double> places = seeds(15, 35, {{20.0, 0.2}});
  places.push_back(21.0);
  std::sort(places.begin(), places.end());
  const BandMaxima found = find_band_maxima(curve, places, 0.5, 1e-7);
  CHECK(highest(found) == Approx(1.0 / (2.0 * 0.01 * std::sqrt(1.0 - 1e-4))).epsilon(accuracy));
}

}  // namespace
}  // namespace band_maxima_test
