#pragma once

#include "solvers/nonstop/stability.hpp"

// One mass that stops once in each half of the period, or never moves, under one harmonic. It rests at -u, is
// released at the phase p where the force on it has grown to F, slides for theta to +u, and rests there until
// p + pi, when all repeats with the opposite sign. At the release velocity and acceleration are zero, so the
// transient there is linear in the harmonic's amplitude; so is then the velocity at the end, Re(G(theta)
// e^{ip}) = 0, which gives p. One equation is left, in theta: that it ends as far on the one side as it began
// on the other.
namespace {

// Two real modal coordinates, real and imaginary part of a pair or those of two real modes, as factors of a
// form.
struct Row {
  Lanes first, second;
};
template <class W>
FRAHM_INLINE Row row_of(const W& w, const Complex* factor) {
  if (w.modes == 1) return {factor[0].re, -factor[0].im};
  return {factor[0].re, factor[1].re};
}

struct OneStop {
  Mask found;
  Lanes theta, release;  // [rad]
  Lanes rest;            // u [m]
  Lanes missed;          // by which it ends elsewhere [m]
  Lanes iterations;
  Row start;       // modal coordinates at the release
  Row unit;        // those of a unit of displacement at rest
  Complex drive;   // amplitude of the acceleration that the forcing gives the mass at rest, by the phase
  Lanes spring;    // K / M / omega: of that which its spring gives
  Lanes friction;  // A_F: of that which friction gives
};

// What a slide leaves of each mode, and turns the harmonic by.
struct Slide {
  Complex left[2], turned;
};
template <class W>
FRAHM_INLINE Slide slide_of(const W& w, Lanes theta) {
  Slide slide;
  for (int s = 0; s < w.modes; ++s) slide.left[s] = exponential({theta * w.rate[s].re, theta * w.rate[s].im});
  slide.turned = turn(theta);
  return slide;
}

// What varies with theta: G and K, whose parts across G give the equation, and their derivatives.
struct StopEquation {
  Complex G, dG, K, dK;
};

template <class W>
struct StopProblem {
  Complex V, Q;           // harmonic velocity and displacement
  Complex first, second;  // modal coordinates at the release, Re(. e^{ip})
  Complex jerk;           // of the velocity's second derivative there
  Row displacement;       // factors of the displacement
  Lanes level;            // its part under friction

  explicit StopProblem(const W& w) : V(w.phasor[0]), Q(w.phasor[1]), level(w.constant[1] + w.friction[1]) {
    const Row v = row_of(w, complex_view(w.pack.form_modal)), a = row_of(w, w.slope_modal);
    displacement = row_of(w, complex_view(w.pack.form_modal) + w.modes);
    // v . coordinates = -V, a . coordinates = -i V
    const Lanes inverse = 1.0 / (v.first * a.second - v.second * a.first);
    const Complex iV = {-V.im, V.re};
    first = inverse * (v.second * iV - a.second * V);
    second = inverse * (a.first * V - v.first * iV);
    Complex bent[2];
    for (int s = 0; s < w.modes; ++s) bent[s] = w.slope_modal[s] * w.rate[s];
    const Row b = row_of(w, bent);
    jerk = b.first * first + b.second * second - V;
  }

  StopEquation at(const W& w, const Slide& slide) const {
    Complex velocity[2], slope[2], shift[2];
    for (int s = 0; s < w.modes; ++s) {
      velocity[s] = load(w.pack.form_modal, s) * slide.left[s];
      slope[s] = w.slope_modal[s] * slide.left[s];
      shift[s] = load(w.pack.form_modal, w.modes + s) * slide.left[s];
    }
    const Complex turned = slide.turned, next = {-turned.im, turned.re};
    const Row v = row_of(w, velocity), a = row_of(w, slope), u = row_of(w, shift);
    const Lanes per_omega = 1.0 / *view(w.pack.omega);
    StopEquation e;
    e.G = V * turned + v.first * first + v.second * second;
    e.dG = V * next + a.first * first + a.second * second;
    e.K = Q * turned + Q + (u.first + displacement.first) * first + (u.second + displacement.second) * second;
    e.dK = per_omega * e.G;  // the slope of a displacement is the velocity
    return e;
  }

