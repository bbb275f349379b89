#pragma once

namespace frahm::periodic {

// What is searched where a system may have several stable orbits, and which of them is told.
struct OrbitsWanted {
  enum class Show { largest, smallest };  // peak of the first mass
  int starts = 8;                         // beside the orbits of the point before
  int most_multiple = 4;                  // of the forcing's period
  Show show = Show::largest;
};

}  // namespace frahm::periodic
