#include "solvers/mechanics/joints.hpp"

#include <numeric>
#include <string>

#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/mechanics/element_table.hpp"

namespace frahm::mechanics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// What dampers add in its rows: C of the joints, whatever its value.
bool damps_joints(const Element& element) {
  return element.type == ElementType::damper || element.type == ElementType::hysteretic;
}

// The blocks of a matrix of masses, joints and supports that the joints have a share in.
struct Blocks {
  MatrixXd by_masses, by_supports, own;  // j x n, j x p, j x j

  void set_zero(Index joints, Index masses, Index supports) {
    by_masses.setZero(joints, masses);
    by_supports.setZero(joints, supports);
    own.setZero(joints, joints);
  }
  void add(double coefficient, const Incidence& at) {
    if (coefficient == 0.0) return;
    by_masses.noalias() += coefficient * at.j * at.w.transpose();
    by_supports.noalias() += coefficient * at.j * at.p.transpose();
    own.noalias() += coefficient * at.j * at.j.transpose();
  }
};

struct JointMatrices {
  Blocks K, C;
};

JointMatrices matrices_of_joints(const Assembly& assembly, const LinearSystem& system) {
  JointMatrices result;
  const Network& network = assembly.network();
  const auto joints = static_cast<Index>(network.joints.size());
  const auto masses = static_cast<Index>(network.masses.size());
  const auto supports = static_cast<Index>(network.prescribed.size());
  result.K.set_zero(joints, masses, supports);
  result.C.set_zero(joints, masses, supports);
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Incidence& at = assembly.incidences()[e];
    if (!at.has_joint()) continue;
    result.K.add(system.coefficients[e].stiffness, at);
    result.C.add(system.coefficients[e].damping, at);
  }
  return result;
}

[[noreturn]] void refuse_joint(const Network& network, Index joint, const std::string& rule) {
  throw MechanicsError("joint '" + network.joints[static_cast<std::size_t>(joint)] + "': " + rule);
}

// -1 where the symmetric matrix A is positive definite; otherwise the row in which it is least so.
Index not_positive_at(const MatrixXd& A) {
  constexpr double kRounding = 1e-13;  // with a diagonal of 1
  for (Index i = 0; i < A.rows(); ++i)
    if (!(A(i, i) > 0.0)) return i;
  const VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const algebra::SymmetricModes modes = algebra::symmetric_modes(scale.asDiagonal() * A * scale.asDiagonal());
  if (modes.values.size() == 0 || modes.values[0] > kRounding) return -1;
  Index row = 0;
  modes.vectors.col(0).cwiseAbs().maxCoeff(&row);
  return row;
}

// The joint that moves most in a combination of them.
Index most_moved(const VectorXd& joints) {
  Index most = 0;
  joints.cwiseAbs().maxCoeff(&most);
  return most;
}

void check_springs(const Network& network, const MatrixXd& K) {
  if (const Index joint = not_positive_at(K); joint >= 0)
    refuse_joint(
        network, joint,
        "no spring holds it; a joint without mass needs one, to a mass, to the ground or to a node of "
        "prescribed motion, or a mass of its own");
}

// Columns V of each group with V^T C V = 1 and V^T K V = diag(k), k in `stiffness`; the largest entry of each
// is positive, so that they change continuously with K and C.
MatrixXd damped_modes(const Network& network, const JointDirections& directions, const MatrixXd& K,
                      const MatrixXd& C, VectorXd& stiffness) {
  const Index d = directions.damped.cols();
  MatrixXd V = MatrixXd::Zero(d, d);
  stiffness.resize(d);
  for (std::size_t g = 0; g + 1 < directions.first.size(); ++g) {
    const Index first = directions.first[g], count = directions.first[g + 1] - first;
    if (count == 0) continue;
    const MatrixXd C_own = C.block(first, first, count, count);
    if (const Index row = not_positive_at(C_own); row >= 0)
      refuse_joint(network, most_moved(directions.damped.col(first + row)),
                   "the damping of its dampers is 0; leave them out, or give one a damping above 0");
    algebra::SymmetricModes modes = algebra::symmetric_modes(K.block(first, first, count, count), C_own);
    for (Index k = 0; k < count; ++k) {
      Index largest = 0;
      modes.vectors.col(k).cwiseAbs().maxCoeff(&largest);
      if (modes.vectors(largest, k) < 0.0) modes.vectors.col(k) *= -1.0;
    }
    V.block(first, first, count, count) = modes.vectors;
    stiffness.segment(first, count) = modes.values;
  }
  return V;
}