  // e^{ip}, across G, to the side on which the velocity grows.
  Complex release_at(const StopEquation& e) const {
    const Lanes inverse = 1.0 / max(modulus(e.G), lanes(1e-300));
    const Complex across = {inverse * e.G.im, inverse * e.G.re};  // i conj(G) / |G|
    return select(real_part(jerk, across) < 0.0, Complex{-across.re, -across.im}, across);
  }

  // Re(K e^{ip}) + 2 level, the distance by which the slide ends beyond the other side.
  Lanes missed(const StopEquation& e) const { return real_part(e.K, release_at(e)) + 2.0 * level; }
  // Its slope by theta. Re(G e^{ip}) = 0 turns p by dp = -Re(dG e^{ip}) / Re(i G e^{ip}).
  Lanes slope(const StopEquation& e) const {
    const Complex u = release_at(e);
    const Lanes dp = real_part(e.dG, u) / (e.G * u).im;
    return real_part(e.dK, u) - dp * (e.K * u).im;
  }
};

// The mass at rest: what forcing, spring and friction would accelerate it by.
template <class W>
inline OneStop hold_mass(const W& w) {
  OneStop stop{};
  const Row u = row_of(w, complex_view(w.pack.form_modal) + w.modes),
            v = row_of(w, complex_view(w.pack.form_modal));
  const Lanes inverse = 1.0 / (u.first * v.second - u.second * v.first);
  stop.unit = {inverse * v.second, -inverse * v.first};
  // lambda^2 + (C/M) lambda + K/M has the modes as roots.
  const Lanes omega = *view(w.pack.omega);
  const Complex one = w.rate[0], other = w.modes == 1 ? conjugate(one) : w.rate[w.modes - 1];
  const Lanes damping = -(one.re + other.re);   // C/M/omega
  stop.spring = omega * real_part(one, other);  // K/M/omega
  const Complex V = w.phasor[0];
  stop.drive = Complex{-V.im, V.re} + stop.spring * w.phasor[1] + damping * V;
  stop.friction = -(stop.spring * w.friction[1]);  // F moves the rest position by F/K
  stop.rest = stop.theta = stop.release = stop.missed = stop.iterations = lanes(0.0);
  return stop;
}

// Intervals of the grid on which the length of the slide is sought, at first and where that did not serve.
constexpr int kCoarseGrid = 12, kFineGrid = 48;

// A slide that serves: between two places of a grid the distance missed changes its sign, and at those before
// the velocity is positive; the longest of them.
struct Bracket {
  Mask found;
  Lanes low, high, theta;
};
template <class W>
inline Bracket bracket_slide(const W& w, const StopProblem<W>& problem, Mask group, int intervals) {
  constexpr double kRough = 0.05;  // a sign is that at the end of an interval, not yet at the root
  StopEquation grid[kFineGrid + 1];
  const auto place = [&](int i) { return i == intervals ? kPi : kPi * (i + 0.3) / intervals; };
  Slide slide = slide_of(w, lanes(place(0)));
  const Slide onwards = slide_of(w, lanes(kPi / intervals));
  for (int i = 0; i < intervals; ++i) {
    grid[i] = problem.at(w, slide);
    for (int s = 0; s < w.modes; ++s) slide.left[s] = slide.left[s] * onwards.left[s];
    slide.turned = slide.turned * onwards.turned;
  }
  grid[intervals] = problem.at(w, slide_of(w, lanes(kPi)));
  Bracket bracket{none(), lanes(0.0), lanes(0.0), lanes(0.0)};
  Lanes here, after = problem.missed(grid[intervals]);
  for (int i = intervals - 1; i >= 0; --i, after = here) {
    here = problem.missed(grid[i]);
    const Mask changes = ((here > 0.0) & ~(after > 0.0)) | (~(here > 0.0) & (after > 0.0));
    Mask serves = group & ~bracket.found & changes;
    if (!any(serves)) continue;
    const Complex u = problem.release_at(grid[i]);
    for (int before = 0; before < i; ++before)
      serves = serves & (real_part(grid[before].G, u) > -kRough * modulus(grid[before].G));
    bracket.low = select(serves, lanes(place(i)), bracket.low);
    bracket.high = select(serves, lanes(place(i + 1)), bracket.high);
    const Lanes secant = place(i) + (place(i + 1) - place(i)) * (here / (here - after));
    bracket.theta = select(serves, secant, bracket.theta);
    bracket.found = bracket.found | serves;
  }
  return bracket;
}

// By Newton's method within the bracket.
template <class W>
inline OneStop find_one_stop(const W& w, OneStop stop, Mask group, int intervals) {
  constexpr int kMostIterations = 16;
  constexpr double kSmall = 1e-11;  // of a step [rad]: the rest position is the difference of larger numbers
  const StopProblem<W> problem(w);
  const Bracket bracket = bracket_slide(w, problem, group, intervals);
  Lanes theta = bracket.theta;
  Mask going = bracket.found;
  stop.iterations = lanes(0.0);
  for (int i = 0; i < kMostIterations && any(going); ++i) {
    const StopEquation e = problem.at(w, slide_of(w, theta));
    const Lanes step = problem.missed(e) / problem.slope(e);
    theta = select(going, max(min(theta - step, bracket.high), bracket.low), theta);
    stop.iterations = select(going, stop.iterations + 1.0, stop.iterations);
    going = going & ~(abs(step) < lanes(kSmall));
  }
  stop.found = bracket.found & ~going;
  stop.theta = theta;

  const StopEquation e = problem.at(w, slide_of(w, theta));
  const Complex u = problem.release_at(e);
  stop.missed = problem.missed(e);
  // The angle of u: a rough one, and the sine of what it lacks.
  const Lanes rough = rough_angle(u);
  const Lanes lack = (u * conjugate(turn(rough))).im;
  stop.release = rough + lack * (1.0 + (1.0 / 6.0) * (lack * lack));
  stop.start = {real_part(problem.first, u), real_part(problem.second, u)};
  const Row d = problem.displacement;
  stop.rest =
      -(real_part(problem.Q, u) + d.first * stop.start.first + d.second * stop.start.second + problem.level);
  return stop;
}

template <class W>
FRAHM_INLINE void set_coordinates(const W& w, const Row& row, Complex* zeta) {
  if (w.modes == 1) {
    zeta[0] = {row.first, row.second};
    return;
  }
  zeta[0] = {row.first, lanes(0.0)};
  zeta[w.modes - 1] = {row.second, lanes(0.0)};
}

FRAHM_INLINE Lanes without_rounding(Lanes difference, Lanes size) {
  return select(abs(difference) > 1e-13 * size, difference, 0.0);
}

// Forms at rest: the state is held at u and the contact carries F (1 + (a + ...)) as the forcing asks, a
// harmonic.
template <class W>
inline void set_rest_forms(W& w, const OneStop& stop) {
  const Lanes per_friction = 1.0 / stop.friction;
  for (int form = 1; form < w.shape.forms(); ++form) {
    const Row c = row_of(w, complex_view(w.pack.form_modal) + form * w.modes);
    const Lanes one = c.first * stop.unit.first, other = c.second * stop.unit.second;
    const Lanes of_rest = without_rounding(one + other, abs(one) + abs(other));
    // What cancels but for rounding is nothing: a mass at rest has no velocity.
    const Lanes by_rest = of_rest * w.friction[1];
    const Lanes of_friction =
        without_rounding(w.friction[form] - by_rest, abs(w.friction[form]) + abs(by_rest));
    const Complex by_friction = (of_friction * per_friction) * stop.drive, direct = w.direct[form];
    const Lanes size = size_of(by_friction) + size_of(direct);
    const Complex X = {without_rounding(by_friction.re + direct.re, size),
                       without_rounding(by_friction.im + direct.im, size)};
    w.rest_phasor[form] = X;
    if (form < w.shape.first_integrated()) w.rest_slope[form] = {-X.im, X.re};
    w.level[form] =
        w.constant[form] + of_rest * stop.rest - of_friction * per_friction * stop.spring * stop.rest;
  }
}

// One step of a stretch: measures it, and goes on.
template <class W>
inline void take_step(W& w, Mask taken, Lanes phase, Lanes h) {
  keep_step(w, taken, phase, h);
  if (w.shape.integrated > 0) integrate_step(w, select(taken, h, 0.0));
  for (int s = 0; s < w.modes; ++s) w.zeta[s] = select(taken, w.next_zeta[s], w.zeta[s]);
  w.osc[0] = select(taken, w.next_osc[0], w.osc[0]);
}

// The slide: the velocity stays positive between two zeros.
template <class W>
inline void pass_slide(W& w, const OneStop& stop, double steps_a_radian, Passage& passage) {
  w.direction[0] = lanes(1.0);
  set_levels(w);
  w.rests = false;
  w.is_released = true;
  set_coordinates(w, stop.start, w.zeta);
  w.osc[0] = turn(stop.release);
  const Lanes count = max(floor(stop.theta * fastest_rate(w) * steps_a_radian) + 1.0, lanes(2.0));
  const int most = most_steps(1) / 2;
  passage.proved = passage.proved & (count < lanes(most));
  const Lanes h = stop.theta / count;
  set_factors(w, h);
  const Lanes error = fourth_derivative(w, 0) * ((h * h) * (h * h)) * (1.0 / 144.0);
  const int steps = steps_of(passage.proved, count);
  w.v0[0] = w.a0[0] = lanes(0.0);
  for (int k = 0; k < steps; ++k) {
    const Mask taken = count > lanes(k), ends = taken & ~(count > lanes(k + 1.0));
    w.next_zeta[0] = w.zeta[0] * w.step_factor[0];
    if (w.modes == 2) w.next_zeta[1] = w.zeta[1] * w.step_factor[1];
    w.next_osc[0] = w.osc[0] * w.osc_factor[0];
    const Lanes v = value(w, 0, w.next_zeta, w.next_osc), a = slope(w, 0, w.next_zeta, w.next_osc);
    Lanes least = least_coefficient(w.v0[0], w.a0[0], select(ends, lanes(0.0), v), a, h, error, none(), ends);
    if (k == 0) {  // velocity and acceleration begin from zero: c0 = c1 = 0
      const Lanes end = select(ends, lanes(0.0), v), b2 = end - a * h * (1.0 / 3.0);
      least = min(0.5 * b2 - error, 0.75 * b2 + 0.25 * end);
      least = select(ends, least, min(least, v));
    }
    passage.between = select(taken, min(passage.between, least * w.per_speed[0]), passage.between);
    passage.at_reversals =
        select(ends, min(passage.at_reversals, -(a * w.per_speed[0])), passage.at_reversals);
    w.v0[0] = select(taken, v, w.v0[0]);
    w.a0[0] = select(taken, a, w.a0[0]);
    take_step(w, taken, stop.release + h * k, h);
  }
}

// The rest: the force that the mass asks of the contact stays within its limit, until it reaches it at the
// end.
template <class W>
inline void pass_rest(W& w, const OneStop& stop, double steps_a_radian, Passage& passage) {
  const Lanes length = kPi - stop.theta, start = stop.release + stop.theta;
  const Lanes count = max(floor(length * steps_a_radian) + 1.0, lanes(2.0)), h = length / count;
  set_rest_forms(w, stop);
  w.rests = true;
  w.is_released = false;
  for (int s = 0; s < w.modes; ++s) w.zeta[s] = {lanes(0.0), lanes(0.0)};
  w.osc[0] = turn(start);
  set_factors(w, h);
  const Lanes scale = 1.0 / (modulus(stop.drive) + stop.friction);
  const Lanes error = modulus(stop.drive) * ((h * h) * (h * h)) * (1.0 / 144.0);
  const Lanes held = -(stop.spring * stop.rest);
  const auto pull = [&](Complex u) { return real_part(stop.drive, u) + held; };
  const auto rate = [&](Complex u) { return -(stop.drive * u).im; };
  const int steps = steps_of(passage.proved, count);
  for (int k = 0; k < steps; ++k) {
    const Mask taken = count > lanes(k), ends = taken & ~(count > lanes(k + 1.0));
    for (int s = 0; s < w.modes; ++s) w.next_zeta[s] = w.zeta[s];
    w.next_osc[0] = w.osc[0] * w.osc_factor[0];
    const Lanes p0 = pull(w.osc[0]), p1 = pull(w.next_osc[0]), d0 = rate(w.osc[0]), d1 = rate(w.next_osc[0]);
    // Room to either limit.
    const Lanes ahead =
        least_coefficient(stop.friction - p0, -d0, stop.friction - p1, -d1, h, error, none(), none());
    const Lanes behind = least_coefficient(
        stop.friction + p0, d0, select(ends, lanes(0.0), stop.friction + p1), d1, h, error, none(), ends);
    passage.between = select(taken, min(passage.between, min(ahead, behind) * scale), passage.between);
    take_step(w, taken, start + h * k, h);
  }
}

// Nothing moves: the forcing stays below the limit by itself, or just reaches it, where a tie goes to
// sticking. In the lanes where it does.
template <class W>
inline Passage passage_stuck(W& w, const OneStop& held, Mask group) {
  constexpr double kTie = 1e-12;  // as events/tolerances.hpp has it
  const Lanes room = (held.friction - modulus(held.drive)) / held.friction;
  const Mask holds = group & ((room > kSafe) | (abs(room) < lanes(kTie)));
  Passage passage{holds, lanes(1.0), room, lanes(0.0), lanes(0.0)};
  clear_measures(w);
  if (any(holds)) pass_rest(w, held, 1.0 / 0.75, passage);
  search_segment(w, holds);
  passage.between = room;
  passage.proved = holds;
  return passage;
}

template <class W>
inline Passage passage_with_one_stop(W& w, const OneStop& stop, double fineness) {
  constexpr double kClosed = 1e-9;
  const double steps_a_radian = fineness / 0.75;
  Passage passage{stop.found, lanes(1.0), lanes(1.0), lanes(0.0), lanes(0.0)};
  passage.proved = passage.proved & (stop.theta > 1e-3) & (lanes(kPi) - stop.theta > 1e-6) &
                   (stop.rest > 0.0) & (abs(stop.missed) < kClosed * stop.rest);
  clear_measures(w);
  pass_slide(w, stop, steps_a_radian, passage);
  search_segment(w, passage.stands());
  if (any(passage.proved)) pass_rest(w, stop, steps_a_radian, passage);
  search_segment(w, passage.stands());
  w.slid[0] = 2.0 * stop.rest;
  w.contact_reversals[0] = lanes(1.0);
  passage.parts = w.harmonic_size[0];
  for (int s = 0; s < w.modes; ++s)
    passage.parts += view(w.pack.mode_norm)[s] * (abs(stop.start.first) + abs(stop.start.second));
  passage.residual = abs(stop.missed) * norm_of_coordinates(w, [&](int i) {
                       return i == 0 ? stop.unit.first : stop.unit.second;
                     });
  passage.proved = passage.stands();
  return passage;
}

// Norm of the state and multiplier amid the rest: a shift of the position there grows by what the slide
// leaves of it.
template <class W>
inline void judge_one_stop(W& w, const OneStop& stop, Mask mask) {
  const auto tell = [&](double* array, Lanes x) { *view(array) = select(mask, x, *view(array)); };
  Complex zeta[2], left[2];
  set_coordinates(w, stop.unit, zeta);
  for (int s = 0; s < w.modes; ++s)
    left[s] = zeta[s] * exponential({stop.theta * w.rate[s].re, stop.theta * w.rate[s].im});
  const Lanes slid = abs(real_sum(w.modes, complex_view(w.pack.form_modal) + w.modes, left));
  const Lanes grows = select(stop.theta > 0.0, slid, 0.0);  // of what can move
  tell(w.pack.contraction, grows);
  tell(w.pack.multiplier, grows * grows);
  tell(w.pack.state_norm, stop.rest * norm_of_coordinates(w, [&](int i) {
                            return i == 0 ? stop.unit.first : stop.unit.second;
                          }));
}

}  // namespace
