#pragma once

// The kernel, included by one source for each instruction set, which defines FRAHM_KERNEL as its name.
#include "solvers/nonstop/one_stop.hpp"

namespace {

// The results of the lanes told.
template <class W>
inline void tell(const W& w, const Passage& passage, Mask mask) {
  const double omega_spans = w.shape.half_period ? 2.0 : 1.0;
  const Lanes seconds = omega_spans / *view(w.pack.omega);
  const auto tell_one = [&](double* array, int i, Lanes x) {
    view(array)[i] = select(mask, x, view(array)[i]);
  };
  tell_one(w.pack.newton_iterations, 0, w.iterations);
  tell_one(w.pack.reversals, 0, lanes(w.reversals));
  // Reversals keep their order while they move by less than lies between them.
  tell_one(w.pack.margin, 0, min(min(passage.at_reversals, passage.between), passage.shortest));
  tell_one(w.pack.residual, 0, passage.residual);
  for (int p = 0; p < w.shape.products; ++p) tell_one(w.pack.integral, p, seconds * w.integral[p]);
  for (int p = 0; p < w.shape.powers; ++p) {
    tell_one(w.pack.work, p, seconds * w.work[p]);
    tell_one(w.pack.work_size, p, seconds * w.work_size[p]);
  }
  for (int j = 0; j < w.contacts; ++j) {
    tell_one(w.pack.slid, j, omega_spans * w.slid[j]);
    tell_one(w.pack.contact_reversals, j, omega_spans * w.contact_reversals[j]);
  }
  tell_one(w.pack.parts, 0, passage.parts);
  tell_extremes(w, mask);
  Lanes sound = lanes(0.0);  // not a number, if anything told is none
  for (int p = 0; p < w.shape.products; ++p) sound += 0.0 * view(w.pack.integral)[p];
  for (int p = 0; p < w.shape.powers; ++p) sound += 0.0 * view(w.pack.work)[p];
  for (int t = 0; t < w.shape.traces; ++t) sound += 0.0 * (view(w.pack.most)[t] + view(w.pack.least)[t]);
  *view(w.pack.is_found) = select(mask & ~w.unsure & (sound == 0.0), lanes(1.0), *view(w.pack.is_found));
}

// Lanes whose proof failed by so little that its steps may be to blame.
inline Mask is_close(const Passage& passage) {
  return passage.may_hold() & ~(passage.between > kSafe);
}

template <class W>
inline void solve_group(W& w, Mask group) {
  constexpr double kFine = 4.0;
  sort_reversals(w);
  Passage passage = passage_along(w, group, 1.0);
  Mask again = group & ~passage.proved & is_close(passage);
  for (int trial = 0; trial < 2; ++trial) {
    if (any(passage.proved)) {
      tell(w, passage, passage.proved);
      if (w.shape.is_judged) judge(w, passage.proved);
    }
    if (trial == 1 || !any(again)) return;
    passage = passage_along(w, again, kFine);
  }
}

template <class W>
inline void solve_with_stops(W& w, Mask group) {
  constexpr double kFine = 4.0;
  if (!any(group)) return;
  const OneStop held = hold_mass(w);
  w.iterations = lanes(0.0);
  w.reversals = 0;
  const auto finish = [&](const Passage& passage, const OneStop& stop) {
    if (!any(passage.proved)) return;
    tell(w, passage, passage.proved);
    *view(w.pack.slides) = select(passage.proved, stop.theta * (1.0 / kPi), *view(w.pack.slides));
    if (w.shape.is_judged) judge_one_stop(w, stop, passage.proved);
  };
  const Passage at_rest = passage_stuck(w, held, group);
  finish(at_rest, held);
  group = group & ~at_rest.proved;
  for (const int intervals : {kCoarseGrid, kFineGrid}) {
    const OneStop stop = find_one_stop(w, held, group, intervals);
    if (!any(stop.found)) continue;
    w.iterations = stop.iterations;
    w.reversals = 2;  // a stop and a release
    Mask sought = stop.found;
    for (const double fineness : {1.0, kFine}) {
      Passage passage = passage_with_one_stop(w, stop, fineness);
      passage.proved = passage.proved & sought;
      finish(passage, stop);
      group = group & ~passage.proved;
      sought = sought & ~passage.proved & is_close(passage);
      if (!any(sought)) break;
    }
    if (!any(group)) return;
  }
}

template <class C>
void solve(const Pack& pack, double* workspace) {
  Arena arena(workspace);
  Work<C> w(pack, arena);
  *view(pack.is_found) = lanes(0.0);
  *view(pack.slides) = lanes(1.0);
  Mask left = set_rates(w);
  const Mask usable = left;
  respond_to_forcing(w);
  find_phasors(w);
  find_jumps(w);
  guess_reversals(w);
  // Lanes with reversals alike go together.
  for (int lane = 0; lane < kLanes && any(left); ++lane) {
    Lanes is_left = select(left, lanes(1.0), 0.0);
    if (at(is_left, lane) == 0.0) continue;
    const Mask group = lay_out_like(w, lane, left);
    Lanes one = lanes(0.0);
    at(one, lane) = 1.0;
    left = left & ~group & ~(one > 0.0);
    const Mask found = find_reversals(w, group);
    if (any(found)) solve_group(w, found);
  }
  if (w.shape.may_stop_once)
    solve_with_stops(w, usable & ~(*view(pack.is_found) > 0.5) & (*view(pack.limit) > 0.0));
}

// The sizes that most maps have are compiled apart, in the sets that most processors run; the operations, and
// so the bytes, are the same.
void solve_by_size(const Pack& pack, double* workspace) {
#if defined(__AVX2__)
  const Shape& shape = *pack.shape;
  if (Counts<1, 1, 1>::fit(shape)) return solve<Counts<1, 1, 1>>(pack, workspace);
  if (Counts<2, 1, 1>::fit(shape)) return solve<Counts<2, 1, 1>>(pack, workspace);
  if (Counts<2, 1, 2>::fit(shape)) return solve<Counts<2, 1, 2>>(pack, workspace);
#endif
  solve<AnyCounts>(pack, workspace);
}

}  // namespace

namespace frahm::periodic::nonstop {

#define FRAHM_JOINED(a, b) a##b
#define FRAHM_NAME(a, b) FRAHM_JOINED(a, b)

void FRAHM_NAME(solve_, FRAHM_KERNEL)(const Pack& pack, double* workspace) {
  solve_by_size(pack, workspace);
}

// The same for all, from the one that runs wherever this build does.
#if defined(FRAHM_LEAST_KERNEL)
std::size_t workspace_size(const Shape& shape) {
  Pack pack;
  pack.shape = &shape;
  Arena arena(nullptr);
  const Work<AnyCounts> work(pack, arena);
  return arena.used();
}
#endif

}  // namespace frahm::periodic::nonstop