// a + b without what is left of terms that cancel each other but for rounding.
VectorXd sum(const VectorXd& a, const VectorXd& b) {
  constexpr double kRounding = 1e-13;
  const VectorXd sum = a + b;
  return (sum.array().abs() > kRounding * (a.array().abs() + b.array().abs())).select(sum, 0.0);
}

// Adds to the blocks of masses and supports what elements of joints have of them. With x = F q + F_y y where
// no force on the joints is left, Q_q - Q_qx Q_x^-1 Q_xq is the sum of  q_e u u^T, u = w + F^T j, and that of
// supports the sum of  q_e u v^T, v = p + F_y^T j; their derivatives are those of q_e alone, as F is
// stationary.
void add_at_rest(const Assembly& assembly, const std::vector<ElementCoefficients>& of,
                 double ElementCoefficients::*coefficient, const MatrixXd& F, const MatrixXd& F_y,
                 MatrixXd& own, MatrixXd& of_supports) {
  for (std::size_t e = 0; e < of.size(); ++e) {
    const Incidence& at = assembly.incidences()[e];
    if (!at.has_joint() || of[e].*coefficient == 0.0) continue;
    const VectorXd u = sum(at.w, F.transpose() * at.j), v = sum(at.p, F_y.transpose() * at.j);
    own.noalias() += of[e].*coefficient * u * u.transpose();
    of_supports.noalias() += of[e].*coefficient * u * v.transpose();
  }
}

// Adds what `of` says of springs and dampers at joints; system: whose joints they are.
void add_elements_of_joints(const Assembly& assembly, const LinearSystem& system,
                            const JointMatrices& matrices, LinearSystem& to) {
  const Joints& joints = system.joints;
  add_at_rest(assembly, to.coefficients, &ElementCoefficients::stiffness, joints.B, joints.B_support, to.K,
              to.K_support);
  const MatrixXd take = -joints.damped * joints.damped.transpose();
  add_at_rest(assembly, to.coefficients, &ElementCoefficients::damping, take * matrices.C.by_masses,
              take * matrices.C.by_supports, to.C, to.C_support);
}

}  // namespace

std::string instead_at_joint(const Element& element) {
  const ElementKind& kind = kind_of(element);
  if (kind.law != nullptr || element.law == ForceLaw::arctan || element.law == ForceLaw::stribeck)
    return "friction in series with a spring is one jenkins element; friction in series with a damper is a "
           "damper with a table that rises and then stays level";
  if (!element.bends.empty()) return "give this end of the stop or table a mass";
  if (element.law != ForceLaw::exact) return "give this end of a spring with cubic a mass";
  if (kind.has_internal_force) return "write it as a spring and a damper with another joint between them";
  if (element.type == ElementType::inerter) return "write the node as a mass of zero";
  return "";
}

void check_elements_of_joints(const Network& network, const std::vector<Incidence>& incidences) {
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Element& element = network.elements[e];
    if (!incidences[e].has_joint()) continue;
    if (const std::string rule = instead_at_joint(element); !rule.empty())
      throw MechanicsError("element '" + element.name +
                           "' ends at a joint without mass, which it cannot: " + rule);
  }
}

