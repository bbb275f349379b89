#pragma once

namespace frahm::periodic {

// What is searched where a system may have several stable orbits, and which of them is reported.
struct OrbitsWanted {
  // Largest, smallest: by the peak of the first mass, among those found. Up, down: the one that a slow sweep
  // of the frequency stays on, or jumps to, from one point of a row to the next; others are then not
  // searched.
  enum class Show { largest, smallest, up, down };
  int starts = 8;         // in addition to the orbits of the points before and after
  int most_multiple = 6;  // of the forcing's period
  Show show = Show::largest;

  static bool is_slow_sweep(Show show) { return show == Show::up || show == Show::down; }
  bool is_slow_sweep() const { return is_slow_sweep(show); }
};

}  // namespace frahm::periodic
