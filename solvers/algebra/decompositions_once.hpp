#pragma once

#include <Eigen/Dense>

// Decompositions of run-time sized matrices that are used in several files, compiled once in
// decompositions_once.cpp: as with kernels_once.hpp, no file needs to include this.
namespace Eigen {

extern template class ColPivHouseholderQR<MatrixXd>;
extern template class PartialPivLU<MatrixXd>;
extern template class PartialPivLU<MatrixXcd>;

}  // namespace Eigen
