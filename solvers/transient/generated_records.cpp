#include "solvers/transient/generated_records.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "solvers/samples/elementary.hpp"
#include "solvers/samples/normal_numbers.hpp"

namespace frahm::transient {
namespace {

using samples::NormalNumbers;

// For the soil and the corner at most, twice. Plain loops: no library's order of sums, so the same bits
// anywhere.
constexpr std::size_t kMost = 8;
using Vector = std::array<double, kMost>;

struct Matrix {
  explicit Matrix(std::size_t rows) : size(rows) {}
  std::array<Vector, kMost> at{};
  std::size_t size;
};

template <class Entry>
Matrix matrix_of(std::size_t size, const Entry& entry) {
  Matrix result(size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) result.at[i][j] = entry(i, j);
  }
  return result;
}

Matrix operator+(const Matrix& a, const Matrix& b) {
  return matrix_of(a.size, [&](std::size_t i, std::size_t j) { return a.at[i][j] + b.at[i][j]; });
}

Matrix operator*(double factor, const Matrix& a) {
  return matrix_of(a.size, [&](std::size_t i, std::size_t j) { return factor * a.at[i][j]; });
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  return matrix_of(a.size, [&](std::size_t i, std::size_t j) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size; ++k) sum += a.at[i][k] * b.at[k][j];
    return sum;
  });
}

Vector operator*(const Matrix& a, const Vector& x) {
  Vector result{};
  for (std::size_t i = 0; i < a.size; ++i) {
    for (std::size_t j = 0; j < a.size; ++j) result[i] += a.at[i][j] * x[j];
  }
  return result;
}

Matrix transposed(const Matrix& a) {
  return matrix_of(a.size, [&](std::size_t i, std::size_t j) { return a.at[j][i]; });
}

Matrix identity(std::size_t size) {
  return matrix_of(size, [](std::size_t i, std::size_t j) { return i == j ? 1.0 : 0.0; });
}

double norm(const Matrix& a) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size; ++i) {
    for (std::size_t j = 0; j < a.size; ++j) sum += a.at[i][j] * a.at[i][j];
  }
  return std::sqrt(sum);
}

// The lower triangle L of L L^T (Cholesky).
Matrix triangle_of(const Matrix& a) {
  Matrix lower(a.size);
  for (std::size_t j = 0; j < a.size; ++j) {
    for (std::size_t i = j; i < a.size; ++i) {
      double left = a.at[i][j];
      for (std::size_t k = 0; k < j; ++k) left -= lower.at[i][k] * lower.at[j][k];
      lower.at[i][j] = i == j ? std::sqrt(left) : left / lower.at[j][j];
    }
  }
  return lower;
}

// x' = A x + B w of the soil and the corner, w white noise; the acceleration is C x.
//   soil    u'' + 2 zeta_g omega_g u' + omega_g^2 u = w,    a = omega_g^2 u + 2 zeta_g omega_g u'
//   corner  y'' + 2 zeta_f omega_f y' + omega_f^2 y = a,    of which y'' is the ground's acceleration
// With x = (u', u, y', y), B is the first unit vector.
struct SoilFilter {
  Matrix a;
  Vector c;
};

SoilFilter soil_filter(const GroundNoise& ground) {
  const double spring = ground.ground_frequency * ground.ground_frequency;
  const double damping = 2.0 * ground.ground_damping * ground.ground_frequency;
  const std::size_t size = ground.corner_frequency > 0.0 ? 4 : 2;
  SoilFilter filter{Matrix(size), {damping, spring}};
  filter.a.at[0] = {-damping, -spring};
  filter.a.at[1][0] = 1.0;
  if (size == 2) return filter;
  filter.c[2] = -2.0 * ground.corner_damping * ground.corner_frequency;
  filter.c[3] = -ground.corner_frequency * ground.corner_frequency;
  filter.a.at[2] = filter.c;
  filter.a.at[3][2] = 1.0;
  return filter;
}

// exp(m) by its series after halvings, then squared as often.
Matrix exponential(const Matrix& m) {
  constexpr int terms = 18;  // 0.5^18/18! is below the last bit
  int halvings = 0;
  for (double size = norm(m); size > 0.5; size *= 0.5) ++halvings;
  const Matrix part = std::ldexp(1.0, -halvings) * m;
  Matrix sum = identity(m.size);
  for (int k = terms; k > 0; --k) sum = identity(m.size) + (1.0 / k) * (part * sum);
  for (int i = 0; i < halvings; ++i) sum = sum * sum;
  return sum;
}

// One interval: x -> step x + a normal vector of the covariance `noise`.
struct Interval {
  Matrix step, noise;
};

