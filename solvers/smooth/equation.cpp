#include "solvers/smooth/equation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/smooth_laws.hpp"

namespace frahm::smooth {

Equation::Equation(const mechanics::Assembly& assembly) : assembly_(assembly), orders_(assembly.orders()) {
  const auto& network = assembly.network();
  if (!network.joints.empty())
    throw mechanics::MechanicsError("joint '" + network.joints.front() +
                                    "': smooth laws take a mass at every node");
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (mechanics::has_smooth_law(network.elements[e])) elements_.push_back(e);
  }
  masses_ = static_cast<Eigen::Index>(network.masses.size());
  size_ = 2 * masses_ + static_cast<Eigen::Index>(assembly.internal_forces());
  u_.resize(oscillators());
  x_.resize(terms());
  phi_.resize(terms());
}

double Equation::period() const {
  return 2.0 * std::numbers::pi / omega_;
}

void Equation::set(const mechanics::LinearSystem& system, const mechanics::NetworkValues& values) {
  omega_ = system.omega;
  orders_ = system.orders;
  motion_ = rows_of(system.constant_motion, system.motion);
  motion_velocity_ = differentiated(motion_);
  motion_acceleration_ = differentiated(motion_velocity_);
  motion_velocity_.col(0) += system.belt_velocity;
  applied_force_ = rows_of(system.constant_applied_force, system.applied_force);
  set_linear_part(system);
  set_terms(system, values);
  internal_stiffness_ = system.internal_stiffness;
  energy_root_.setZero(size_, size_);
  energy_root_.topLeftCorner(masses_, masses_) = algebra::upper_root(system.K);
  energy_root_.block(masses_, masses_, masses_, masses_) = algebra::upper_root(system.M);
  energy_root_.diagonal().tail(size_ - 2 * masses_) = system.internal_stiffness.cwiseSqrt().cwiseInverse();

  // sqrt(1/2 sum_k f_k^H K^-1 f_k), as for the exact law
  const Eigen::MatrixXd force = rows_of(system.constant_force, system.force);
  const Eigen::MatrixXd yielding = algebra::solve_positive(system.K, force);
  static_norm_ = std::sqrt(0.5 * force.cwiseProduct(yielding).sum());
  static_displacement_ = yielding.cwiseAbs().rowwise().sum().maxCoeff();
}

// q'' = M^-1 (f(t) - C q' - K q - D s),   s_e' = k_e (d_e^T q' + p_e^T y') - (k_e/c_e) s_e
void Equation::set_linear_part(const mechanics::LinearSystem& system) {
  const Eigen::Index n = masses_, s = system.internal_forces();
  const Eigen::LLT<Eigen::MatrixXd> mass(system.M);
  A_.setZero(size_, size_);
  A_.block(0, n, n, n).setIdentity();
  A_.block(n, 0, n, n) = -mass.solve(system.K);
  A_.block(n, n, n, n) = -mass.solve(system.C);
  B_.setZero(size_, oscillators());
  B_.middleRows(n, n) = mass.solve(rows_of(system.constant_force, system.force));
  if (s == 0) return;
  const auto stiffness = system.internal_stiffness.asDiagonal();
  A_.block(n, 2 * n, n, s) = -mass.solve(system.D);
  A_.block(2 * n, n, s, n) = stiffness * system.D.transpose();
  A_.block(2 * n, 2 * n, s, s).diagonal() = -system.internal_rate;
  B_.bottomRows(s) = stiffness * (system.D_support.transpose() * motion_velocity_);
}

// w_j^T q' + r_j u of friction, w_j^T q + r_j u of a spring.
void Equation::set_terms(const mechanics::LinearSystem& system, const mechanics::NetworkValues& values) {
  const Eigen::LLT<Eigen::MatrixXd> mass(system.M);
  G_.setZero(size_, terms());
  W_.setZero(terms(), size_);
  support_.resize(terms(), oscillators());
  limit_.resize(terms());
  forces_.clear();
  bent_displacement_ = 0.0;
  for (Eigen::Index j = 0; j < terms(); ++j) {
    const std::size_t element = elements_[static_cast<std::size_t>(j)];
    const mechanics::Incidence& at = assembly_.incidences()[element];
    limit_[j] = system.coefficients[element].friction;
    const SmoothForce& force = forces_.emplace_back(assembly_.network().elements[element],
                                                    mechanics::smooth_value(values, element), limit_[j]);
    const bool of_velocity = force.is_of_velocity();
    G_.col(j).segment(masses_, masses_) = -mass.solve(at.w);
    W_.row(j).segment(of_velocity ? masses_ : 0, masses_) = at.w.transpose();
    support_.row(j) = at.p.transpose() * (of_velocity ? motion_velocity_ : motion_);
    const double compliance = at.w.dot(algebra::solve_positive(system.K, at.w));
    bent_displacement_ = std::max(bent_displacement_, force.bent_displacement(lowest_rate(), compliance));
  }
}

