#include "solvers/algebra/kernels_once.hpp"

namespace Eigen::internal {

FRAHM_KERNELS()

}  // namespace Eigen::internal
