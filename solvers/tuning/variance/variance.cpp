#include "solvers/tuning/variance/variance.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "solvers/mechanics/system_derivative.hpp"
#include "solvers/tuning/variance/lyapunov.hpp"

namespace frahm::tuning {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using mechanics::Dual;
using mechanics::Element;
using mechanics::ElementKind;
using mechanics::Incidence;
using mechanics::MechanicsError;
using mechanics::NetworkValues;

namespace {

// Real part of an eigenvalue over the largest modulus; a smaller one means no damping.
constexpr double kLeastDamping = 1e-12;

double along(const std::vector<double>& gradient, const std::vector<double>& direction) {
  double sum = 0.0;
  for (std::size_t i = 0; i < direction.size(); ++i) sum += gradient[i] * direction[i];
  return sum;
}

}  // namespace

// In the state's natural units, z = scale * z^: displacements by 1/sqrt(K_ii), velocities by 1/sqrt(M_ii),
// Maxwell forces by sqrt(k_e), so that every z^2 is an energy.
struct Variance::State {
  mechanics::LinearSystem system;
  MatrixXd M_inverse;
  VectorXd b;  // M v' = ... + b w
  VectorXd scale;
  MatrixXd A;
  VectorXd B, h;
};

struct Variance::Gradient {
  std::vector<double> mass, element, second;
  MatrixXd damping;  // by C
};

Variance::Variance(const mechanics::Network& network, const Noise& noise, const NoisyQuantity& measure)
    : assembly_(network), noise_(noise), measure_(measure) {
  if (const Element* unfit = mechanics::element_unfit_for_noise(network)) {
    throw MechanicsError("element '" + unfit->name + "' is " + mechanics::kind_of(*unfit).name +
                         ": the variance under white noise needs linear elements with constant values");
  }
  if (!network.joints.empty())
    throw MechanicsError("joint '" + network.joints.front() +
                         "': the variance under white noise needs a mass at every node");
  find_drifting_motion();
  check_drift();
  if (!(noise.intensity > 0.0 && std::isfinite(noise.intensity))) {
    throw MechanicsError("the intensity of the noise must be finite and positive");
  }
}

// The motion r of the masses that follows the support's unit displacement. What is held between two nodes
// moves by 1; levers move their ends so that they are not strained either: w^T r + p = 0.
void Variance::find_drifting_motion() {
  const mechanics::Network& network = assembly_.network();
  drifting_ = VectorXd::Ones(Index(network.masses.size()));
  if (noise_.kind == NoiseKind::force_on) return;
  for (std::size_t i = 0; i < network.masses.size(); ++i)
    if (mechanics::rotates(network, i)) drifting_[Index(i)] = 0.0;
  MatrixXd A = MatrixXd::Zero(Index(network.elements.size()), drifting_.size());
  VectorXd strain = VectorXd::Zero(A.rows());
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (!mechanics::kind_of(network.elements[e]).holds) continue;
    A.row(Index(e)) = assembly_.incidences()[e].w.transpose();
    if (!mechanics::is_between_two_nodes(network.elements[e].along))
      strain[Index(e)] = drift(assembly_.incidences()[e]);
  }
  if (!strain.isZero(0.0)) drifting_ -= algebra::shortest_solution(A, strain);
}

// Coefficient of the moving support's displacement in the displacement of an element, in coordinates relative
// to the motion that follows it: not 0 where the element joins the ground or another support. (A force leaves
// every support at rest: no drift.)
double Variance::drift(const Incidence& at) const {
  if (noise_.kind == NoiseKind::force_on) return 0.0;
  const double own = at.w.dot(drifting_), support = at.p[Index(noise_.node)];
  constexpr double kRounding = 1e-12;
  const double size = at.w.cwiseProduct(drifting_).cwiseAbs().sum() + std::abs(support);
  return std::abs(own + support) > kRounding * size ? own + support : 0.0;
}

