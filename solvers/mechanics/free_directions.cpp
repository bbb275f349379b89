#include "solvers/mechanics/free_directions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/joints.hpp"
#include "solvers/mechanics/structural_damping.hpp"

namespace frahm::mechanics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// K = S V lambda V^T S, S^2 the diagonal of K (1 where it is zero).
struct ScaledModes {
  Eigen::VectorXd scale;
  algebra::SymmetricModes modes;
};
ScaledModes scaled_modes(const MatrixXd& K) {
  ScaledModes result;
  result.scale = (K.diagonal().array() > 0.0)
                     .select(K.diagonal().cwiseAbs().cwiseSqrt(), Eigen::VectorXd::Ones(K.rows()));
  const Eigen::VectorXd inverse = result.scale.cwiseInverse();
  result.modes = algebra::symmetric_modes(MatrixXd(inverse.asDiagonal() * K * inverse.asDiagonal()));
  return result;
}

// Rows that are collected one by one.
class Rows {
 public:
  explicit Rows(Index columns) : columns_(columns) {}

  void add(const Eigen::VectorXd& row) {
    if (const double length = row.norm(); length > 0.0) rows_.push_back(row / length);
  }
  void add(const MatrixXd& rows, std::span<const std::size_t> places) {
    for (Index i = 0; i < rows.rows(); ++i) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(columns_);
      for (std::size_t j = 0; j < places.size(); ++j)
        row[static_cast<Index>(places[j])] += rows(i, static_cast<Index>(j));
      add(row);
    }
  }
  MatrixXd matrix() const {
    MatrixXd all(static_cast<Index>(rows_.size()), columns_);
    for (std::size_t i = 0; i < rows_.size(); ++i) all.row(static_cast<Index>(i)) = rows_[i].transpose();
    return all;
  }

 private:
  Index columns_;
  std::vector<Eigen::VectorXd> rows_;
};

// Whether what an element and its bends add is more than the rounding of their sum.
bool acts(double own, double more) {
  constexpr double kRounding = 1e-12;
  return std::abs(own + more) > kRounding * (std::abs(own) + std::abs(more));
}

double more_of(std::span<const double> more, std::size_t element) {
  return more.empty() ? 0.0 : more[element];
}

// Whether springs between two nodes each join every mass to the ground or to a support; joints are not asked.
bool are_chained(const Network& network, const LinearSystem& system) {
  if (!network.joints.empty()) return false;
  const std::size_t held = network.masses.size();
  std::vector<std::size_t> parent(held + 1);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto set_of = [&](const Node& node) { return node.kind == NodeKind::mass ? node.index : held; };
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Direction& along = network.elements[e].along;
    if (system.coefficients[e].stiffness == 0.0 || !is_between_two_nodes(along)) continue;
    parent[root(set_of(along[0].node))] = root(set_of(along[1].node));
  }
  for (std::size_t i = 0; i < held; ++i) {
    if (root(i) != root(held)) return false;
  }
  return true;
}

}  // namespace

Eigen::MatrixXd strained_by(const MatrixXd& K) {
  const auto [scale, modes] = scaled_modes(K);
  Rows rows(K.rows());
  for (Index k = 0; k < K.rows(); ++k) {
    if (std::abs(modes.values[k]) > kNoStiffness) rows.add(scale.asDiagonal() * modes.vectors.col(k));
  }
  return rows.matrix();
}

Eigen::MatrixXd without_rounding(const MatrixXd& K) {
  const auto [scale, modes] = scaled_modes(K);
  if (modes.values.cwiseAbs().minCoeff() > kNoStiffness) return K;
  const Eigen::VectorXd kept = (modes.values.array().abs() > kNoStiffness).select(modes.values, 0.0);
  const MatrixXd clean = modes.vectors * kept.asDiagonal() * modes.vectors.transpose();
  return scale.asDiagonal() * MatrixXd(0.5 * (clean + clean.transpose())) * scale.asDiagonal();
}

Eigen::MatrixXd strained_combinations(const Assembly& assembly, const LinearSystem& system,
                                      std::span<const double> more) {
  const Network& network = assembly.network();
  Rows rows(static_cast<Index>(network.masses.size()));
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (acts(system.coefficients[e].stiffness, more_of(more, e)))
      rows.add(at_rest(system, assembly.incidences()[e]));
  }
  for (const MatrixPart& part : network.matrices) rows.add(strained_by(part.stiffness), part.nodes);
  return rows.matrix();
}

Eigen::MatrixXd damped_combinations(const Assembly& assembly, const LinearSystem& system,
                                    std::span<const double> more) {
  const Network& network = assembly.network();
  Rows rows(static_cast<Index>(network.masses.size()));
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const ElementCoefficients& law = system.coefficients[e];
    if (acts(law.damping, more_of(more, e)) || law.internal_damping != 0.0)
      rows.add(at_rest(system, assembly.incidences()[e]));
  }
  const MatrixXd rates = structural_rates(system);
  for (Index i = 0; i < rates.rows(); ++i)
    rows.add(Eigen::VectorXd(rates.row(i).head(system.masses()).transpose()));
  return rows.matrix();
}

