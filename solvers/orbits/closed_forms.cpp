#include "solvers/orbits/closed_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/algebra/no_value.hpp"

namespace frahm::periodic {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

// sin(z)/z, -> 1 at z = 0.
Complex sinc(Complex z) {
  if (std::abs(z) < 1e-4) return 1.0 - z * z / 6.0;  // the next term is below rounding
  return std::sin(z) / z;
}

// s = sqrt(1 - zeta^2), imaginary for zeta > 1.
Complex damped_rate(double zeta) {
  return std::sqrt(Complex((1.0 - zeta) * (1.0 + zeta), 0.0));
}

// (e^{a tau} - e^{b tau}) / (a - b) = tau e^{(a + b) tau / 2} sinh(d)/d with d = (a - b) tau / 2, without
// overflow where the damping is strong: Re a, Re b <= 0.
Complex exponential_difference(Complex a, Complex b, double tau) {
  const Complex d = 0.5 * (a - b) * tau;
  if (std::abs(d) < 1.0) return tau * std::exp(0.5 * (a + b) * tau) * sinc(Complex(0.0, 1.0) * d);
  return (std::exp(a * tau) - std::exp(b * tau)) / (a - b);
}

int samples_over(double length, double rate) {
  constexpr double kPerRadian = 24.0;  // a local extremum cannot lie unseen between samples this close
  return 64 + static_cast<int>(kPerRadian * length * rate);
}

// The largest value of a smooth function between a and b, where it has one maximum, by golden sections. It is
// exact to rounding, as the function is stationary there.
double maximum_between(const std::function<double(double)>& function, double a, double b) {
  constexpr double kGolden = 0.6180339887498949;
  const double close = 0.5e-8 * (b - a);
  double c = b - kGolden * (b - a), d = a + kGolden * (b - a), at_c = function(c), at_d = function(d);
  while (b - a > close) {
    if (at_c > at_d) {
      b = d, d = c, at_d = at_c;
      c = b - kGolden * (b - a), at_c = function(c);
    } else {
      a = c, c = d, at_c = at_d;
      d = a + kGolden * (b - a), at_d = function(d);
    }
  }
  return std::max(at_c, at_d);
}

// The same between an end and the sample next to it. A maximum there lies between samples, so the search
// moves ever nearer to the end. What is narrower than the last step is below rounding.
double maximum_beside(const std::function<double(double)>& function, double end, double step) {
  constexpr int kHalvings = 8;
  const double at_end = function(end);
  double size = step;
  for (int i = 0; i < kHalvings; ++i) {
    size *= 0.5;
    if (function(end + size) <= at_end) continue;
    return maximum_between(function, end + std::min(0.0, 2.0 * size), end + std::max(0.0, 2.0 * size));
  }
  return at_end;
}

// sup of a smooth function over [lo, hi]: every local maximum among the samples is refined.
double supremum(const std::function<double(double)>& function, double lo, double hi, int samples) {
  const double spacing = (hi - lo) / samples;
  double best = std::max(maximum_beside(function, lo, spacing), maximum_beside(function, hi, -spacing));
  double before = function(lo), here = function(lo + spacing);
  for (int i = 1; i < samples; ++i) {
    const double after = i + 1 < samples ? function(lo + (i + 1) * spacing) : function(hi);
    if (here >= before && here >= after)
      best = std::max(best, maximum_between(function, lo + (i - 1) * spacing, lo + (i + 1) * spacing));
    before = here;
    here = after;
  }
  return best;
}

// The root of a continuous function that changes sign between lo and hi, by bisection to the last digit.
double bisect(const std::function<double(double)>& function, double lo, double hi) {
  const bool rises = function(hi) > 0.0;
  for (double middle = 0.5 * (lo + hi); middle > lo && middle < hi; middle = 0.5 * (lo + hi)) {
    ((function(middle) > 0.0) == rises ? hi : lo) = middle;
  }
  return 0.5 * (lo + hi);
}

double in_one_turn(double angle) {
  const double turned = std::fmod(angle, 2.0 * pi);
  return turned < 0.0 ? turned + 2.0 * pi : turned;
}

// u'(tau) of u'' + 2 zeta u' + u = 0, u(0) = -(1 + G), u'(0) = -r H: what friction of unit force adds to the
// velocity in the half cycle after a maximum.
double friction_velocity(const DenHartogFunctions& d, double r, double zeta, double tau) {
  const FreeMotion e = free_motion(zeta, tau);
  return -(1.0 + d.G) * e.e21 - r * d.H * e.e22;
}

// S = sup over 0 < tau < th of [u'(tau)/r + H cos(r tau)] / sin(r tau). Both ends have the limit
// (1 + G + 2 zeta r H) / r^2.
double half_cycle_supremum(const DenHartogFunctions& d, double r, double zeta) {
  const double th = pi / r;
  const double at_ends = (1.0 + d.G + 2.0 * zeta * r * d.H) / (r * r);
  const auto ratio = [&](double tau) {
    const double s = std::sin(r * tau);
    if (tau < 1e-6 * th || tau > (1.0 - 1e-6) * th) return at_ends;  // 0/0 to within rounding
    return (friction_velocity(d, r, zeta, tau) / r + d.H * std::cos(r * tau)) / s;
  };
  return supremum(ratio, 0.0, th, samples_over(th, 1.0 + r));
}

}  // namespace