void Variance::check_drift() const {
  const auto& elements = assembly_.network().elements;
  if (noise_.kind != NoiseKind::force_on && !assembly_.network().matrices.empty()) {
    throw MechanicsError("the matrices '" + assembly_.network().matrices.front().name +
                         "' hold to the ground, from which '" + assembly_.network().prescribed[noise_.node] +
                         "' drifts without limit under white noise of its acceleration");
  }
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (drift(assembly_.incidences()[e]) == 0.0) continue;
    const bool measured = measure_.kind == NoisyKind::stroke && measure_.index == e;
    if (mechanics::kind_of(elements[e]).is_inertia_alone() && !measured) continue;
    throw MechanicsError("element '" + elements[e].name +
                         "' joins the ground or a support at rest, from which '" +
                         assembly_.network().prescribed[noise_.node] +
                         "' drifts without limit under white noise of its acceleration: only an inerter may");
  }
}

Variance::State Variance::state(const NetworkValues& values) const {
  State result;
  mechanics::LinearSystem& system = result.system;
  assembly_.set_values(values, system);
  const Index n = system.masses(), s = system.internal_forces();
  result.M_inverse = algebra::solve_positive(system.M, MatrixXd(MatrixXd::Identity(n, n)));

  // b = e_mass, or with q = x + r y and y'' = w:  b = -(M r + M_support e_node)
  if (noise_.kind == NoiseKind::force_on) {
    result.b = VectorXd::Unit(n, Index(noise_.node));
  } else {
    result.b = -(system.M * drifting_ + system.M_support.col(Index(noise_.node)));
  }

  // v' = -M^-1 (K q + C v + D s) + M^-1 b w,   s_e' = k_e d_e^T v - (k_e/c_e) s_e
  const MatrixXd& Mi = result.M_inverse;
  MatrixXd A = MatrixXd::Zero(2 * n + s, 2 * n + s);
  A.block(0, n, n, n).setIdentity();
  A.block(n, 0, n, n) = -Mi * system.K;
  A.block(n, n, n, n) = -Mi * system.C;
  A.block(n, 2 * n, n, s) = -Mi * system.D;
  A.block(2 * n, n, s, n) = system.internal_stiffness.asDiagonal() * system.D.transpose();
  A.block(2 * n, 2 * n, s, s).diagonal() = -system.internal_rate;
  VectorXd B = VectorXd::Zero(2 * n + s), h = VectorXd::Zero(2 * n + s);
  B.segment(n, n) = Mi * result.b;
  h.head(n) = measure_.kind == NoisyKind::displacement
                  ? mechanics::coordinate_incidence(assembly_.network(), measure_.index).w
                  : assembly_.incidences()[measure_.index].w;

  result.scale.resize(2 * n + s);
  result.scale << system.K.diagonal().cwiseSqrt().cwiseInverse(),
      system.M.diagonal().cwiseSqrt().cwiseInverse(), system.internal_stiffness.cwiseSqrt();
  result.A = result.scale.cwiseInverse().asDiagonal() * A * result.scale.asDiagonal();
  result.B = B.cwiseQuotient(result.scale);
  result.h = h.cwiseProduct(result.scale);
  return result;
}

double Variance::mean_square(const NetworkValues& values) const {
  return mean_square(values, {}, {});
}

double Variance::mean_square(const NetworkValues& values, const std::vector<NetworkValues>& directions,
                             std::span<double> slopes) const {
  const State at = state(values);
  const Lyapunov lyapunov(at.A);
  if (!(lyapunov.abscissa() < -kLeastDamping)) {
    throw MechanicsError(
        "some mode of the system is not damped: its mean square under white noise is infinite");
  }
  const MatrixXd P = lyapunov.solve(2.0 * std::numbers::pi * noise_.intensity * at.B * at.B.transpose());
  const double result = at.h.dot(P * at.h);
  if (directions.empty()) return result;
  const Gradient by = gradient(at, values, P, lyapunov.solve_adjoint(at.h * at.h.transpose()));
  for (std::size_t k = 0; k < directions.size(); ++k) {
    slopes[k] = along(by.mass, directions[k].mass) + along(by.element, directions[k].element) +
                along(by.second, directions[k].second);
    if (!mechanics::has_structural_damping(assembly_.network())) continue;
    mechanics::LinearSystem change;
    mechanics::differentiate_matrices(assembly_, values, directions[k], at.system, change);
    const Index n = at.system.masses();
    slopes[k] += by.damping.cwiseProduct(change.structural_damping.topLeftCorner(n, n)).sum();
  }
  return result;
}

