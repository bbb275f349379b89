#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"

// An independent reference for the flow with set-valued friction (with a static limit above the sliding force
// too), Jenkins elements and elements that bend: Boost.odeint's Runge-Kutta-Fehlberg 7(8) between events that
// are found by bisection of partial steps, with the modes of contacts at rest found by trying all, and each
// bend's force as a function of the state. It shares with the solvers nothing but the matrices, and for its
// step their eigenvalues.
namespace frahm::periodic {

class EventIntegrator {
 public:
  explicit EventIntegrator(const mechanics::LinearSystem& system);

  // Next to its harmonics: displacements of the prescribed nodes, or a derivative of them, and forces on the
  // masses, at a time. Between two calls of advance_to they must be smooth.
  struct Recorded {
    std::function<Eigen::VectorXd(double t, int derivative)> motion;
    std::function<Eigen::VectorXd(double t)> force;
    double speed = 0.0;  // the size of velocities that they make [m/s]
  };
  void set_recorded(Recorded recorded) { recorded_ = std::move(recorded); }

  // From displacements [m], velocities [m/s] and the forces [N] of Maxwell elements at time t [s].
  void start(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& s = {});
  void advance_to(double t_end);

  Eigen::VectorXd displacements() const;
  Eigen::VectorXd velocities() const;
  Eigen::VectorXd maxwell_forces() const;
  // (max - min) / 2 of the displacement of a mass since the start [m], stationary points solved.
  double amplitude(Eigen::Index mass) const { return 0.5 * (most_[mass] - least_[mass]); }
  int events() const { return events_; }

 private:
  enum class Mode { stuck, forward, backward };
  using State = std::vector<double>;  // displacements, velocities, Maxwell forces

  struct Motion {
    Eigen::VectorXd acceleration, friction;  // of the masses; of the contacts
  };
  Motion motion(const State& x, double t, const std::vector<Mode>& modes) const;
  Eigen::VectorXd support(double t, int derivative) const;  // of the prescribed nodes [m], [m/s], [m/s^2]
  Eigen::VectorXd forcing(double t) const;                  // on the masses [N]
  double relative_velocity(const State& x, double t, Eigen::Index contact) const;
  // Whether a bend has its force: u - D > 0, and k (u - D) + c u' > 0 where it cannot pull. More than zero
  // where it has, by the room that is left.
  double bend_room(const State& x, double t, Eigen::Index bend) const;
  double bend_force(const State& x, double t, Eigen::Index bend) const;
  bool slides_by_state(Eigen::Index contact) const {
    return system_.contact_internal[static_cast<std::size_t>(contact)] >= 0;
  }
  double relative_acceleration(const Eigen::VectorXd& a, double t, Eigen::Index contact) const;
  // > 0 while the contact's mode lasts: velocity in its direction, or room up to the limit of friction.
  double margin(const State& x, double t, Eigen::Index guard) const;  // the contacts, then the bends
  State moved(double t, double h) const;                              // state_ after a partial step
  double first_end_of_mode(double h, Eigen::Index guard) const;
  void choose(const std::vector<Eigen::Index>& at_rest);
  std::vector<Eigen::Index> stuck_contacts() const;
  bool is_consistent(const std::vector<Eigen::Index>& at_rest, const std::vector<Mode>& modes) const;
  void pass_event(Eigen::Index guard);
  void pass_bend(Eigen::Index bend);
  void note_extremes(double h);

  const mechanics::LinearSystem& system_;
  Recorded recorded_;
  Eigen::MatrixXd M_inverse_;
  double step_ = 0.0, speed_scale_ = 0.0;
  double t_ = 0.0;
  State state_;
  std::vector<Mode> modes_;
  std::vector<bool> beyond_;  // bends with a force
  std::vector<bool> fresh_;   // velocity or room is zero now and is about to grow
  Eigen::VectorXd most_, least_;
  int events_ = 0;
};

}  // namespace frahm::periodic