bool Equation::rubs(Eigen::Index term) const {
  return forces_[static_cast<std::size_t>(term)].is_of_velocity();
}

void Equation::oscillate(double t) {
  u_[0] = 1.0;
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    u_[1 + 2 * i] = std::cos(orders_[k] * omega_ * t);
    u_[2 + 2 * i] = std::sin(orders_[k] * omega_ * t);
  }
}

const Eigen::VectorXd& Equation::arguments(double t, const Eigen::Ref<const Eigen::VectorXd>& z) {
  oscillate(t);
  x_.noalias() = W_ * z;
  x_.noalias() += support_ * u_;
  return x_;
}

void Equation::rates(double t, const Eigen::Ref<const Eigen::VectorXd>& z, Eigen::Ref<Eigen::VectorXd> dz) {
  arguments(t, z);
  for (Eigen::Index j = 0; j < terms(); ++j) phi_[j] = forces_[static_cast<std::size_t>(j)].at(x_[j]).force;
  dz.noalias() = A_ * z;
  dz.noalias() += B_ * u_;
  dz.noalias() += G_ * phi_;
}

// A + sum_j g_j phi_j' w_j^T
void Equation::jacobian(double t, const Eigen::Ref<const Eigen::VectorXd>& z, Eigen::Ref<Eigen::MatrixXd> J) {
  arguments(t, z);
  J = A_;
  for (Eigen::Index j = 0; j < terms(); ++j)
    J.noalias() += forces_[static_cast<std::size_t>(j)].at(x_[j]).slope * G_.col(j) * W_.row(j);
}

void Equation::look(double t, const Eigen::Ref<const Eigen::VectorXd>& z, Instant& instant) {
  instant.z = z;
  instant.dz.resize(size_);
  rates(t, z, instant.dz);
  instant.u = u_;
  instant.bent = phi_;
  instant.du.setZero(oscillators());
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    instant.du[1 + 2 * i] = -orders_[k] * omega_ * u_[2 + 2 * i];
    instant.du[2 + 2 * i] = orders_[k] * omega_ * u_[1 + 2 * i];
  }
  instant.rate.resize(terms());
  for (Eigen::Index j = 0; j < terms(); ++j)
    instant.rate[j] = forces_[static_cast<std::size_t>(j)].at(x_[j]).slope *
                      (W_.row(j).dot(instant.dz) + support_.row(j).dot(instant.du));
}

SteadyState Equation::linear_response() const {
  return steady_state(A_, B_);
}

// A + sum_j g_j c_j w_j^T,  B + sum_j g_j (c_j r_j + the constant force of the term)
SteadyState Equation::linear_response(const StraightTerms& terms) const {
  const Eigen::MatrixXd damped = G_ * terms.slope.asDiagonal();
  Eigen::MatrixXd B = B_ + damped * support_;
  B.col(0) += G_ * terms.force;
  return steady_state(A_ + damped * W_, B);
}

// For each harmonic (i Omega - A) Z = b, and A Z = -b of the constant.
SteadyState Equation::steady_state(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) const {
  SteadyState state;
  state.mean = algebra::solve(A, Eigen::VectorXd(-B.col(0)));
  state.harmonics.resize(size_, static_cast<Eigen::Index>(orders_.size()));
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    Eigen::MatrixXcd resolvent = -A.cast<std::complex<double>>();
    resolvent.diagonal().array() += std::complex<double>(0.0, orders_[k] * omega_);
    Eigen::VectorXcd b(size_);
    b.real() = B.col(1 + 2 * i);
    b.imag() = -B.col(2 + 2 * i);
    state.harmonics.col(i) = algebra::solve(resolvent, b);
  }
  return state;
}

