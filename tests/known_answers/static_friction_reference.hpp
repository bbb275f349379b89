#pragma once

#include <Eigen/Dense>
#include <vector>

// An independent reference for masses with contacts that hold more at rest (F_s) than they do sliding (F),
// under constant and harmonic forces, from rest. Cosine, sine and a one are states too, so that the motion is
// X' = A X in each state of the contacts; Taylor's series of it is summed to rounding. At every event all 3^m
// ways of the contacts at rest are tried, each by the derivatives of its forces and velocities up to the
// first that is not zero. Of those that do what they claim that with most contacts stuck is taken, then that
// which keeps most of what stuck, then that of least sum (lambda / F_s)^2. Contacts may form one loop: its
// forces are then known up to a multiple of one set of forces in balance, for which some place within all
// limits must be left. It shares no code with the solvers.
namespace frahm::static_friction {

struct Contact {
  Eigen::VectorXd w;  // u = w^T q
  double kinetic = 0.0, limit = 0.0;
};

struct System {
  Eigen::VectorXd mass;
  Eigen::MatrixXd K, C;
  std::vector<Contact> contacts;
  Eigen::VectorXd constant, cosine, sine;  // forces [N]
  double omega = 1.0;
};

struct Stop {
  double onset = 0.0, release = -1.0;  // [s]; -1: not released
};

struct Motion {
  bool has_none_admissible = false;  // at some instant, where it ended
  // Some decision lies within kNear of its limit: a force at rest or an acceleration of another choice, a
  // force that nearly reaches its limit, a velocity that nearly reaches zero, two events at nearly one
  // instant.
  bool is_near = false;
  std::vector<std::vector<Stop>> stops;  // of each contact
  Eigen::VectorXd peak, end;             // largest |q|; q at the end
  int events = 0;
};
inline constexpr double kNear = 1e-6;

Motion follow(const System& system, double duration);

}  // namespace frahm::static_friction
