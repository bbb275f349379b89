#pragma once

#include <Eigen/Core>
#include <vector>

// A large system by the entries of its matrices that are not zero: in a building each storey feels its
// neighbours alone. Its Taylor series come from the equation of motion itself, coefficient by coefficient,
// so that a set of stuck contacts costs one small inverse, and no table over all states.
namespace frahm::periodic {

// A matrix by rows: entries [start[i], start[i + 1]) are those of row i. Products take the form that suits
// best.
struct SparseRows {
  struct Diagonal {
    int offset = 0;             // of the columns from the rows
    std::vector<double> value;  // of each row from `first` on
    int first = 0;
  };

  std::vector<int> start, column;
  std::vector<double> value;
  Eigen::MatrixXd full;             // where few entries are zero: damping by modes, imported matrices
  std::vector<Diagonal> diagonals;  // of a square matrix, where they are few: a chain of storeys

  static SparseRows of(const Eigen::MatrixXd& matrix);
  static SparseRows rows_of(const Eigen::MatrixXd& matrix);  // for sums of rows, not for products
  // sum += scale x row i
  void add_row(int i, double scale, double* sum) const;
  Eigen::Index rows() const { return static_cast<Eigen::Index>(start.size()) - 1; }
};

// n masses, m contacts, s internal forces; time in steps, as in StepEquations.
struct SparseSystem {
  SparseRows stiffness, damping, internal;            // M^-1 K, M^-1 C (n x n), M^-1 D (n x s)
  SparseRows contacts;                                // M^-1 W (n x m)
  SparseRows directions, stretch;                     // W^T (m x n), D^T (s x n)
  SparseRows pull_by_displacement, pull_by_velocity;  // W^T M^-1 K, W^T M^-1 C (m x n)
  SparseRows bend_directions, bend_pull;              // B^T, (M^-1 B)^T of the bends (number x n)
  Eigen::MatrixXd mobility;                           // G = W^T M^-1 W (m x m)
  Eigen::VectorXd internal_rate;                      // size s

  void set(const Eigen::MatrixXd& M_inverse, const Eigen::MatrixXd& K, const Eigen::MatrixXd& C,
           const Eigen::MatrixXd& D, const Eigen::MatrixXd& W, const Eigen::VectorXd& rate);
  Eigen::Index masses() const { return stiffness.rows(); }
  Eigen::Index internal_forces() const { return stretch.rows(); }
};

// A bend that is passed: what it adds (StepBends).
struct BeyondBend {
  int index = 0;
  double stiffness = 0.0, damping = 0.0;
};

// The contacts that hold their velocity, and the force that each takes per relative acceleration of all:
// lambda = force (W^T a + p^T y''), force = G^-1 over them.
struct HeldContacts {
  std::vector<int> list;
  SparseRows force;
  bool hold_all = false;   // no mass can move
  Eigen::VectorXd spring;  // of each internal force: k, or 0 while it is held
  std::vector<BeyondBend> beyond;
};

// Accelerations a that keep the held contacts at rest: a - M^-1 W lambda, of one motion.
void keep(const SparseSystem& system, const HeldContacts& held, double* a);

// a = -P M^-1 (K q + C v + D s) and s' = spring D^T v - rate s, of one motion.
void pull(const SparseSystem& system, const HeldContacts& held, const double* q, const double* v,
          const double* s, double* a, double* ds);

// Each column of `states` (2n + s rows) moved on by `steps` of the homogeneous flow.
void propagate(const SparseSystem& system, const HeldContacts& held, double steps, Eigen::MatrixXd& states);

}  // namespace frahm::periodic
