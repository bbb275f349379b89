#include "solvers/algebra/decompositions_once.hpp"

namespace Eigen {

template class ColPivHouseholderQR<MatrixXd>;
template class PartialPivLU<MatrixXd>;
template class PartialPivLU<MatrixXcd>;

}  // namespace Eigen
