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

  Eigen::Index rows() const { return static_cast<Eigen::Index>(start.size()) - 1; }
};
using SparseRows = RowsOf<double>;
// each(column, value) of the entries of row i
template <class Real, class Each>
void for_each_entry(const RowsOf<Real>& rows, int i, const Each& each) {
  const auto row = static_cast<std::size_t>(i);
  for (auto e = static_cast<std::size_t>(rows.start[row]); e < static_cast<std::size_t>(rows.start[row + 1]);
       ++e)
    each(rows.column[e], rows.value[e]);
}
SparseRows sparse_rows(const Eigen::MatrixXd& matrix);
SparseRows rows_alone(const Eigen::MatrixXd& matrix);  // for sums of rows, not for products

// n masses, m contacts, s internal forces; time in steps, as in StepEquations.
template <class Real>
struct SystemOf {
  using Rows = RowsOf<Real>;

  Rows stiffness, damping, internal;  // M^-1 K, M^-1 C (n x n), M^-1 D (n x s)
  Rows contacts;                      // M^-1 W (n x m)
  Rows directions, stretch;           // W^T (m x n), D^T (s x n)
  // W^T M^-1 (K, C, D) (m x n, m x n, m x s), in double precision alone
  Rows contact_stiffness, contact_damping, contact_internal;
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

// force x c of the held contacts, zero of the others. c: of every contact
Eigen::VectorXd forces_of(const HeldContacts& held, const Eigen::VectorXd& c);

// Accelerations a that keep the held contacts at rest: a - M^-1 W force (W^T a + support), of one motion.
// support: p^T y'' of every contact; null: no contact rubs on a moving support.
void keep(const SparseSystem& system, const HeldContacts& held, const double* support, double* a);

// a = -P M^-1 (K q + C v + D s) and s' = spring D^T v - rate s, of one motion.
void pull(const SparseSystem& system, const HeldContacts& held, const double* q, const double* v,
          const double* s, double* a, double* ds);

}  // namespace frahm::periodic
