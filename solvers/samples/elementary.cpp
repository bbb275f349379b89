#include "solvers/samples/elementary.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "solvers/algebra/no_value.hpp"

// Compiled without fused products and sums (CMakeLists.txt). frexp, ldexp, floor and abs are exact.
namespace frahm::samples {
namespace {

// ln 2 as a number of 32 bits, of which whole multiples are exact, and the rest.
constexpr double kLn2High = 0x1.62e42feep-1, kLn2Rest = 0x1.a39ef35793c76p-33;

// 2 artanh(z) = 2 z (1 + z^2/3 + z^4/5 + ...), |z| < 0.172: what is left out is below z^24/25 = 2e-20.
double twice_artanh(double z) {
  constexpr int kLast = 23;
  const double square = z * z;
  double sum = 0.0;
  for (int k = kLast; k > 1; k -= 2) sum = square * (sum + 1.0 / k);
  return 2.0 * (z + z * sum);
}

template <std::size_t N>
double polynomial(const std::array<double, N>& coefficients, double x) {
  double sum = 0.0;
  for (std::size_t i = N; i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

// The rational functions of M. J. Wichura, Algorithm AS 241 (PPND16), Applied Statistics 37 (1988) 477-484.
constexpr std::array<double, 8> kMiddleAbove{
    3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3, 1.3731693765509461125e+4,
    4.5921953931549871457e+4, 6.7265770927008700853e+4, 3.3430575583588128105e+4, 2.5090809287301226727e+3};
constexpr std::array<double, 8> kMiddleBelow{1.0,
                                             4.2313330701600911252e+1,
                                             6.8718700749205790830e+2,
                                             5.3941960214247511077e+3,
                                             2.1213794301586595867e+4,
                                             3.9307895800092710610e+4,
                                             2.8729085735721942674e+4,
                                             5.2264952788528545610e+3};
constexpr std::array<double, 8> kTailAbove{1.42343711074968357734e0,  4.63033784615654529590e0,
                                           5.76949722146069140550e0,  3.64784832476320460504e0,
                                           1.27045825245236838258e0,  2.41780725177450611770e-1,
                                           2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr std::array<double, 8> kTailBelow{1.0,
                                           2.05319162663775882187e0,
                                           1.67638483018380384940e0,
                                           6.89767334985100004550e-1,
                                           1.48103976427480074590e-1,
                                           1.51986665636164571966e-2,
                                           5.47593808499534494600e-4,
                                           1.05075007164441684324e-9};
constexpr std::array<double, 8> kFarAbove{6.65790464350110377720e0,  5.46378491116411436990e0,
                                          1.78482653991729133580e0,  2.96560571828504891230e-1,
                                          2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                          2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr std::array<double, 8> kFarBelow{1.0,
                                          5.99832206555887937690e-1,
                                          1.36929880922735805310e-1,
                                          1.48753612908506148525e-2,
                                          7.86869131145613259100e-4,
                                          1.84631831751005468180e-5,
                                          1.42151175831644588870e-7,
                                          2.04426310338993978564e-15};

// Phi(-x) of x >= 0.
double lower_share(double x) {
  constexpr double kRootOfTwoPi = 2.5066282746310005;
  constexpr double kFar = 2.5;
  constexpr int kTerms = 120;  // either way below the last bit
  const double density = exponential(-0.5 * x * x) / kRootOfTwoPi;
  if (x > kFar) {
    // phi(x)/(x + 1/(x + 2/(x + 3/(x + ...  (Laplace)
    double fraction = x;
    for (int k = kTerms; k > 0; --k) fraction = x + k / fraction;
    return density / fraction;
  }
  // 1/2 - phi(x) (x + x^3/3 + x^5/15 + ...)
  double term = x, sum = x;
  for (int k = 3; k < kTerms; k += 2) sum += term *= x * x / k;
  return 0.5 - density * sum;
}

}  // namespace

// x = n ln 2 + r, |r| <= 0.35, and Taylor's series of e^r: what is left out is below r^18/18! = 1e-24.
double exponential(double x) {
  constexpr double kOverflow = 709.7, kUnderflow = -745.0;
  constexpr int kLast = 17;
  if (x > kOverflow) return kInfinity;
  if (x < kUnderflow) return 0.0;
  const double n = std::floor(x * std::numbers::log2e + 0.5);
  const double r = (x - n * kLn2High) - n * kLn2Rest;
  double sum = 0.0;
  for (int k = kLast; k > 1; --k) sum = (r / k) * (1.0 + sum);
  return std::ldexp(1.0 + r * (1.0 + sum), static_cast<int>(n));
}

// x = m 2^n, sqrt(1/2) <= m < sqrt(2):  log x = n ln 2 + 2 artanh((m - 1)/(m + 1)).
double logarithm(double x) {
  if (std::isinf(x)) return x;
  int n = 0;
  double m = std::frexp(x, &n);
  if (m < std::numbers::sqrt2 / 2.0) {
    m *= 2.0;
    --n;
  }
  return n * kLn2High + (twice_artanh((m - 1.0) / (m + 1.0)) + n * kLn2Rest);
}

double logarithm_of_1_and(double x) {
  return std::abs(x) < 0.25 ? twice_artanh(x / (2.0 + x)) : logarithm(1.0 + x);
}

double normal_share(double x) {
  if (std::isinf(x)) return x < 0.0 ? 0.0 : 1.0;
  return x < 0.0 ? lower_share(-x) : 1.0 - lower_share(x);
}

double standard_normal(double share) {
  constexpr double kMiddle = 0.425, kNear = 5.0;
  if (share <= 0.0 || share >= 1.0) return share <= 0.0 ? -kInfinity : kInfinity;
  const double q = share - 0.5;
  if (std::abs(q) <= kMiddle) {
    const double r = kMiddle * kMiddle - q * q;
    return q * polynomial(kMiddleAbove, r) / polynomial(kMiddleBelow, r);
  }
  const double r = std::sqrt(-logarithm(q < 0.0 ? share : 1.0 - share));
  const double x = r <= kNear ? polynomial(kTailAbove, r - 1.6) / polynomial(kTailBelow, r - 1.6)
                              : polynomial(kFarAbove, r - kNear) / polynomial(kFarBelow, r - kNear);
  return q < 0.0 ? -x : x;
}

}  // namespace frahm::samples
