#include "solvers/exact/exact_solver.hpp"

#include "solvers/exact/sized_solver.hpp"

namespace frahm::periodic {

std::unique_ptr<ResponseSolver> make_exact_solver(const mechanics::Network& network,
                                                  const std::vector<Quantity>& quantities, Path path,
                                                  const OrbitsWanted& wanted) {
  const mechanics::Assembly assembly(network, mechanics::FreeMasses::allowed);
  const std::size_t masses = network.masses.size(), harmonics = assembly.orders().size();
  const bool is_small = assembly.contacts() <= Sizes<1, 1>::kMaxContacts &&
                        assembly.bends().count() <= Sizes<1, 1>::kMaxContacts &&
                        assembly.internal_forces() == 0 && network.joints.empty();
  if (is_small && harmonics == 1 && masses == 1)
    return std::make_unique<SizedSolver<1, 1>>(network, quantities, path, wanted);
  if (is_small && harmonics == 1 && masses == 2)
    return std::make_unique<SizedSolver<2, 1>>(network, quantities, path, wanted);
  return std::make_unique<SizedSolver<Eigen::Dynamic, Eigen::Dynamic>>(network, quantities, path, wanted);
}

}  // namespace frahm::periodic
