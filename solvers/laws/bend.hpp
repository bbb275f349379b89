#pragma once

// The properties of a law that bends: beyond a place D of its displacement u [m], or of its velocity [m/s],
// an element is stiffer or damps more,
//
//   force = k (u - D) + c u'   beyond a place of the displacement,   0 before it
//   force = c (u' - D)         beyond a place of the velocity,       0 before it
//
// so that it is linear on both sides and the flow stays exact. A characteristic that is given by points is
// the sum of a straight line and a bend at each point; a stop on the other side is one along -u. Force and
// rate of a spring's or damper's bend are continuous; that of a stop with damping jumps where it is reached.
//
// A law is one file that fills in this struct. The flow and the events read it and never ask which law it is.
namespace frahm::laws {

struct Bend {
  const char* name;
  // Its place is one of the velocity.
  bool of_velocity;
  // It ends where it began, at its place; otherwise where its force would pull.
  bool pulls;
};

}  // namespace frahm::laws
