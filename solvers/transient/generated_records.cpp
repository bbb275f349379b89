#include "solvers/transient/generated_records.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "solvers/transient/normal_numbers.hpp"

namespace frahm::transient {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// x' = A x + B w of the soil and the corner, w white noise; the acceleration is C x.
//   soil    u'' + 2 zeta_g omega_g u' + omega_g^2 u = w,    a = omega_g^2 u + 2 zeta_g omega_g u'
//   corner  y'' + 2 zeta_f omega_f y' + omega_f^2 y = a,    of which y'' is the ground's acceleration
struct SoilFilter {
  MatrixXd a;
  VectorXd b, c;
};

SoilFilter soil_filter(const GroundNoise& ground) {
  const double spring = ground.ground_frequency * ground.ground_frequency;
  const double damping = 2.0 * ground.ground_damping * ground.ground_frequency;
  const Eigen::Index size = ground.corner_frequency > 0.0 ? 4 : 2;
  SoilFilter filter{MatrixXd::Zero(size, size), VectorXd::Zero(size), VectorXd::Zero(size)};
  // x = (u', u, y', y)
  filter.a.row(0).head(2) << -damping, -spring;
  filter.a(1, 0) = 1.0;
  filter.b(0) = 1.0;
  filter.c.head(2) << damping, spring;
  if (size == 2) return filter;
  filter.c.tail(2) << -2.0 * ground.corner_damping * ground.corner_frequency,
      -ground.corner_frequency * ground.corner_frequency;
  filter.a.row(2) = filter.c.transpose();
  filter.a(3, 2) = 1.0;
  return filter;
}

// exp(m) by its series after halvings, then squared as often.
MatrixXd exponential(const MatrixXd& m) {
  constexpr int terms = 18;  // 0.5^18/18! is below the last bit
  const double norm = m.cwiseAbs().colwise().sum().maxCoeff();
  const int halvings = norm > 0.5 ? static_cast<int>(std::ceil(std::log2(norm / 0.5))) : 0;
  const MatrixXd part = m * std::ldexp(1.0, -halvings);
  MatrixXd sum = MatrixXd::Identity(m.rows(), m.cols());
  for (int k = terms; k > 0; --k)
    sum = MatrixXd::Identity(m.rows(), m.cols()) + part * sum / static_cast<double>(k);
  for (int i = 0; i < halvings; ++i) sum = sum * sum;
  return sum;
}

// One interval: x -> step x + a normal vector of the covariance `noise`.
struct Interval {
  MatrixXd step, noise;
};

// With the block matrix  H = [-A  W; 0  A^T],  W = 2 pi S0 B B^T:
//   exp(H D) = [..  F; 0  step^T],   noise = step F = int_0^D e^(A s) W e^(A^T s) ds.
// Source: Van Loan, IEEE Transactions on Automatic Control 23 (1978) 395-404, theorem 1.
Interval interval_of(const SoilFilter& filter, double intensity, double length) {
  const Eigen::Index n = filter.a.rows();
  MatrixXd block = MatrixXd::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = -filter.a;
  block.topRightCorner(n, n) = 2.0 * std::numbers::pi * intensity * filter.b * filter.b.transpose();
  block.bottomRightCorner(n, n) = filter.a.transpose();
  const MatrixXd result = exponential(block * length);
  const MatrixXd step = result.bottomRightCorner(n, n).transpose();
  const MatrixXd noise = step * result.topRightCorner(n, n);
  return {step, 0.5 * (noise + noise.transpose())};
}

// The stationary covariance  P = step P step^T + noise,  by doubling the time: P(2t) = P(t) + s P(t) s^T with
// s = step(t), until what is added vanishes.
MatrixXd stationary_covariance(const Interval& interval) {
  constexpr int most_doublings = 60;
  MatrixXd covariance = interval.noise, step = interval.step;
  for (int i = 0; i < most_doublings; ++i) {
    const MatrixXd more = step * covariance * step.transpose();
    covariance += more;
    if (more.norm() <= 1e-18 * covariance.norm()) break;
    step = step * step;
  }
  return covariance;
}

VectorXd normal_vector(NormalNumbers& random, const MatrixXd& factor) {
  VectorXd independent(factor.cols());
  for (double& each : independent) each = random.next();
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
  return is_jennings ? std::exp(-envelope.decay * (time - envelope.level_end))
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
  const MatrixXd noise = interval.noise.llt().matrixL();
  const MatrixXd start = stationary_covariance(interval).llt().matrixL();
  NormalNumbers random(sampling.seed, sampling.stream);
  VectorXd state = normal_vector(random, start);
  std::vector<double> values, envelope;
  for (const double time : times) {
    envelope.push_back(envelope_at(ground.envelope, time, times.back()));
    values.push_back(envelope.back() * filter.c.dot(state));
    state = interval.step * state + normal_vector(random, noise);
  }
  const double drift = integral(values) / integral(envelope);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= drift * envelope[i];
  return values;
}

}  // namespace frahm::transient
