#include "solvers/orbits/rest_position.hpp"

#include "solvers/events/box_minimum.hpp"

namespace frahm::periodic {

RestShift least_energy_shift(const RestDirections& rest, const Eigen::VectorXd& z_mean,
                             std::span<const StuckForce> forces) {
  const auto m = static_cast<Eigen::Index>(forces.size());
  Eigen::VectorXd lower(m), upper(m), size(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const auto& [least, most, limit] = forces[static_cast<std::size_t>(j)];
    lower[j] = -limit - least;
    upper[j] = limit - most;
    // A force that swings from limit to limit, to what counts as grazing, rests in the middle.
    if (lower[j] > upper[j] + kGrazing * limit) return {};
    if (lower[j] > upper[j]) lower[j] = upper[j] = 0.5 * (lower[j] + upper[j]);
    size[j] = limit;
  }
  const BoxMinimum minimum =
      box_minimum(rest.L.transpose() * rest.E, -(rest.L.transpose() * z_mean), lower, upper, size);
  if (!minimum.found) return {};
  RestShift shift{minimum.lambda, RestShift::Verdict::inside};
  for (Eigen::Index j = 0; j < m; ++j) {
    const double room = std::min(shift.delta[j] - lower[j], upper[j] - shift.delta[j]);
    if (room <= kGrazing * size[j]) shift.verdict = RestShift::Verdict::at_limit;
  }
  return shift;
}

}  // namespace frahm::periodic