// With the block matrix  H = [-A  W; 0  A^T],  W = 2 pi S0 B B^T:
//   exp(H D) = [..  F; 0  step^T],   noise = step F = int_0^D e^(A s) W e^(A^T s) ds.
// Source: Van Loan, IEEE Transactions on Automatic Control 23 (1978) 395-404, theorem 1.
Interval interval_of(const SoilFilter& filter, double intensity, double length) {
  const std::size_t n = filter.a.size;
  Matrix block(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      block.at[i][j] = -length * filter.a.at[i][j];
      block.at[n + j][n + i] = length * filter.a.at[i][j];
    }
  }
  block.at[0][n] = length * 2.0 * std::numbers::pi * intensity;
  const Matrix result = exponential(block);
  const Matrix step = matrix_of(n, [&](std::size_t i, std::size_t j) { return result.at[n + j][n + i]; });
  const Matrix f = matrix_of(n, [&](std::size_t i, std::size_t j) { return result.at[i][n + j]; });
  const Matrix noise = step * f;
  return {step, 0.5 * (noise + transposed(noise))};
}

// The stationary covariance  P = step P step^T + noise,  by doubling the time: P(2t) = P(t) + s P(t) s^T with
// s = step(t), until what is added vanishes.
Matrix stationary_covariance(const Interval& interval) {
  constexpr int most_doublings = 60;
  Matrix covariance = interval.noise, step = interval.step;
  for (int i = 0; i < most_doublings; ++i) {
    const Matrix more = step * covariance * transposed(step);
    covariance = covariance + more;
    if (norm(more) <= 1e-18 * norm(covariance)) break;
    step = step * step;
  }
  return covariance;
}

Vector normal_vector(NormalNumbers& random, const Matrix& factor) {
  Vector independent{};
  for (std::size_t i = 0; i < factor.size; ++i) independent[i] = random.next();
  return factor * independent;
}

// The trapezoidal rule, exact of straight lines between samples; in intervals.
double integral(const std::vector<double>& values) {
  double sum = -0.5 * (values.front() + values.back());
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace

std::vector<double> sample_times(const RandomSampling& sampling) {
  constexpr double rounding = 1e-9;  // of an interval: a duration is meant to hold its last one
  const auto intervals = static_cast<std::size_t>(sampling.duration * sampling.rate + rounding);
  std::vector<double> times(intervals + 1);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i) / sampling.rate;
  return times;
}

std::vector<double> white_noise(const RandomSampling& sampling, double intensity) {
  NormalNumbers random(sampling.seed, sampling.stream);
  const double deviation = std::sqrt(2.0 * std::numbers::pi * intensity * sampling.rate);
  std::vector<double> values(sample_times(sampling).size());
  for (double& value : values) value = deviation * random.next();
  return values;
}

double envelope_at(const Envelope& envelope, double time, double duration) {
  if (envelope.shape == Envelope::Shape::none) return 1.0;
  const bool is_jennings = envelope.shape == Envelope::Shape::jennings;
  if (time < envelope.rise) {
    const double part = time / envelope.rise;
    return is_jennings ? part * part : part;
  }
  if (time <= envelope.level_end) return 1.0;
  return is_jennings ? samples::exponential(-envelope.decay * (time - envelope.level_end))
                     : (duration - time) / (duration - envelope.level_end);
}

double ground_density(const GroundNoise& ground, double omega) {
  const auto square = [](double x) { return x * x; };
  const double soil = square(ground.ground_frequency), w = square(omega);
  const double damped = 4.0 * square(ground.ground_damping) * soil * w;
  const double density = ground.intensity * (square(soil) + damped) / (square(soil - w) + damped);
  if (!(ground.corner_frequency > 0.0)) return density;
  const double corner = square(ground.corner_frequency);
  return density * square(w) / (square(corner - w) + 4.0 * square(ground.corner_damping) * corner * w);
}

std::vector<double> ground_acceleration(const RandomSampling& sampling, const GroundNoise& ground) {
  const std::vector<double> times = sample_times(sampling);
  const SoilFilter filter = soil_filter(ground);
  const Interval interval = interval_of(filter, ground.intensity, 1.0 / sampling.rate);
  const Matrix noise = triangle_of(interval.noise), start = triangle_of(stationary_covariance(interval));
  NormalNumbers random(sampling.seed, sampling.stream);
  Vector state = normal_vector(random, start);
  std::vector<double> values, envelope;
  for (const double time : times) {
    envelope.push_back(envelope_at(ground.envelope, time, times.back()));
    double acceleration = 0.0;
    for (std::size_t i = 0; i < noise.size; ++i) acceleration += filter.c[i] * state[i];
    values.push_back(envelope.back() * acceleration);
    state = interval.step * state;
    const Vector kick = normal_vector(random, noise);
    for (std::size_t i = 0; i < noise.size; ++i) state[i] += kick[i];
  }
  const double drift = integral(values) / integral(envelope);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= drift * envelope[i];
  return values;
}

}  // namespace frahm::transient