FreeMotion free_motion(double zeta, double tau) {
  // e12 = e^{-zeta tau} sin(s tau)/s = (e^{a tau} - e^{b tau}) / (a - b) with a, b = -zeta +- i s
  const Complex is = Complex(0.0, 1.0) * damped_rate(zeta);
  const Complex a = -zeta + is, b = -zeta - is;
  const double e12 = exponential_difference(a, b, tau).real();
  // e^{-zeta tau} cos(s tau)
  const double cosine = 0.5 * (std::exp(a * tau) + std::exp(b * tau)).real();
  return {cosine + zeta * e12, e12, -e12, cosine - zeta * e12};
}

std::complex<double> forced_from_rest(double r, double zeta, double tau) {
  // The second divided difference of e^{z tau} at i r, a, b = -zeta +- i s.
  const Complex is = Complex(0.0, 1.0) * damped_rate(zeta), ir(0.0, r);
  const Complex a = -zeta + is, b = -zeta - is;
  return (exponential_difference(ir, a, tau) - exponential_difference(a, b, tau)) / (ir - b);
}

DenHartogFunctions den_hartog_functions(double r, double zeta) {
  const double th = pi / r;
  const Complex s = damped_rate(zeta);
  const Complex half = 0.5 * th * s;
  // Numerators and denominator are all multiplied by e^{-zeta th}, lest cosh overflow.
  const double decay = std::exp(-zeta * th);
  const Complex shift(-0.5 * zeta * th, 0.0), i_half = Complex(0.0, 1.0) * half;
  // e^{-zeta th / 2} cos(s th / 2), and sin(s th / 2) / s likewise
  const double cosine = 0.5 * (std::exp(shift + i_half) + std::exp(shift - i_half)).real();
  const double sine =
      exponential_difference(-zeta + Complex(0.0, 1.0) * s, -zeta - Complex(0.0, 1.0) * s, 0.5 * th).real();
  // Dn = cosh(zeta th) + cos(s th) = 2 sinh^2(zeta th / 2) + 2 cos^2(s th / 2)
  const double rise = -std::expm1(-zeta * th);  // 1 - e^{-zeta th}
  const double Dn = 0.5 * rise * rise + 2.0 * cosine * cosine;
  const double sine_over_s = 2.0 * sine * cosine;  // e^{-zeta th} sin(s th) / s
  const double sinh = 0.5 * rise * (1.0 + decay);

  DenHartogFunctions result{};
  result.V = 1.0 / std::hypot((1.0 - r) * (1.0 + r), 2.0 * zeta * r);
  result.G = (sinh - zeta * sine_over_s) / Dn;
  result.H = sine_over_s / (r * Dn);
  return result;
}

double critical_friction(double r, double zeta) {
  const DenHartogFunctions d = den_hartog_functions(r, zeta);
  return d.V / std::hypot(d.H, half_cycle_supremum(d, r, zeta));
}

