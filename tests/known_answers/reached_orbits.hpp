#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "solvers/exact/coexistence.hpp"
#include "tests/known_answers/exponential_integrator.hpp"
#include "tests/known_answers/random_network.hpp"

// What the search for coexisting orbits finds, next to what motions from many random starts come to when the
// independent integration follows them.
namespace frahm::periodic {

// A stable orbit: its states q, v, s at phase 0 of each of its periods.
struct ReachedOrbit {
  std::vector<Eigen::VectorXd> returns;
  unsigned stuck = 0;  // Coulomb contacts that stick throughout: they may rest anywhere, so it is a family
  bool is_found = false, is_reached = false;
};

struct ReachedOrbits {
  std::vector<ReachedOrbit> orbits;
  int unclosed = 0;      // orbits of the search that do not close in the independent integration
  int not_periodic = 0;  // motions that come to no orbit of up to `most_multiple` periods
  int longer = 0;        // motions that come to one of more periods

  int found() const { return static_cast<int>(std::ranges::count_if(orbits, &ReachedOrbit::is_found)); }
  int reached() const { return static_cast<int>(std::ranges::count_if(orbits, &ReachedOrbit::is_reached)); }
  int missed() const {
    return static_cast<int>(
        std::ranges::count_if(orbits, [](const ReachedOrbit& o) { return o.is_reached && !o.is_found; }));
  }
};

class OrbitComparison {
 public:
  OrbitComparison(const RandomNetwork& drawn, const OrbitsWanted& wanted)
      : drawn_(drawn), wanted_(wanted), reference_(drawn.network, drawn.values) {
    reference_.watches_extremes = false;
    search();
  }

  // Follows random starts; the same ones for the same seed.
  void follow(int starts, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Eigen::Index n = reference_.masses();
    for (int start = 0; start < starts; ++start) {
      const double reach = size_ * std::pow(10.0, 0.5 * uniform(random) + 0.3);
      Eigen::VectorXd q(n), v(n);
      for (double& each : q) each = reach * uniform(random);
      for (double& each : v) each = reach * drawn_.values.omega * uniform(random);
      follow(q, v);
    }
  }

  const ReachedOrbits& result() const { return result_; }
  double size() const { return size_; }

 private:
  static constexpr int kMostMultiple = 8;    // that is distinguished from a motion that is not periodic
  static constexpr int kPeriods = 400;       // that a motion is followed
  static constexpr double kThere = 1e-4;     // of the size: so near to an orbit that it goes on to it
  static constexpr double kSame = 1e-3;      // between orbits
  static constexpr double kPeriodic = 1e-8;  // of a motion that has come to its orbit
  static constexpr double kCloses = 1e-7;    // of an orbit of the search

  double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    const Eigen::Index n = reference_.masses();
    const Eigen::VectorXd d = (a - b).cwiseAbs();
    return std::max(d.head(n).maxCoeff(), d.segment(n, n).maxCoeff() / drawn_.values.omega) / size_;
  }
  // Families of rest positions are one orbit where their velocities are the same.
  bool is_same(const Eigen::VectorXd& z, unsigned stuck, const ReachedOrbit& orbit, double within) const {
    const Eigen::Index n = reference_.masses();
    return std::ranges::any_of(orbit.returns, [&](const Eigen::VectorXd& each) {
      if (distance(z, each) < within) return true;
      if (stuck == 0 || stuck != orbit.stuck) return false;
      return (z - each).segment(n, n).cwiseAbs().maxCoeff() < 0.05 * drawn_.values.omega * size_;
    });
  }

  // All stable orbits of the search, each followed over its periods.
  void search() {
    const mechanics::Assembly assembly(drawn_.network);
    mechanics::LinearSystem system;
    assembly.set_values(drawn_.values, system);
    assembly.set_forcing(drawn_.values, system);
    Flow<Eigen::Dynamic, Eigen::Dynamic> flow;
    flow.set_system(system);
    Coexistence<Eigen::Dynamic, Eigen::Dynamic> coexistence(assembly, flow, wanted_);
    const std::vector<KnownOrbit> found = known_orbits(coexistence.find(system, nullptr));
    const Eigen::Index n = system.masses();
    for (const auto& [z, multiple] : found) size_ = std::max(size_, z.head(n).cwiseAbs().maxCoeff());
    for (const auto& [z, multiple] : found) {
      ReachedOrbit orbit;
      orbit.is_found = true;
      reference_.start(z.head(n), z.segment(n, n), z.tail(z.size() - 2 * n));
      for (int m = 0; m < multiple; ++m) {
        orbit.returns.push_back(reference_.state());
        reference_.pass_period();
      }
      orbit.stuck = reference_.stuck_throughout & reference_.coulomb_contacts();
      if (distance(reference_.state(), z) > kCloses) ++result_.unclosed;
      add(orbit);
    }
  }

  ReachedOrbit& add(const ReachedOrbit& orbit) {
    for (ReachedOrbit& known : result_.orbits)
      if (is_same(orbit.returns.front(), orbit.stuck, known, kSame)) return known;
    result_.orbits.push_back(orbit);
    return result_.orbits.back();
  }

  void follow(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    reference_.start(q, v, Eigen::VectorXd::Zero(reference_.internal_forces()));
    std::vector<Eigen::VectorXd> trail{reference_.state()};
    std::vector<unsigned> stuck;
    for (int period = 0; period < kPeriods; ++period) {
      reference_.stuck_throughout = ~0U;
      reference_.pass_period();
      stuck.push_back(reference_.stuck_throughout & reference_.coulomb_contacts());
      const Eigen::VectorXd z = reference_.state();
      for (ReachedOrbit& known : result_.orbits) {
        if (!std::ranges::any_of(known.returns, [&](const auto& each) { return distance(z, each) < kThere; }))
          continue;
        known.is_reached = true;
        return;
      }
      trail.push_back(z);
      const auto last = static_cast<int>(trail.size()) - 1;
      for (int m = 1; m <= std::min(kMostMultiple, last); ++m) {
        if (distance(z, trail[static_cast<std::size_t>(last - m)]) > kPeriodic) continue;
        ReachedOrbit orbit{{trail.end() - m, trail.end()}, ~0U, false, true};
        for (int k = 1; k <= m; ++k) orbit.stuck &= stuck[stuck.size() - static_cast<std::size_t>(k)];
        if (m > wanted_.most_multiple)
          ++result_.longer;
        else
          add(orbit).is_reached = true;
        return;
      }
    }
    ++result_.not_periodic;
  }

  const RandomNetwork& drawn_;
  OrbitsWanted wanted_;
  ExponentialIntegrator reference_;
  double size_ = 1.0;  // [m]: the static response is near 1 m
  ReachedOrbits result_;
};

}  // namespace frahm::periodic
