#include "solvers/smooth/shooting.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <sstream>

#include "solvers/algebra/eigenvalues.hpp"
#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/orbits/spectral_radius.hpp"

namespace frahm::smooth {
namespace {

std::string no_convergence(const Orbit& orbit) {
  std::ostringstream reason;
  reason.precision(2);
  reason << "no convergence: after " << orbit.passages << " passages of the smooth motion the residual is "
         << orbit.residual;
  return reason.str();
}

std::string too_inaccurate(double error) {
  std::ostringstream reason;
  reason.precision(2);
  reason << "the motion is damped too weakly for the accuracy of the integrator: the estimated error of the "
            "orbit is "
         << error;
  return reason.str();
}

}  // namespace

double Orbit::floquet_radius() const {
  const double radius = periodic::spectral_radius(passage.tangent);
  return half_period ? radius * radius : radius;
}

std::vector<std::complex<double>> Orbit::multipliers() const {
  Eigen::VectorXcd values = algebra::eigenvalues(passage.tangent);
  if (half_period) values = values.array().square();
  std::ranges::sort(values, [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return {values.begin(), values.end()};
}

void Shooting::find(const Eigen::VectorXd& scale, Orbit& orbit) {
  orbit.status = Status::failed;
  orbit.reason.clear();
  orbit.newton_iterations = orbit.passages = 0;
  apply_map(scale, orbit);
  int maps = 1;
  while (may_go_on(orbit) && orbit.residual > options_.tolerance) {
    if (newton(scale, orbit)) continue;
    if (orbit.residual <= options_.good_enough || !options_.applies_map) break;
    march(scale, maps, orbit);
    maps = 2 * maps;
  }
  if (orbit.passage.failure != nullptr) {
    orbit.reason = orbit.passage.failure;
    orbit.residual = kNone;
  } else if (!(orbit.residual <= options_.good_enough)) {
    orbit.reason = no_convergence(orbit);
  } else if (const double error = estimated_error(orbit); !(error <= options_.largest_error)) {
    orbit.reason = too_inaccurate(error);
  } else {
    orbit.status = Status::ok;
  }
}

// ||z - z*||_E / ||z||_E to first order: (1 -+ dg/dz) (z - z*) = r + the errors of the steps, which the flow
// does not expand.
double Shooting::estimated_error(const Orbit& orbit) const {
  const Eigen::Index size = equation_.size();
  const Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Identity(size, size) - orbit.sign() * orbit.passage.tangent;
  const double scale = equation_.energy_scale(orbit.z);
  if (!(scale > 0.0)) return 0.0;
  const double defect = orbit.residual + orbit.passage.local_errors / scale;
  return equation_.energy_norm_of_map(algebra::inverse(jacobian)) * defect;
}

// residual_ = +-g(z) - z.
void Shooting::apply_map(const Eigen::VectorXd& scale, Orbit& orbit) {
  const double duration = equation_.period() * (orbit.half_period ? 0.5 : 1.0);
  integrator_.pass(orbit.z, orbit.section, duration, scale, orbit.passage);
  ++orbit.passages;
  if (orbit.passage.failure != nullptr) return;
  residual_ = orbit.sign() * orbit.passage.end - orbit.z;
  const double size = equation_.energy_scale(orbit.z);
  const double norm = equation_.energy_norm(residual_);
  orbit.residual = size > 0.0 ? norm / size : norm;
}

// One step of Newton's method, (1 -+ dg/dz) step = r, shortened until it reduces the residual. False, with
// the orbit unchanged, if no length does.
bool Shooting::newton(const Eigen::VectorXd& scale, Orbit& orbit) {
  const Eigen::Index size = equation_.size();
  const Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Identity(size, size) - orbit.sign() * orbit.passage.tangent;
  const Eigen::VectorXd step = algebra::solve(jacobian, residual_), z = orbit.z;
  const double before = orbit.residual;
  double share = 1.0;
  const auto may_try = [&] { return step.allFinite() && orbit.passages < options_.most_passages; };
  for (int rejected = 0; may_try() && rejected <= options_.most_rejections; ++rejected) {
    orbit.z = z + share * step;
    ++orbit.newton_iterations;
    apply_map(scale, orbit);
    constexpr double kPays = 0.9;
    if (orbit.passage.failure == nullptr && orbit.residual < kPays * before) return true;
    if (before <= options_.good_enough) break;  // what is left is the integrator's error
    share *= 0.25;
  }
  orbit.z = z;
  apply_map(scale, orbit);
  return false;
}

void Shooting::march(const Eigen::VectorXd& scale, int maps, Orbit& orbit) {
  for (int i = 0; i < maps && may_go_on(orbit) && orbit.residual > options_.tolerance; ++i) {
    orbit.z = orbit.sign() * orbit.passage.end;
    apply_map(scale, orbit);
  }
}

}  // namespace frahm::smooth