// d(h^T P h) = 2 tr(dA P Q) + 2 (2 pi S_0) B^T Q dB. With G = P Q and, of M dv/dt, dA_v = -M^-1 (dK, dC, dD)
// - M^-1 dM A_v and dB_v = M^-1 (db - dM B_v), every term is a quadratic form of an element's direction.
Variance::Gradient Variance::gradient(const State& at, const NetworkValues& values, const MatrixXd& P,
                                      const MatrixXd& Q) const {
  const mechanics::Network& network = assembly_.network();
  const Index n = at.system.masses();
  // Back in the units of z.
  const MatrixXd G = at.scale.asDiagonal() * P * Q * at.scale.cwiseInverse().asDiagonal();
  const MatrixXd A_v = (at.scale.asDiagonal() * at.A * at.scale.cwiseInverse().asDiagonal()).middleRows(n, n);
  const VectorXd B_v = at.M_inverse * at.b;
  const VectorXd QB = (Q * at.B).cwiseQuotient(at.scale);
  const double density = 2.0 * std::numbers::pi * noise_.intensity;

  const MatrixXd by_stiffness = -2.0 * G.block(0, n, n, n) * at.M_inverse;  // w^T (...) w
  const MatrixXd by_damping = -2.0 * G.block(n, n, n, n) * at.M_inverse;
  const VectorXd by_b = 2.0 * density * at.M_inverse * QB.segment(n, n);  // (...)^T db
  const MatrixXd by_inertia = -2.0 * A_v * G.middleCols(n, n) * at.M_inverse - B_v * by_b.transpose();
  const bool moved = noise_.kind == NoiseKind::acceleration_of;

  Gradient by{std::vector<double>(network.masses.size()), std::vector<double>(network.elements.size()),
              std::vector<double>(network.elements.size()), by_damping};
  for (Index i = 0; i < n; ++i) {
    by.mass[std::size_t(i)] = by_inertia(i, i) - (moved ? by_b[i] * drifting_[i] : 0.0);
  }
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Incidence& incidence = assembly_.incidences()[e];
    const VectorXd& w = incidence.w;
    const Index internal = at.system.coefficients[e].internal, row = 2 * n + internal;
    const auto along_change = [&](const mechanics::Added<Dual>& change) {
      const double slope =
          change.stiffness.derivative * w.dot(by_stiffness * w) +
          change.damping.derivative * w.dot(by_damping * w) +
          change.inertance.derivative * (w.dot(by_inertia * w) - drift(incidence) * by_b.dot(w));
      if (internal < 0) return slope;
      // s' = k w^T v - rate s
      return slope + 2.0 * (change.internal_stiffness.derivative * G.col(row).segment(n, n).dot(w) -
                            change.internal_rate.derivative * G(row, row));
    };
    const ElementKind& kind = mechanics::kind_of(network.elements[e]);
    const double value = values.element[e], second = mechanics::second_value(values, e);
    constexpr Dual any_frequency{1.0, 0.0};  // what depends on it was refused at construction
    by.element[e] = along_change(kind.adds(Dual{value, 1.0}, Dual{second, 0.0}, any_frequency));
    by.second[e] = along_change(kind.adds(Dual{value, 0.0}, Dual{second, 1.0}, any_frequency));
  }
  return by;
}

}  // namespace frahm::tuning
