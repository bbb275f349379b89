#pragma once

#include <Eigen/Core>

#include "solvers/events/walk.hpp"
#include "solvers/orbits/kept_derivative.hpp"
#include "solvers/orbits/orbit.hpp"

// The periodic orbit as a fixed point of the period map g, by Newton's method on g(z) - z = 0 with the exact
// derivative of g; of a large system with one that is kept, corrected, and computed again, in single
// precision, where its steps no longer serve (KeptDerivative). If a Newton step reduces the residual too
// little, the map itself is applied: under monotone laws it expands no distance in the energy norm, so the
// search converges if the map contracts. Where it only turns about its orbit, means of a state and its image
// converge.
namespace frahm::periodic {

struct ShootingOptions {
  double tolerance = 1e-13;    // of the relative residual: a few units of rounding of one passage
  double good_enough = 1e-12;  // accepted when rounding keeps the residual from falling further
  double pays = 0.1;           // part of the residual that a Newton step must remove, otherwise it is refused
  double turns = 1e-6;         // the map only turns if it removes no more of the residual than this
  int most_turns = 8;          // maps in a row
  int most_maps = 256;         // in a row, before Newton's method is tried again
  int most_halvings = 4;       // of a refused step, of a large system or under laws that are not monotone
  int most_passages = 20000;   // enough for the map alone at damping ratios of 1e-3
  double most_steps_a_period = 2e5;
  double most_magnification = 1e13;  // of the static response: beyond, rounding of the orbit hides the forces
};

// A state at the section, the passage that starts from it, and the residual of the map.
template <int N, int H>
struct Trial {
  typename Sizes<N, H>::State z;
  Passage<N, H> passage;
  ContactMask stuck_throughout = 0;
  Closing closing;
  typename Sizes<N, H>::State residual;  // g(z) - z
  double norm = 0.0;                     // its energy norm [sqrt(J)]
  double relative = 0.0;                 // to that of z, or of the static response
};

template <int N, int H>
class Shooting {
 public:
  using S = Sizes<N, H>;

  explicit Shooting(Flow<N, H>& flow, const ShootingOptions& options = {})
      : flow_(flow), walk_(flow), options_(options) {}

  // Starts from the state orbit.z at orbit.section; orbit.half_period selects the map. Fills the rest of
  // `orbit`. held: contacts that stick regardless of their force. maps_first: of the map, before Newton's
  // method.
  void find(Orbit<N, H>& orbit, ContactMask held = 0, int maps_first = 0);
  // The next search has no derivative of an earlier one.
  void forget() { kept_.forget(); }

 private:
  enum class Verdict { go_on, converged, gave_up };

  void apply_map(Trial<N, H>& trial);
  Verdict judge();
  bool take_newton_step();
  bool take_dense_step();
  bool take_kept_step();
  KeptDerivative::Map map() const;
  typename S::StateSquare newton_matrix(const typename S::StateSquare& tangent);
  bool try_step(const typename S::State& step, double share = 1.0);
  bool try_steps(const typename S::State& step);
  bool try_shorter_steps(const typename S::State& step);
  Verdict go_by_map(int& maps);
  void march(int maps);
  typename S::State image(const Trial<N, H>& trial) const;
  bool creeps(double before, int maps) const;
  bool glide();
  typename S::StateSquare tangent_here() const;
  double rounding() const;
  void step_to_middle();
  void start_at_rest();
  bool is_resolved(const typename S::State& z) const;
  void conclude(Verdict verdict, Orbit<N, H>& orbit);

  Flow<N, H>& flow_;
  Walk<N, H> walk_;
  ShootingOptions options_;

  // The current search.
  double section_ = 0.0, sign_ = 1.0, length_ = 0.0;
  ContactMask held_ = 0;
  int newton_iterations_ = 0, passages_ = 0;
  KeptDerivative kept_;  // of a large system
  Trial<N, H> current_, candidate_;
};

// The tangent of an orbit's passage, where the search did not need it.
template <int N, int H>
void follow_tangent(const Flow<N, H>& flow, Orbit<N, H>& orbit) {
  if (orbit.passage.has_tangent || !orbit.is_found()) return;
  flow.tangent_along(orbit.passage.path, Precision::exact, orbit.passage.tangent);
  orbit.passage.has_tangent = true;
}

extern template class Shooting<1, 1>;
extern template class Shooting<2, 1>;
extern template class Shooting<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
