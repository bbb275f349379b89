#include "solvers/response/periodic_response.hpp"

#include "solvers/exact/exact_solver.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "solvers/response/common_divisor.hpp"
#include "solvers/smooth/smooth_solver.hpp"

namespace frahm::periodic {
namespace {

// A solver of the network's law.
std::unique_ptr<ResponseSolver> make_solver(const mechanics::Network& network,
                                            const std::vector<Quantity>& quantities, Path path,
                                            const OrbitsWanted& wanted) {
  if (mechanics::has_smooth_law(network)) return smooth::make_solver(network, quantities, wanted);
  return make_exact_solver(network, quantities, path, wanted);
}

std::unique_ptr<ResponseSolver> make_divided_solver(const mechanics::Network& network,
                                                    const std::vector<Quantity>& quantities, Path path,
                                                    const OrbitsWanted& wanted) {
  return divide_orders(network, quantities,
                       [path, wanted](const mechanics::Network& divided, const std::vector<Quantity>& asked) {
                         return make_solver(divided, asked, path, wanted);
                       });
}

}  // namespace

PeriodicResponse::PeriodicResponse(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                                   Path path, const OrbitsWanted& wanted)
    : solver_((common_divisor(network) > 1 ? make_divided_solver : make_solver)(network, quantities, path,
                                                                                wanted)) {}
PeriodicResponse::~PeriodicResponse() = default;
PeriodicResponse::PeriodicResponse(PeriodicResponse&&) noexcept = default;
PeriodicResponse& PeriodicResponse::operator=(PeriodicResponse&&) noexcept = default;

void PeriodicResponse::solve_row(std::span<const mechanics::NetworkValues> points,
                                 std::span<ResponseSummary> found, std::span<double> out) {
  for (ResponseSummary& summary : found) summary = {};
  solver_->solve_row(points, found, out);
}
void PeriodicResponse::end_rows_when(const std::function<bool()>& stop_asked) {
  solver_->end_rows_when(stop_asked);
}
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
void PeriodicResponse::start_from(std::span<const KnownOrbit> known) {
  solver_->start_from(known);
}
std::vector<KnownOrbit> PeriodicResponse::known() const {
  return solver_->known();
}
void PeriodicResponse::tell(int which) {
  solver_->tell(which);
}
std::vector<std::complex<double>> PeriodicResponse::multipliers() {
  return solver_->multipliers();
}
void PeriodicResponse::quantities(std::span<double> out) {
  solver_->quantities(out);
}
std::string PeriodicResponse::gradient(std::span<const mechanics::NetworkValues> directions,
                                       std::span<double> out) {
  return solver_->gradient(directions, out);
}
std::string PeriodicResponse::why_no_derivative(std::size_t quantity) const {
  return solver_->why_no_derivative(quantity);
}
std::string PeriodicResponse::observe(std::span<const double> times, std::span<const Observed> observed,
                                      std::span<const mechanics::NetworkValues> directions,
                                      ObservedMotion& out) {
  return solver_->observe(times, observed, directions, out);
}
History PeriodicResponse::history(std::span<const double> phases, SliderForces sliders) {
  return solver_->history(phases, sliders);
}
std::vector<Stretch> PeriodicResponse::stretches() const {
  return solver_->stretches();
}

}  // namespace frahm::periodic
