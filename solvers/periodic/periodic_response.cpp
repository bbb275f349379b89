#include "solvers/periodic/periodic_response.hpp"

#include "solvers/periodic/response_solver.hpp"

namespace frahm::periodic {
namespace {

// A solver whose sizes are known at compile time where there is one for this network.
std::unique_ptr<ResponseSolver> make_solver(const mechanics::Network& network,
                                            std::vector<Quantity> quantities) {
  const mechanics::Assembly assembly(network);
  const std::size_t masses = network.masses.size(), harmonics = assembly.orders().size();
  if (assembly.contacts() <= Sizes<1, 1>::kMaxContacts && assembly.maxwell_elements() == 0) {
    if (masses == 1 && harmonics == 1)
      return std::make_unique<SizedSolver<1, 1>>(network, std::move(quantities));
    if (masses == 1 && harmonics == 2)
      return std::make_unique<SizedSolver<1, 2>>(network, std::move(quantities));
    if (masses == 2 && harmonics == 1)
      return std::make_unique<SizedSolver<2, 1>>(network, std::move(quantities));
  }
  return std::make_unique<SizedSolver<Eigen::Dynamic, Eigen::Dynamic>>(network, std::move(quantities));
}

}  // namespace

PeriodicResponse::PeriodicResponse(const mechanics::Network& network, std::vector<Quantity> quantities)
    : solver_(make_solver(network, std::move(quantities))) {}
PeriodicResponse::~PeriodicResponse() = default;
PeriodicResponse::PeriodicResponse(PeriodicResponse&&) noexcept = default;
PeriodicResponse& PeriodicResponse::operator=(PeriodicResponse&&) noexcept = default;

void PeriodicResponse::set_values(const mechanics::NetworkValues& values) {
  solver_->set_values(values);
}
void PeriodicResponse::set_forcing(const mechanics::NetworkValues& values) {
  solver_->set_forcing(values);
}
void PeriodicResponse::forget() {
  solver_->forget();
}
void PeriodicResponse::begin_row() {
  solver_->begin_row();
}
const ResponseSummary& PeriodicResponse::solve() {
  return solver_->solve();
}
void PeriodicResponse::quantities(std::span<double> out) {
  solver_->quantities(out);
}
History PeriodicResponse::history(std::size_t samples) {
  return solver_->history(samples);
}
std::vector<Stretch> PeriodicResponse::stretches() const {
  return solver_->stretches();
}

}  // namespace frahm::periodic
