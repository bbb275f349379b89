#include <Eigen/Core>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/rotation.hpp"

namespace frahm::mechanics {

// c is the shortest change from `counted` that does; between two nodes there is none to make.
void Assembly::weigh_support_force() {
  const auto n = static_cast<Eigen::Index>(network_.masses.size());
  const auto m = static_cast<Eigen::Index>(network_.elements.size());
  const bool takes_torque = ground_takes_torque(network_);
  auto& [counted, c, excess, joint_counted, joint_c] = support_force_;
  const auto joints = static_cast<Eigen::Index>(network_.joints.size());
  counted.resize(n);
  for (Eigen::Index i = 0; i < n; ++i)
    counted[i] = rotates(network_, static_cast<std::size_t>(i)) == takes_torque ? 1.0 : 0.0;
  joint_counted.resize(joints);
  for (Eigen::Index i = 0; i < joints; ++i)
    joint_counted[i] = joint_rotates(network_, static_cast<std::size_t>(i)) == takes_torque ? 1.0 : 0.0;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(m, n + joints);
  Eigen::VectorXd missing = Eigen::VectorXd::Zero(m);
  excess.setZero(m);
  for (Eigen::Index e = 0; e < m; ++e) {
    const auto& [w, p, j] = incidences_[static_cast<std::size_t>(e)];
    const Element& element = network_.elements[static_cast<std::size_t>(e)];
    excess[e] = share_in_force(element, Node{}, takes_torque) + (takes_torque ? 0.0 : p.sum());
    if (kind_of(element).is_inertia_alone()) continue;
    A.row(e) << w.transpose(), j.transpose();
    missing[e] = -excess[e] - w.dot(counted) - j.dot(joint_counted);
    excess[e] = 0.0;
  }
  c = counted;
  joint_c = joint_counted;
  if (!missing.isZero(0.0)) {
    constexpr double kRounding = 1e-12;
    const Eigen::VectorXd change = algebra::shortest_solution(A, missing);
    c += change.head(n);
    joint_c += change.tail(joints);
    if ((A * change - missing).norm() > kRounding * missing.norm()) c.setConstant(kNone);
  }
  for (Eigen::Index e = 0; e < m; ++e) {
    const Element& element = network_.elements[static_cast<std::size_t>(e)];
    if (kind_of(element).is_inertia_alone()) excess[e] += c.dot(incidences_[static_cast<std::size_t>(e)].w);
  }
}

}  // namespace frahm::mechanics
