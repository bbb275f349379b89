#pragma once

#include <vector>

#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/smooth/shooting.hpp"

namespace frahm::smooth {

// Orbits of smooth laws that are not monotone, searched as those of the exact ones are
// (exact/coexistence.hpp): motions are followed from many starts until they come near an orbit, which
// Newton's method then finds; the stable ones are kept. The search may miss one.
class Coexistence {
 public:
  // The equation and the integrator must outlive the search.
  Coexistence(Equation& equation, Integrator& integrator, const periodic::OrbitsWanted& wanted)
      : equation_(equation),
        integrator_(integrator),
        shooting_(equation, integrator, {.most_passages = 20, .applies_map = false}),
        wanted_(wanted) {}

  void forget() { before_.clear(); }
  // Finds the orbit to be reported, its section at omega t = 0; the equation, which is set to `system` and
  // `values`, is then set to the orbit's multiple of the period.
  void find(const mechanics::LinearSystem& system, const mechanics::NetworkValues& values, Orbit& orbit);
  // Another one of those found; the equation is set to `system` before.
  void tell(std::size_t which, Orbit& orbit);

 private:
  struct Found {
    Orbit orbit;
    std::vector<Eigen::VectorXd> returns;  // its states at omega t = 0, after each period of the forcing
    double peak = 0.0;                     // of the first mass [m]
  };
  // An orbit of the point before.
  struct Earlier {
    Eigen::VectorXd z;
    int multiple = 1;
  };

  bool follow(Eigen::VectorXd z);  // whether it settled
  void add_mirrors();
  int likely_multiple(const std::vector<Eigen::VectorXd>& trail) const;
  bool find_near(const Eigen::VectorXd& z, int multiple);
  bool keep(Orbit& orbit, double peak);
  void take_for_one(int multiple);  // so many periods of the forcing
  Eigen::VectorXd scale_of(const Eigen::VectorXd& z) const;
  double peak_of(const Orbit& orbit) const;
  bool is_known(const Eigen::VectorXd& z, double within) const;
  Eigen::VectorXd sliding_response() const;
  Eigen::VectorXd start_state(int index, const Eigen::VectorXd& response) const;
  void tell(Orbit& orbit);

  Equation& equation_;
  Integrator& integrator_;
  Shooting shooting_;
  periodic::OrbitsWanted wanted_;
  const mechanics::LinearSystem* system_ = nullptr;  // of find()
  const mechanics::NetworkValues* values_ = nullptr;

  std::vector<Earlier> before_;  // of the point before
  std::vector<Found> stable_;    // of this point
  bool found_unstable_ = false;
  int unsettled_ = 0;  // starts
  int passages_ = 0, newton_iterations_ = 0;
};

}  // namespace frahm::smooth