ClosedForm non_stop_response(double r, double zeta, double f) {
  if (!(f <= critical_friction(r, zeta))) return {kNone, kNone};
  const auto [V, G, H] = den_hartog_functions(r, zeta);
  // X = sqrt(V^2 - H^2 f^2) - G f
  const double root = std::sqrt((V - H * f) * (V + H * f));
  // lag = atan2(2 zeta r, 1 - r^2) - atan2(H f, sqrt(V^2 - H^2 f^2))
  const double lag = std::atan2(2.0 * zeta * r, (1.0 - r) * (1.0 + r)) - std::atan2(H * f, root);
  return {root - G * f, in_one_turn(lag)};
}

namespace {

// A slide of length Ts from rest at X, released at phase psi with cos psi = X - f. Its velocity is
//   x' = Re(i r e^{i psi} y(tau)),  y = forced_from_rest,
// so that x'(Ts) = 0 fixes psi = -arg y(Ts) within (0, pi), and x(Ts) = -X then reads
//   2 f = -[cos psi (1 + e11) + Re(e^{i psi} y)].
struct Slide {
  double psi, friction;
};
Slide slide_of_length(double r, double zeta, double Ts) {
  const Complex y = forced_from_rest(r, zeta, Ts);
  double psi = -std::arg(y);
  if (psi < 0.0) psi += pi;
  const double e11 = free_motion(zeta, Ts).e11;
  return {psi, -0.5 * (std::cos(psi) * (1.0 + e11) + (std::polar(1.0, psi) * y).real())};
}

// Whether the mass keeps moving one way during the slide, and friction holds it during the rest that follows.
bool is_one_stop(double r, double zeta, double f, double X, double Ts, double psi) {
  constexpr double kRounding = 1e-11;
  const double stop_phase = psi + r * Ts, release_phase = psi + pi;
  if (!(X > 0.0 && stop_phase < release_phase + kRounding)) return false;
  // At rest at -X friction must balance cos(phase) + X, which reaches f at the release.
  const double least = stop_phase <= pi ? -1.0 : std::cos(stop_phase);
  if (least + X < -f - kRounding || std::cos(stop_phase) + X > f + kRounding) return false;
  const auto velocity_over_sine = [&](double tau) {
    // x' < 0 within the slide; the division takes out its zeros at both ends (t^2 and t - Ts).
    const double ends =
        std::sin(0.5 * pi * tau / Ts) * std::sin(0.5 * pi * tau / Ts) * std::cos(0.5 * pi * tau / Ts);
    if (tau < 1e-3 * Ts || tau > (1.0 - 1e-6) * Ts) return -1.0;
    return (Complex(0.0, r) * std::polar(1.0, psi) * forced_from_rest(r, zeta, tau)).real() / ends;
  };
  return supremum(velocity_over_sine, 0.0, Ts, samples_over(Ts, 1.0 + r)) < 0.0;
}

}  // namespace

OneStop one_stop_response(double r, double zeta, double f) {
  const double th = pi / r;
  const int samples = samples_over(th, 1.0 + r);
  const auto excess = [&](double Ts) { return slide_of_length(r, zeta, Ts).friction - f; };
  // Longer slides come first: the shorter roots are those whose velocity has already turned once.
  double longer = th, at_longer = excess(longer);
  constexpr double kShortest = 1e-5;  // of th: slides at f = 1 - 1e-9 are that short
  for (int i = samples - 1; i >= 0; --i) {
    const double shorter = th * std::max(kShortest, static_cast<double>(i) / samples),
                 at_shorter = excess(shorter);
    if (at_longer * at_shorter <= 0.0) {
      const double Ts = bisect(excess, shorter, longer);
      const double psi = slide_of_length(r, zeta, Ts).psi, X = f + std::cos(psi);
      const bool is_root = std::abs(excess(Ts)) < 1e-9;  // not a jump of psi by pi
      if (is_root && is_one_stop(r, zeta, f, X, Ts, psi)) return {X, Ts};
    }
    longer = shorter;
    at_longer = at_shorter;
  }
  return {kNone, kNone};
}