JointDirections directions_of_joints(const Network& network, const std::vector<Incidence>& incidences) {
  const auto joints = static_cast<Index>(network.joints.size());
  // Groups of joints that elements join.
  std::vector<Index> group(network.joints.size());
  std::iota(group.begin(), group.end(), Index{0});
  for (const Incidence& at : incidences) {
    Index first = -1;
    for (Index i = 0; at.has_joint() && i < joints; ++i) {
      if (at.j[i] == 0.0) continue;
      if (first < 0) first = group[static_cast<std::size_t>(i)];
      const Index merged = group[static_cast<std::size_t>(i)];
      for (Index& each : group)
        if (each == merged) each = first;
    }
  }
  JointDirections result;
  std::vector<VectorXd> damped, undamped;
  for (Index g = 0; g < joints; ++g) {
    std::vector<Index> members;
    for (Index i = 0; i < joints; ++i)
      if (group[static_cast<std::size_t>(i)] == g) members.push_back(i);
    if (members.empty()) continue;
    MatrixXd rows(0, static_cast<Index>(members.size()));
    for (std::size_t e = 0; e < network.elements.size(); ++e) {
      const VectorXd own = incidences[e].j(members);
      if (own.isZero(0.0) || !damps_joints(network.elements[e])) continue;
      rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
      rows.bottomRows(1) = own.normalized().transpose();
    }
    const auto add = [&](const MatrixXd& directions, std::vector<VectorXd>& to) {
      for (Index k = 0; k < directions.cols(); ++k) {
        to.emplace_back(VectorXd::Zero(joints));
        to.back()(members) = directions.col(k);
      }
    };
    const MatrixXd free = algebra::null_space(rows);
    add(free, undamped);
    add(algebra::null_space(MatrixXd(free.transpose())), damped);
    result.first.push_back(static_cast<Index>(damped.size()));
  }
  const auto columns = [&](const std::vector<VectorXd>& list) {
    MatrixXd matrix(joints, static_cast<Index>(list.size()));
    for (std::size_t k = 0; k < list.size(); ++k) matrix.col(static_cast<Index>(k)) = list[k];
    return matrix;
  };
  result.damped = columns(damped);
  result.undamped = columns(undamped);
  return result;
}

void condense_joints(const Assembly& assembly, LinearSystem& system) {
  const Network& network = assembly.network();
  const auto& [E_damped, U, first] = assembly.joint_directions();
  const auto [K, C] = matrices_of_joints(assembly, system);
  check_springs(network, K.own);
  Joints& joints = system.joints;
  const Index j = K.own.rows(), d = E_damped.cols(), place = system.internal_forces() - d;
  joints.A = algebra::solve_positive(K.own, MatrixXd(MatrixXd::Identity(j, j)));
  joints.B = -joints.A * K.by_masses;
  joints.B_support = -joints.A * K.by_supports;
  // Along U nothing damps: N are K_x-orthogonal to it, and C_x N = C_x E.
  MatrixXd N = E_damped;
  if (U.cols() > 0)
    N -= U * algebra::solve_positive(MatrixXd(U.transpose() * K.own * U),
                                     MatrixXd(U.transpose() * K.own * E_damped));
  VectorXd k;
  const MatrixXd V = damped_modes(network, assembly.joint_directions(), N.transpose() * K.own * N,
                                  E_damped.transpose() * C.own * E_damped, k);
  joints.damped = E_damped * V;
  N = N * V;
  add_elements_of_joints(assembly, system, {K, C}, system);
  joints.X.setZero(j, system.internal_forces());
  joints.X.rightCols(d) = -N * k.cwiseInverse().asDiagonal();
  joints.load_drive.setZero(j, system.internal_forces());
  joints.load_drive.rightCols(d) = joints.A * C.own * joints.damped;
  system.D.rightCols(d) = (C.by_masses.transpose() + joints.B.transpose() * C.own) * joints.damped;
  system.D_support.rightCols(d) =
      (C.by_supports.transpose() + joints.B_support.transpose() * C.own) * joints.damped;
  system.internal_stiffness.segment(place, d) = k;
  system.internal_rate.segment(place, d) = k;
}

