#pragma once

#include <Eigen/Core>
#include <span>

#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/mechanics/linear_system.hpp"

// Directions in which no spring holds the masses. They are found from the elements, each of which strains
// one combination of the displacements or none: not from eigenvalues of K, of which rounding leaves some
// parts of 1e-16 where there are none.
namespace frahm::mechanics {

// An eigenvalue of a part's stiffness matrix, scaled by its diagonal, that counts as zero: a program has
// written the matrix with ten digits or more.
inline constexpr double kNoStiffness = 1e-10;

// Combinations of displacements, scaled to length 1, that differ by less are the same: factors of levers and
// the modes of a structure's damping have rounding.
inline constexpr double kSameDirection = 1e-12;

// The directions in which a part given by its stiffness matrix K is strained, a row of length 1 for each;
// k x n.
Eigen::MatrixXd strained_by(const Eigen::MatrixXd& K);
// K without what counts as zero.
Eigen::MatrixXd without_rounding(const Eigen::MatrixXd& K);

// The combinations of displacements that the springs and matrices of a system strain: rows, k x n. more: of
// each element what acts in addition to its stiffness [N/m]; may be empty.
Eigen::MatrixXd strained_combinations(const Assembly& assembly, const LinearSystem& system,
                                      std::span<const double> more = {});

// The combinations of velocities at which dampers, Maxwell elements and the structure dissipate: rows, k x n.
// more: of each element what acts in addition to its damping [N s/m]; may be empty.
Eigen::MatrixXd damped_combinations(const Assembly& assembly, const LinearSystem& system,
                                    std::span<const double> more = {});

// A basis X, n x r, of the displacements x with A x = 0, orthonormal with X^T M X = 1. A: rows of length 1, k
// x n.
Eigen::MatrixXd free_of(const Eigen::MatrixXd& A, const Eigen::MatrixXd& M);

// W^T R: how directions w_j, columns n x k, are strained along free directions; k x r, exactly zero where
// they are not.
Eigen::MatrixXd strained_along(const Eigen::MatrixXd& W, const Eigen::MatrixXd& R);

// Those coordinates c of unit size and right angles, columns r x k, that rows A, k x r, do not strain: A c =
// 0. Entries of A are zero exactly or at least kSameDirection.
Eigen::MatrixXd unstrained(const Eigen::MatrixXd& A);

// A basis of those x = B y that are orthogonal to R in the product of M, R^T M x = 0; n x (b - r). R: within
// B.
Eigen::MatrixXd beside(const Eigen::MatrixXd& R, const Eigen::MatrixXd& B, const Eigen::MatrixXd& M);

// The free directions of all masses (LinearSystem::free_directions), n x r; without columns where springs
// hold everything.
Eigen::MatrixXd find_free_directions(const Assembly& assembly, const LinearSystem& system);

// Whether a network has springs enough to hold all masses, if each has a stiffness: else some are free.
bool may_have_free_masses(const Network& network);

// Whether there are any at these values, which is faster to tell than all their matrices.
bool has_free_masses(const Assembly& assembly, const NetworkValues& values);

// K with weak springs in the free directions, positive definite where K is definite beside them.
Eigen::MatrixXd held_stiffness(const LinearSystem& system);

// The displacements under forces, of which what pushes along free directions R meets springs there that make
// them swing at `rate` [rad/s]:  (K + rate^2 M R R^T M)^-1.
Eigen::MatrixXd held_compliance(const LinearSystem& system, double rate);

// The modes K v = lambda M v, v^T M v = 1, ascending, of a stiffness that is zero in the directions R, R^T M
// R = 1: these come first, with lambda = 0 exactly.
algebra::SymmetricModes modes_with_free(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                                        const Eigen::MatrixXd& R);
// Of a system.
algebra::SymmetricModes undamped_modes_of(const LinearSystem& system);

}  // namespace frahm::mechanics
