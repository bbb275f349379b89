#pragma once

#include <Eigen/Core>
#include <vector>

// A large system by the entries of its matrices that are not zero: in a building each storey feels its
// neighbours alone. Its Taylor series come from the equation of motion itself, coefficient by coefficient,
// so that a set of stuck contacts costs one small inverse, and no table over all states.
namespace frahm::periodic {

// A matrix by rows: entries [start[i], start[i + 1]) are those of row i. Products take the form that suits
// best.
template <class Real>
struct RowsOf {
  struct Diagonal {
    int offset = 0;           // of the columns from the rows
    std::vector<Real> value;  // of each row from `first` on
    int first = 0;
    int end() const { return first + static_cast<int>(value.size()); }
  };

  std::vector<int> start, column;
  std::vector<Real> value;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>
      full;                         // where few entries are zero: damping by modes, imported matrices
  std::vector<Diagonal> diagonals;  // of a square matrix, where they are few: a chain of storeys

  // sum += scale x row i
  void add_row(int i, double scale, double* sum) const {
    const auto row = static_cast<std::size_t>(i);
    for (int e = start[row]; e < start[row + 1]; ++e)
      sum[column[static_cast<std::size_t>(e)]] += scale * value[static_cast<std::size_t>(e)];
  }
  Eigen::Index rows() const { return static_cast<Eigen::Index>(start.size()) - 1; }
};
using SparseRows = RowsOf<double>;
SparseRows sparse_rows(const Eigen::MatrixXd& matrix);
SparseRows rows_alone(const Eigen::MatrixXd& matrix);  // for sums of rows, not for products

// n masses, m contacts, s internal forces; time in steps, as in StepEquations.
template <class Real>
struct SystemOf {
  using Rows = RowsOf<Real>;

  Rows stiffness, damping, internal;                     // M^-1 K, M^-1 C (n x n), M^-1 D (n x s)
  Rows contacts;                                         // M^-1 W (n x m)
  Rows directions, stretch;                              // W^T (m x n), D^T (s x n)
  Rows pull_by_displacement, pull_by_velocity;           // W^T M^-1 K, W^T M^-1 C (m x n)
  Rows bend_directions, bend_pull;                       // B^T, (M^-1 B)^T of the bends (number x n)
  Eigen::Matrix<Real, Eigen::Dynamic, 1> internal_rate;  // size s
  bool is_chain =
      false;  // stiffness and damping have the three diagonals about the main one, and no other entry

  Eigen::Index masses() const { return stiffness.rows(); }
  Eigen::Index contacts_count() const { return directions.rows(); }
  Eigen::Index internal_forces() const { return stretch.rows(); }
};
using SparseSystem = SystemOf<double>;
SparseSystem sparse_system(const Eigen::MatrixXd& M_inverse, const Eigen::MatrixXd& K,
                           const Eigen::MatrixXd& C, const Eigen::MatrixXd& D, const Eigen::MatrixXd& W,
                           const Eigen::VectorXd& rate);

// A bend that is passed: what it adds (StepBends).
template <class Real>
struct BeyondBend {
  int index = 0;
  Real stiffness = 0, damping = 0;
};

// The contacts that hold their velocity, and the force that each takes per relative acceleration of all:
// lambda = force (W^T a + p^T y''), force = G^-1 over them.
template <class Real>
struct HeldOf {
  std::vector<int> list;
  RowsOf<Real> force;
  bool hold_all = false;                          // no mass can move
  Eigen::Matrix<Real, Eigen::Dynamic, 1> spring;  // of each internal force: k, or 0 while it is held
  std::vector<BeyondBend<Real>> beyond;
};
using HeldContacts = HeldOf<double>;

// The same numbers in single precision.
SystemOf<float> in_single_precision(const SparseSystem& system);
HeldOf<float> in_single_precision(const HeldContacts& held);

// Accelerations a that keep the held contacts at rest: a - M^-1 W lambda, of one motion.
void keep(const SparseSystem& system, const HeldContacts& held, double* a);

// a = -P M^-1 (K q + C v + D s) and s' = spring D^T v - rate s, of one motion.
void pull(const SparseSystem& system, const HeldContacts& held, const double* q, const double* v,
          const double* s, double* a, double* ds);

}  // namespace frahm::periodic
