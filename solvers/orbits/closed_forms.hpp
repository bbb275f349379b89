#pragma once

#include <array>
#include <complex>
#include <functional>

// Closed forms of classical systems with Coulomb friction, against which the general path is checked.
//
// One mass on a spring and a damper, with friction to ground, under a harmonic force, dimensionless:
//
//   x'' + 2 zeta x' + x + f Sgn(x') = cos(r tau),     tau = omega_n t,  x in P/k,  r = omega/omega_n,  f =
//   F/P
//
// Every function takes r > 0, zeta >= 0, f >= 0, all of unit 1; zeta may pass through 1. Where a closed form
// does not hold its result is NaN, never a plausible number. The only poles are those of the undamped system:
// zeta = 0 with r = 1 (V) and with r = 1, 1/3, 1/5, ... (H).
namespace frahm::periodic {

// Transitions of free motion x'' + 2 zeta x' + x = 0 over a time tau:
//   x(tau) = e11 x(0) + e12 x'(0),   x'(tau) = e21 x(0) + e22 x'(0).
struct FreeMotion {
  double e11, e12, e21, e22;
};
FreeMotion free_motion(double zeta, double tau);

// y(tau) with y'' + 2 zeta y' + y = e^{i r tau}, y(0) = y'(0) = 0. Finite at resonance and critical damping.
std::complex<double> forced_from_rest(double r, double zeta, double tau);

// Den Hartog's functions, th = pi/r, s = sqrt(1 - zeta^2), Dn = cosh(zeta th) + cos(s th):
struct DenHartogFunctions {
  double V;  // 1 / sqrt((1 - r^2)^2 + (2 zeta r)^2), the amplitude without friction
  double G;  // [sinh(zeta th) - (zeta/s) sin(s th)] / Dn
  double H;  // sin(s th) / (s r Dn)
};
DenHartogFunctions den_hartog_functions(double r, double zeta);

// The largest f without stops: V / sqrt(H^2 + S^2), S the supremum over a half cycle.
double critical_friction(double r, double zeta);

struct ClosedForm {
  double amplitude;  // max|x| [P/k]
  double peak_lag;   // phase lag of the maximum of x after that of the force, in [0, 2 pi)
  bool valid() const { return amplitude == amplitude; }
};

// No stop in a half cycle (J. P. Den Hartog, Trans. ASME 53 (1931) APM-107): f <= f_crit.
ClosedForm non_stop_response(double r, double zeta, double f);

// One stop in each half cycle: rest at X until phase acos(X - f), then a slide of length Ts to -X.
struct OneStop {
  double amplitude;     // X [P/k]
  double sliding_time;  // Ts, unit 1
  bool valid() const { return amplitude == amplitude; }
};
OneStop one_stop_response(double r, double zeta, double f);

// max|x| of the response without stops or with one stop a half cycle; 0 for f >= 1; otherwise NaN.
double classical_amplitude(double r, double zeta, double f);

// Floquet multipliers of a full period.
std::array<std::complex<double>, 2> non_stop_multipliers(double r, double zeta, double f);
std::array<std::complex<double>, 2> one_stop_multipliers(double r, double zeta, double f);

// The base moves by Y cos(omega t), friction between mass and ground, spring and damper between mass and
// base: max|x| / Y with f = F/(kY).  M. S. Hundal, J. Sound Vib. 64 (1979) 371.
double hundal_amplitude(double r, double zeta, double f);

// Friction, spring and damper all between mass and base: max|x - y| / Y with f = F/(kY).
// E. S. Levitan, J. Acoust. Soc. Am. 32 (1960) 1265.
double levitan_amplitude(double r, double zeta, double f);

// Two harmonics, x'' + 2 zeta x' + x + f Sgn(x') = cos(r1 tau) + p2 cos(r2 tau + phase), r1/r2 = M/N with M
// and N odd and coprime, two reversals and no stop in a common period. G. Cheng and J. W. Zu, J. Sound Vib.
// 275 (2004) 591.
struct TwoFrequencies {
  double r1;  // omega1/omega_n
  int M, N;
  double zeta;
  double f;      // F/P1
  double p2;     // P2/P1
  double phase;  // of the second harmonic [rad]
};
struct TwoFrequencyResponse {
  double amplitude;   // max|x| [P1/k]
  double peak_phase;  // (r1/M) tau of the maximum, in [0, 2 pi); Cheng and Zu's phi_1 is M times this
  bool valid() const { return amplitude == amplitude; }
};
TwoFrequencyResponse two_frequency_response(const TwoFrequencies& system);

}  // namespace frahm::periodic
