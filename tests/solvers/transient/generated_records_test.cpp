#include "solvers/transient/generated_records.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "solvers/samples/normal_numbers.hpp"
#include "tests/solvers/bits.hpp"

// Random records against the closed forms of their densities, each within the interval of its ensemble.
namespace frahm::transient::generated_records_test {
namespace {

using samples::NormalNumbers;

constexpr double pi = std::numbers::pi;
constexpr double far = 4.0;  // standard errors: none of the few dozen numbers here is further off by chance

// The two-sided density  |int a e^{-i omega t} dt|^2 / (2 pi T)  of straight lines between samples, exactly:
// they are a sum of triangles, of which each has the transform D (sin(x)/x)^2 e^{-i omega t}, x = omega D/2.
// Its ends are half triangles; what they lack is of the order of one sample.
double density_of(const std::vector<double>& values, double interval, double omega) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
    sum += values[i] * std::polar(1.0, -omega * interval * static_cast<double>(i));
  const double x = 0.5 * omega * interval, sinc = std::sin(x) / x;
  const double duration = interval * static_cast<double>(values.size() - 1);
  return std::norm(sum * interval * sinc * sinc) / (2.0 * pi * duration);
}

struct Mean {
  double sum = 0.0, square = 0.0;
  int count = 0;
  void add(double value) {
    sum += value;
    square += value * value;
    ++count;
  }
  double value() const { return sum / count; }
  double error() const { return std::sqrt((square / count - value() * value()) / (count - 1)); }
};

// A multiple of 2 pi/T: there a constant, such as that of the baseline, counts for nothing.
double whole_turns(const RandomSampling& sampling, double omega) {
  const double slowest = 2.0 * pi / sampling.duration;
  return slowest * std::round(omega / slowest);
}

TEST_CASE("Normal numbers have the moments of a normal distribution and its share in the tails") {
  constexpr int count = 200'000;
  NormalNumbers random(7, 3);
  double mean = 0.0, square = 0.0, fourth = 0.0;
  int tail = 0;
  for (int i = 0; i < count; ++i) {
    const double x = random.next();
    mean += x / count;
    square += x * x / count;
    fourth += x * x * x * x / count;
    tail += std::abs(x) > 1.959963984540054;
  }
  const double root = std::sqrt(static_cast<double>(count));
  CHECK(std::abs(mean) < far * 1.0 / root);
  CHECK(std::abs(square - 1.0) < far * std::sqrt(2.0) / root);
  CHECK(std::abs(fourth - 3.0) < far * std::sqrt(96.0) / root);
  CHECK(std::abs(tail / static_cast<double>(count) - 0.05) < far * std::sqrt(0.05 * 0.95) / root);
}

TEST_CASE("The numbers of a seed are the same for ever, and those of its streams are independent") {
  NormalNumbers first(1, 0), again(1, 0), other(1, 1);
  // Written down once: a change of the generator, of its seeding or of the transform changes these.
  CHECK(first.next() == 0x1.568712e64dc2p-3);
  CHECK(first.next() == 0x1.9a10e25cde12cp-1);
  again.next();
  again.next();
  constexpr int count = 20'000;
  double product = 0.0;
  for (int i = 0; i < count; ++i) {
    const double x = first.next();
    CHECK(x == again.next());
    product += x * other.next() / count;
  }
  CHECK(std::abs(product) < far / std::sqrt(static_cast<double>(count)));
}

TEST_CASE("White noise has the stated density up to its rate, and two thirds of its samples' variance") {
  constexpr double intensity = 0.02;
  RandomSampling sampling{.duration = 20.0, .rate = 50.0, .seed = 11};
  for (const double wanted : {0.7, 5.0, 40.0, 120.0}) {
    const double omega = whole_turns(sampling, wanted), x = 0.5 * omega / sampling.rate;
    Mean density;
    for (sampling.stream = 0; sampling.stream < 400; ++sampling.stream)
      density.add(density_of(white_noise(sampling, intensity), 1.0 / sampling.rate, omega));
    INFO("omega = " << omega);
    CHECK(std::abs(density.value() - intensity * std::pow(std::sin(x) / x, 4.0)) < far * density.error());
  }
  Mean square;
  for (sampling.stream = 0; sampling.stream < 400; ++sampling.stream) {
    const std::vector<double> a = white_noise(sampling, intensity);
    double sum = 0.0;  // int a^2 dt of straight lines: D (a0^2 + a0 a1 + a1^2)/3
    for (std::size_t i = 1; i < a.size(); ++i)
      sum += (a[i] * a[i] + a[i] * a[i - 1] + a[i - 1] * a[i - 1]) / 3.0;
    square.add(sum / static_cast<double>(a.size() - 1));
  }
  const double expected = 2.0 / 3.0 * 2.0 * pi * intensity * sampling.rate;
  CHECK(std::abs(square.value() - expected) < far * square.error());
}

TEST_CASE(
    "The ground's acceleration has the density of Kanai and Tajimi, with a corner that of Clough and "
    "Penzien") {
  RandomSampling sampling{.duration = 20.0, .rate = 200.0, .seed = 5};
  GroundNoise ground{.intensity = 0.01, .ground_frequency = 15.6, .ground_damping = 0.6};
  const bool has_corner = GENERATE(false, true);
  if (has_corner) {
    ground.corner_frequency = 1.5;
    ground.corner_damping = 0.6;
  }
  for (const double wanted : {1.5, 6.0, 15.0, 40.0}) {
    const double omega = whole_turns(sampling, wanted), x = 0.5 * omega / sampling.rate;
    Mean density;
    for (sampling.stream = 0; sampling.stream < 300; ++sampling.stream)
      density.add(density_of(ground_acceleration(sampling, ground), 1.0 / sampling.rate, omega));
    INFO("omega = " << omega << ", corner " << has_corner);
    // Leakage of a finite record and images beyond half the rate, both below this part.
    constexpr double of_finite_records = 0.03;
    const double expected = ground_density(ground, omega) * std::pow(std::sin(x) / x, 4.0);
    CHECK(std::abs(density.value() - expected) < far * density.error() + of_finite_records * expected);
  }
}

// Without a corner  int S d omega = pi S0 omega_g (1 + 4 zeta^2)/(2 zeta);  the density itself is told at
// omega = 0, S0, and at omega_g, S0 (1 + 4 zeta^2)/(4 zeta^2).
TEST_CASE("The variance of the ground's acceleration at its samples is that of its density") {
  RandomSampling sampling{.duration = 40.0, .rate = 50.0, .seed = 3};
  const GroundNoise ground{.intensity = 0.01, .ground_frequency = 12.0, .ground_damping = 0.4};
  CHECK_THAT(ground_density(ground, 0.0), Catch::WithinRel(0.01, 1e-14));
  CHECK_THAT(ground_density(ground, 12.0), Catch::WithinRel(0.01 * 1.64 / 0.64, 1e-14));
  const double expected = pi * 0.01 * 12.0 * (1.0 + 4.0 * 0.16) / 0.8;
  Mean first, middle;
  for (sampling.stream = 0; sampling.stream < 1500; ++sampling.stream) {
    const std::vector<double> a = ground_acceleration(sampling, ground);
    first.add(a.front() * a.front());
    middle.add(a[a.size() / 2] * a[a.size() / 2]);
  }
  // The baseline takes the mean off, of the variance 2 pi S0/T: 0.2 % of the record's, which is allowed for.
  CHECK(std::abs(first.value() - expected) < far * first.error() + 0.01 * expected);
  CHECK(std::abs(middle.value() - expected) < far * middle.error() + 0.01 * expected);
}

TEST_CASE("A ground that is shaken has no velocity at the end, and follows its envelope") {
  const RandomSampling sampling{.duration = 20.0, .rate = 100.0, .seed = 2, .stream = 4};
  GroundNoise ground{.intensity = 0.01,
                     .ground_frequency = 15.0,
                     .ground_damping = 0.6,
                     .envelope = {Envelope::Shape::jennings, 2.0, 8.0, 0.5}};
  for (const auto shape : {Envelope::Shape::none, Envelope::Shape::jennings, Envelope::Shape::trapezoid}) {
    ground.envelope.shape = shape;
    const std::vector<double> a = ground_acceleration(sampling, ground);
    REQUIRE(a.size() == 2001);
    double velocity = 0.0, fastest = 0.0;
    for (std::size_t i = 1; i < a.size(); ++i) {
      velocity += 0.5 * (a[i] + a[i - 1]) / sampling.rate;
      fastest = std::max(fastest, std::abs(velocity));
    }
    constexpr double rounding = 1e-12;  // of two thousand sums
    CHECK(std::abs(velocity) < rounding * fastest);
    if (shape != Envelope::Shape::none) CHECK(a.front() == 0.0);
  }
  const Envelope jennings{Envelope::Shape::jennings, 2.0, 8.0, 0.5};
  CHECK(envelope_at(jennings, 1.0, 20.0) == 0.25);
  CHECK(envelope_at(jennings, 5.0, 20.0) == 1.0);
  CHECK_THAT(envelope_at(jennings, 10.0, 20.0), Catch::WithinRel(std::exp(-1.0), 1e-14));
  const Envelope trapezoid{Envelope::Shape::trapezoid, 2.0, 8.0, 0.0};
  CHECK(envelope_at(trapezoid, 1.0, 20.0) == 0.5);
  CHECK(envelope_at(trapezoid, 14.0, 20.0) == 0.5);
  CHECK(envelope_at(trapezoid, 20.0, 20.0) == 0.0);
}

TEST_CASE("A seed gives records of the same bits on every machine") {
  const RandomSampling sampling{20.0, 50.0, 1940, 3};
  CHECK(checksum_of_bits(white_noise(sampling, 0.01)) == 0x63699c9264e08bec);
  GroundNoise ground{.intensity = 0.01, .ground_frequency = 15.6, .ground_damping = 0.6};
  CHECK(checksum_of_bits(ground_acceleration(sampling, ground)) == 0xf755ab6a1a523b53);
  ground.corner_frequency = 1.5;
  ground.corner_damping = 0.6;
  ground.envelope = {Envelope::Shape::jennings, 2.0, 10.0, 0.3};
  CHECK(checksum_of_bits(ground_acceleration(sampling, ground)) == 0x5aabe1d14d6352a);
  ground.envelope = {Envelope::Shape::trapezoid, 2.0, 10.0, 0.0};
  CHECK(checksum_of_bits(ground_acceleration(sampling, ground)) == 0x80a8a3fa46c7e95);
}

}  // namespace
}  // namespace frahm::transient::generated_records_test