Eigen::MatrixXd free_of(const MatrixXd& A, const MatrixXd& M) {
  MatrixXd X = MatrixXd::Identity(A.cols(), A.cols());
  if (A.rows() > 0) {
    Eigen::FullPivLU<MatrixXd> factor(A);
    factor.setThreshold(kSameDirection);
    if (factor.dimensionOfKernel() == 0) return MatrixXd(A.cols(), 0);
    X = factor.kernel();
  }
  const Eigen::LLT<MatrixXd> root(X.transpose() * M * X);
  return root.matrixL().solve(X.transpose()).transpose();
}

Eigen::MatrixXd strained_along(const MatrixXd& W, const MatrixXd& R) {
  const MatrixXd strain = W.transpose() * R, size = W.cwiseAbs().transpose() * R.cwiseAbs();
  return (strain.array().abs() > kSameDirection * size.array()).select(strain, 0.0);
}

Eigen::MatrixXd unstrained(const MatrixXd& A) {
  const Index r = A.cols();
  if (A.rows() == 0 || A.isZero(0.0)) return MatrixXd::Identity(r, r);
  Eigen::FullPivLU<MatrixXd> factor(A);
  factor.setThreshold(kSameDirection);
  const Index free = factor.dimensionOfKernel();
  if (free == 0) return MatrixXd(r, 0);
  return Eigen::HouseholderQR<MatrixXd>(factor.kernel()).householderQ() * MatrixXd::Identity(r, free);
}

Eigen::MatrixXd beside(const MatrixXd& R, const MatrixXd& B, const MatrixXd& M) {
  return B * algebra::null_space(R.transpose() * M * B);
}

Eigen::MatrixXd find_free_directions(const Assembly& assembly, const LinearSystem& system) {
  const Index n = system.masses();
  if (are_chained(assembly.network(), system)) return MatrixXd(n, 0);
  return free_of(strained_combinations(assembly, system), system.M);
}

// With joints as coordinates of their own, which springs all hold.
bool may_have_free_masses(const Network& network) {
  const auto n = static_cast<Index>(network.masses.size()), j = static_cast<Index>(network.joints.size());
  Rows rows(n + j);
  for (const Element& element : network.elements) {
    if (!kind_of(element).holds) continue;
    const Incidence at = incidence(network, element);
    Eigen::VectorXd row(n + j);
    row << at.w, at.j;
    rows.add(row);
  }
  for (const MatrixPart& part : network.matrices) rows.add(strained_by(part.stiffness), part.nodes);
  return free_of(rows.matrix(), MatrixXd::Identity(n + j, n + j)).cols() > 0;
}

bool has_free_masses(const Assembly& assembly, const NetworkValues& values) {
  if (!assembly.network().joints.empty()) return may_have_free_masses(assembly.network());
  const auto& elements = assembly.network().elements;
  const auto n = static_cast<Index>(assembly.network().masses.size());
  LinearSystem springs;
  springs.M.setIdentity(n, n);
  for (std::size_t e = 0; e < elements.size(); ++e)
    springs.coefficients.push_back(
        {.stiffness = kind_of(elements[e]).adds(values.element[e], second_value(values, e), 1.0).stiffness});
  return find_free_directions(assembly, springs).cols() > 0;
}

// As weak as the weakest spring on the masses of each direction, so that none is lost in rounding.
Eigen::MatrixXd held_stiffness(const LinearSystem& system) {
  constexpr double kNoShare = 1e-9;
  MatrixXd K = system.K;
  for (Index k = 0; k < system.free_directions.cols(); ++k) {
    const Eigen::VectorXd r =
        system.free_directions.col(k) / system.free_directions.col(k).cwiseAbs().maxCoeff();
    double weakest = 0.0;
    for (Index i = 0; i < r.size(); ++i) {
      const double own = system.K(i, i);
      if (std::abs(r[i]) > kNoShare && own > 0.0 && (weakest == 0.0 || own < weakest)) weakest = own;
    }
    K += (weakest > 0.0 ? weakest : 1.0) * r * r.transpose();
  }
  return K;
}

// P K_held^-1 P^T + R R^T/rate^2,  P = 1 - R R^T M.
Eigen::MatrixXd held_compliance(const LinearSystem& system, double rate) {
  const MatrixXd& R = system.free_directions;
  const Index n = system.masses();
  const MatrixXd P = MatrixXd::Identity(n, n) - R * (R.transpose() * system.M);
  return P * algebra::inverse(held_stiffness(system)) * P.transpose() + R * R.transpose() / (rate * rate);
}

algebra::SymmetricModes modes_with_free(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R) {
  const Index n = K.rows(), r = R.cols();
  if (r == 0) return algebra::symmetric_modes(K, M);
  algebra::SymmetricModes result{Eigen::VectorXd::Zero(n), MatrixXd(n, n)};
  result.vectors.leftCols(r) = R;
  if (r == n) return result;
  const MatrixXd M_R = M * R;
  const MatrixXd Q = MatrixXd(Eigen::HouseholderQR<MatrixXd>(M_R).householderQ() * MatrixXd::Identity(n, n))
                         .rightCols(n - r);
  const algebra::SymmetricModes elastic =
      algebra::symmetric_modes(Q.transpose() * K * Q, Q.transpose() * M * Q);
  result.values.tail(n - r) = elastic.values;
  result.vectors.rightCols(n - r) = Q * elastic.vectors;
  return result;
}

algebra::SymmetricModes undamped_modes_of(const LinearSystem& system) {
  return modes_with_free(system.K, system.M, system.free_directions);
}

}  // namespace frahm::mechanics
