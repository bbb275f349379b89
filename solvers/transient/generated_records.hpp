#pragma once

#include <cstdint>
#include <vector>

// Random records: samples at equal intervals, between which a record is linear.
namespace frahm::transient {

// Which samples, and of which random numbers.
struct RandomSampling {
  double duration = 0.0;     // [s]; the last sample is not after it
  double rate = 0.0;         // [1/s], samples a second
  std::uint64_t seed = 0;    // of an ensemble
  std::uint32_t stream = 0;  // of one record of it: records of different streams are independent
};

std::vector<double> sample_times(const RandomSampling& sampling);

// White noise of the two-sided intensity S0, per rad/s ([(m/s^2)^2 s] of an acceleration, [N^2 s] of a
// force): independent normal samples of the variance 2 pi S0 rate, joined by straight lines. With D = 1/rate
// the spectral density is
//   S(omega) = S0 (sin(omega D/2) / (omega D/2))^4,
// flat to 1 % for periods above 26 D, and the mean square 2/3 of the samples' variance: a straight line
// between samples is their convolution with a triangle, whose transform is D sin^2(omega D/2)/(omega D/2)^2.
std::vector<double> white_noise(const RandomSampling& sampling, double intensity);

// How the strength of a record grows and fades over time: e(t) between 0 and 1.
struct Envelope {
  enum class Shape {
    none,       // 1
    jennings,   // (t/rise)^2, then 1, from `level_end` on exp(-decay (t - level_end))
    trapezoid,  // t/rise, then 1, from `level_end` on straight to 0 at the record's end
  };
  Shape shape = Shape::none;
  double rise = 0.0, level_end = 0.0;  // [s]
  double decay = 0.0;                  // [1/s]
};

// The ground's acceleration where white noise below it, of the two-sided intensity S0 [m^2/s^3], shakes a
// layer of soil of frequency omega_g and damping ratio zeta_g (Kanai and Tajimi):
//   S(omega) = S0 (omega_g^4 + 4 zeta_g^2 omega_g^2 omega^2) / ((omega_g^2 - omega^2)^2 + 4 zeta_g^2
//   omega_g^2 omega^2).
// At low frequencies it is S0, so that velocities grow without bound; a corner omega_f, zeta_f takes these
// away by the factor  omega^4 / ((omega_f^2 - omega^2)^2 + 4 zeta_f^2 omega_f^2 omega^2)  (Clough, Penzien).
struct GroundNoise {
  double intensity = 0.0;         // S0
  double ground_frequency = 0.0;  // omega_g [rad/s]
  double ground_damping = 0.0;    // zeta_g [1]
  double corner_frequency = 0.0;  // omega_f [rad/s]; 0: none
  double corner_damping = 0.0;    // zeta_f [1]
  Envelope envelope{};
};

// The density above at a frequency [rad/s].
double ground_density(const GroundNoise& ground, double omega);

// Samples of a stationary record of that density, times the envelope. Their covariances are exact: the filter
// of the soil is stepped exactly from sample to sample from its stationary state. Straight lines between them
// multiply densities far below the rate by (sin(omega D/2)/(omega D/2))^4.
// Baseline: a multiple of the envelope is taken off,  a(t) - e(t) int a dt / int e dt,  so that the ground's
// velocity is zero at the end as at the start.
// Sources: Tajimi, Proc. 2nd World Conf. Earthquake Engineering (1960) II, 781-798; Clough and Penzien,
// Dynamics of Structures (1975); Jennings, Housner and Tsai, Earthquake Engineering Research
// Laboratory, Caltech (1968).
std::vector<double> ground_acceleration(const RandomSampling& sampling, const GroundNoise& ground);

// The factor of an envelope at a time [s].  duration: of the record [s].
double envelope_at(const Envelope& envelope, double time, double duration);

}  // namespace frahm::transient