Eigen::VectorXd Equation::at(double t, const SteadyState& state) const {
  Eigen::VectorXd z = state.mean;
  for (std::size_t k = 0; k < orders_.size(); ++k)
    z +=
        (state.harmonics.col(static_cast<Eigen::Index>(k)) * std::polar(1.0, orders_[k] * omega_ * t)).real();
  return z;
}

StraightTerms Equation::at_rest() const {
  return equivalent({Eigen::VectorXd::Zero(size_),
                     Eigen::MatrixXcd::Zero(size_, static_cast<Eigen::Index>(orders_.size()))});
}

//   c = <phi (x - <x>)>/<(x - <x>)^2>,  the mean force <phi> - c <x>;  the tangent where nothing moves
StraightTerms Equation::equivalent(const SteadyState& state) const {
  StraightTerms straight{Eigen::VectorXd::Zero(terms()), Eigen::VectorXd::Zero(terms())};
  const int samples = 32 * orders_.back();  // of the period; the fastest order has 32 of its own
  const Eigen::VectorXd mean = W_ * state.mean + support_.col(0);
  Eigen::MatrixXcd harmonics = W_ * state.harmonics;
  for (Eigen::Index k = 0; k < harmonics.cols(); ++k) {
    harmonics.col(k).real() += support_.col(1 + 2 * k);
    harmonics.col(k).imag() -= support_.col(2 + 2 * k);
  }
  for (Eigen::Index j = 0; j < terms(); ++j) {
    if (!rubs(j)) continue;
    const SmoothForce& law = forces_[static_cast<std::size_t>(j)];
    double force = 0.0, power = 0.0, square = 0.0;
    for (int sample = 0; sample < samples; ++sample) {
      const double phase = 2.0 * std::numbers::pi * sample / samples;
      double moving = 0.0;
      for (Eigen::Index k = 0; k < harmonics.cols(); ++k)
        moving += (harmonics(j, k) * std::polar(1.0, orders_[static_cast<std::size_t>(k)] * phase)).real();
      const double at = law.at(mean[j] + moving).force;
      force += at / samples;
      power += at * moving / samples;
      square += moving * moving / samples;
    }
    straight.slope[j] = square > 0.0 ? power / square : law.at(mean[j]).slope;
    straight.force[j] = force - straight.slope[j] * mean[j];
  }
  return straight;
}

double Equation::energy_norm(const Eigen::VectorXd& z) const {
  return std::sqrt(0.5) * (energy_root_ * z).norm();
}

// ||A||_E = ||R A R^-1||_2
double Equation::energy_norm_of_map(const Eigen::MatrixXd& map) const {
  return energy_root_.triangularView<Eigen::Upper>().solve<Eigen::OnTheRight>(energy_root_ * map).norm();
}

Eigen::VectorXd Equation::scale(double displacement, double velocity) const {
  const double rate = lowest_rate();
  double q = std::max({displacement, velocity / rate, 1e-3 * static_displacement_});
  if (!(q > 0.0)) q = 1.0;
  Eigen::VectorXd result(size_);
  result.head(masses_).setConstant(q);
  result.segment(masses_, masses_).setConstant(q * rate);
  result.tail(size_ - 2 * masses_) = q * internal_stiffness_;
  return result;
}

// Re(c e^{i theta}) = Re c cos(theta) - Im c sin(theta)
Eigen::MatrixXd Equation::rows_of(const Eigen::VectorXd& constant, const Eigen::MatrixXcd& harmonics) const {
  Eigen::MatrixXd rows(constant.size(), oscillators());
  rows.col(0) = constant;
  for (Eigen::Index k = 0; k < harmonics.cols(); ++k) {
    rows.col(1 + 2 * k) = harmonics.col(k).real();
    rows.col(2 + 2 * k) = -harmonics.col(k).imag();
  }
  return rows;
}

Eigen::MatrixXd Equation::differentiated(const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows.rows(), rows.cols());
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    result.col(1 + 2 * i) = orders_[k] * omega_ * rows.col(2 + 2 * i);
    result.col(2 + 2 * i) = -orders_[k] * omega_ * rows.col(1 + 2 * i);
  }
  return result;
}

}  // namespace frahm::smooth