double classical_amplitude(double r, double zeta, double f) {
  if (f >= 1.0) return 0.0;
  const ClosedForm without_stop = non_stop_response(r, zeta, f);
  return without_stop.valid() ? without_stop.amplitude : one_stop_response(r, zeta, f).amplitude;
}

std::array<std::complex<double>, 2> non_stop_multipliers(double r, double zeta, double f) {
  const ClosedForm response = non_stop_response(r, zeta, f);
  const double X = response.amplitude, drive = std::cos(response.peak_lag);
  // Squares of the eigenvalues of diag(1, rho) E(pi/r), rho = (X - cos phi - f) / (X - cos phi + f)
  const double rho = (X - drive - f) / (X - drive + f);
  const FreeMotion e = free_motion(zeta, pi / r);
  const Complex half_trace = 0.5 * (e.e11 + rho * e.e22);
  const double determinant = rho * (e.e11 * e.e22 - e.e12 * e.e21);
  const Complex root = std::sqrt(half_trace * half_trace - determinant);
  const Complex first = half_trace + root, second = half_trace - root;
  return {first * first, second * second};
}

std::array<std::complex<double>, 2> one_stop_multipliers(double r, double zeta, double f) {
  const OneStop response = one_stop_response(r, zeta, f);
  if (!response.valid()) return {Complex(kNone), Complex(kNone)};
  const double e11 = free_motion(zeta, response.sliding_time).e11;
  return {Complex(e11 * e11), Complex(0.0)};
}

double hundal_amplitude(double r, double zeta, double f) {
  // The force is k y + c y', of amplitude k Y g with g = sqrt(1 + (2 zeta r)^2).
  const double g = std::hypot(1.0, 2.0 * zeta * r);
  return g * classical_amplitude(r, zeta, f / g);
}

double levitan_amplitude(double r, double zeta, double f) {
  // The relative motion is driven by -m y'', of amplitude k Y r^2.
  return r * r * classical_amplitude(r, zeta, f / (r * r));
}

TwoFrequencyResponse two_frequency_response(const TwoFrequencies& system) {
  const int M = system.M, N = system.N;
  const double zeta = system.zeta, f = system.f;
  const double base = system.r1 / M, th = pi / base;
  const DenHartogFunctions d = den_hartog_functions(base, zeta);
  const auto transfer = [&](int order) {
    const double r = order * base;
    return 1.0 / Complex((1.0 - r) * (1.0 + r), 2.0 * zeta * r);
  };
  const Complex first = transfer(M), second = system.p2 * std::polar(1.0, system.phase) * transfer(N);
  const auto turned = [&](Complex amplitude, int order, double t) {
    return amplitude * std::polar(1.0, order * base * t);
  };
  const auto linear = [&](double t) { return (turned(first, M, t) + turned(second, N, t)).real(); };
  const auto linear_velocity = [&](double t) {
    return (Complex(0.0, M * base) * turned(first, M, t) + Complex(0.0, N * base) * turned(second, N, t))
        .real();
  };
  // t_m from x_p'(t_m) = r_base H f; x' < 0 in the half period that follows; X = x_p(t_m) - G f
  const auto excess = [&](double t) { return linear_velocity(t) - base * d.H * f; };
  const double rate = base * std::max(M, N);
  const int samples = samples_over(2.0 * th, 1.0 + rate);
  for (int i = 0; i < samples; ++i) {
    const double lo = 2.0 * th * i / samples, hi = 2.0 * th * (i + 1) / samples;
    if (!(excess(lo) > 0.0 && excess(hi) <= 0.0)) continue;
    const double t_m = bisect(excess, lo, hi);
    const auto velocity_over_sine = [&](double tau) {
      const double sine = std::sin(pi * std::clamp(tau / th, 1e-4, 1.0 - 1e-4));
      const double at = std::clamp(tau, 1e-4 * th, (1.0 - 1e-4) * th);
      return (linear_velocity(t_m + at) + f * friction_velocity(d, base, zeta, at)) / sine;
    };
    if (supremum(velocity_over_sine, 0.0, th, samples_over(th, 1.0 + rate)) > 0.0) continue;
    return {linear(t_m) - d.G * f, in_one_turn(base * t_m)};
  }
  return {kNone, kNone};
}

}  // namespace frahm::periodic