// With E held, G = E^T C_x E (1 here), k = N^T K_x N and N = E - U (U^T K_x U)^-1 U^T K_x E:
//   x = ... - N k^-1 s,   s' = k (D^T q' + ...) - k G^-1 s,   D = (C_qx + B^T C_x) E G^-1
void differentiate_joints(const Assembly& assembly, const LinearSystem& system, LinearSystem& derivative) {
  const MatrixXd& U = assembly.joint_directions().undamped;
  const auto [K, C] = matrices_of_joints(assembly, system);
  const auto [K_by, C_by] = matrices_of_joints(assembly, derivative);
  const Joints& joints = system.joints;
  Joints& by = derivative.joints;
  const MatrixXd &E = joints.damped, &A = joints.A;
  const Index j = A.rows(), d = E.cols(), s = system.internal_forces();
  const VectorXd k = system.internal_stiffness.tail(d);
  by.A = -A * K_by.own * A;
  by.B = -A * (K_by.by_masses + K_by.own * joints.B);
  by.B_support = -A * (K_by.by_supports + K_by.own * joints.B_support);
  const MatrixXd N = -joints.X.rightCols(d) * k.asDiagonal();
  MatrixXd N_by = MatrixXd::Zero(j, d);
  if (U.cols() > 0)
    N_by = -U * algebra::solve_positive(MatrixXd(U.transpose() * K.own * U),
                                        MatrixXd(U.transpose() * K_by.own * N));
  const MatrixXd k_by = N.transpose() * K_by.own * N, G_by = E.transpose() * C_by.own * E;
  add_elements_of_joints(assembly, system, {K, C}, derivative);
  by.X.setZero(j, s);
  by.X.rightCols(d) = (-N_by + N * k.cwiseInverse().asDiagonal() * k_by) * k.cwiseInverse().asDiagonal();
  by.load_drive.setZero(j, s);
  by.load_drive.rightCols(d) = (by.A * C.own + A * C_by.own) * E - joints.load_drive.rightCols(d) * G_by;
  derivative.D.setZero(system.masses(), s);
  derivative.D.rightCols(d) =
      (C_by.by_masses.transpose() + by.B.transpose() * C.own + joints.B.transpose() * C_by.own) * E -
      system.D.rightCols(d) * G_by;
  derivative.D_support.setZero(system.D_support.rows(), s);
  derivative.D_support.rightCols(d) = (C_by.by_supports.transpose() + by.B_support.transpose() * C.own +
                                       joints.B_support.transpose() * C_by.own) *
                                          E -
                                      system.D_support.rightCols(d) * G_by;
  by.stiffness_by.setZero(s, s);
  by.stiffness_by.bottomRightCorner(d, d) = k_by;
  by.rate_by.setZero(s, s);
  by.rate_by.bottomRightCorner(d, d) = k_by - k.asDiagonal() * G_by;
}

void part_loads_of_joints(Index masses, LinearSystem& system) {
  const Index joints = system.constant_force.size() - masses;
  system.joints.constant_load = system.constant_force.tail(joints);
  system.joints.load = system.force.bottomRows(joints);
  system.constant_force.conservativeResize(masses);
  system.force.conservativeResize(masses, Eigen::NoChange);
}

void load_masses_by_joints(LinearSystem& system) {
  const Joints& joints = system.joints;
  system.constant_force += joints.B.transpose() * joints.constant_load;
  system.force += joints.B.transpose() * joints.load;
  system.recorded_force += joints.B.transpose() * joints.recorded_load;
}

void differentiate_loads_of_joints(const LinearSystem& system, LinearSystem& derivative) {
  const Joints &joints = system.joints, &by = derivative.joints;
  derivative.constant_force +=
      joints.B.transpose() * by.constant_load + by.B.transpose() * joints.constant_load;
  derivative.force += joints.B.transpose() * by.load + by.B.transpose() * joints.load;
  derivative.recorded_force +=
      joints.B.transpose() * by.recorded_load + by.B.transpose() * joints.recorded_load;
}

VectorXd at_rest(const LinearSystem& system, const Incidence& at) {
  if (!at.has_joint()) return at.w;
  return sum(at.w, system.joints.B.transpose() * at.j);
}

}  // namespace frahm::mechanics
