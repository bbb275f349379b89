#include "solvers/transient/energy_account.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/quantities/integrals.hpp"

namespace frahm::transient {

using Eigen::Index;
using periodic::contains, periodic::kNodes;

EnergyAccount::EnergyAccount(const mechanics::Assembly& assembly, const Flow& flow)
    : assembly_(assembly), flow_(flow), forms_(assembly, flow) {
  const auto masses = static_cast<Index>(assembly.network().masses.size());
  const auto supports = static_cast<Index>(assembly.network().prescribed.size());
  for (Index i = 0; i < masses; ++i) {
    mass_incidences_.push_back({Eigen::VectorXd::Unit(masses, i), Eigen::VectorXd::Zero(supports)});
  }
  const bool damps = mechanics::has_structural_damping(assembly.network());
  total_.dissipated.assign(assembly.network().elements.size() + (damps ? 1 : 0), 0.0);
}

void EnergyAccount::set_system(const mechanics::LinearSystem& system) {
  system_ = system;
  forcing_ = std::max(forcing_, flow_.static_norm());
  prepared_ = false;
}

double EnergyAccount::energy_of(const State& z, double phase) const {
  const auto& eq = flow_.equations();
  const Index n = eq.masses();
  typename Flow::S::Oscillators u(eq.oscillators());
  eq.oscillators_at(phase, flow_.orders(), u);
  const auto half_square = [&](const Form& form) {
    const double value = form.z.dot(z) + form.u.dot(u);
    return 0.5 * value * value;
  };
  const auto laws = std::span(system_.coefficients);
  const Eigen::VectorXd q = z.head(n), v = z.segment(n, n) / eq.step;
  double energy = 0.5 * v.dot(system_.mass * v);
  if (const Eigen::MatrixXd& K = assembly_.matrices().stiffness; K.size() > 0) energy += 0.5 * q.dot(K * q);
  for (std::size_t e = 0; e < laws.size(); ++e) {
    const mechanics::Incidence& at = assembly_.incidences()[e];
    if (laws[e].stiffness != 0.0) energy += laws[e].stiffness * half_square(forms_.displacement(at));
    if (laws[e].inertance != 0.0) energy += laws[e].inertance * half_square(forms_.velocity(at));
    if (laws[e].internal < 0) continue;
    const double force = z[2 * n + laws[e].internal];
    energy += 0.5 * force * force / eq.internal_stiffness[laws[e].internal];
  }
  return energy + energy_of_bends(z, u);
}

// k (u - D)^2 / 2 beyond D
double EnergyAccount::energy_of_bends(const State& z, const typename Flow::S::Oscillators& u) const {
  const auto& bends = flow_.equations().bends;
  double energy = 0.0;
  for (Index j = 0; j < bends.count(); ++j) {
    const double past =
        bends.B.col(j).dot(z.head(bends.B.rows())) + bends.motion.row(j).dot(u) - bends.place[j];
    if (past > 0.0 && !contains(bends.of_velocity, j)) energy += 0.5 * bends.stiffness[j] * past * past;
  }
  return energy;
}

void EnergyAccount::put_in(double energy) {
  total_.input += energy;
  total_.input_size += std::abs(energy);
}

void EnergyAccount::follow(const Mode& mode, const Expansion& step, double length) {
  prepare(mode);
  integrate(mode, step, length, total_);
}

std::vector<double> EnergyAccount::dissipated_within(const Mode& mode, const Expansion& step, double length) {
  prepare(mode);
  Energies energies = total_;
  integrate(mode, step, length, energies);
  return energies.dissipated;
}

void EnergyAccount::prepare(const Mode& mode) {
  if (prepared_ && mode.stuck == stuck_ && mode.positive == positive_ && mode.beyond == beyond_) return;
  prepared_ = true;
  stuck_ = mode.stuck;
  positive_ = mode.positive;
  beyond_ = mode.beyond;
  std::vector<Form> forms = loss_forms(mode);
  for (Form& form : drive_forms(mode)) forms.push_back(std::move(form));
  const auto rows = static_cast<Index>(forms.size());
  of_z_.resize(rows, flow_.equations().states());
  of_u_.resize(rows, flow_.equations().oscillators());
  for (Index row = 0; row < rows; ++row) {
    of_z_.row(row) = forms[static_cast<std::size_t>(row)].z.transpose();
    of_u_.row(row) = forms[static_cast<std::size_t>(row)].u.transpose();
  }
}

// The velocity of each element that damps or rubs, the force of each Maxwell element, the rates of the
// structure's damping, and what bends.
std::vector<EnergyAccount::Form> EnergyAccount::loss_forms(const Mode& mode) {
  std::vector<Form> forms;
  losses_.clear();
  for (std::size_t e = 0; e < system_.coefficients.size(); ++e) {
    const mechanics::ElementCoefficients& law = system_.coefficients[e];
    const std::size_t told = mechanics::told_by(assembly_.network(), e);
    if (law.damping != 0.0) {
      losses_.push_back({told, law.damping});
      forms.push_back(forms_.velocity(assembly_.incidences()[e]));
    }
    if (law.internal_damping != 0.0) {
      losses_.push_back({told, 1.0 / law.internal_damping});
      forms.push_back(forms_.zero());
      forms.back().z[2 * flow_.equations().masses() + law.internal] = 1.0;
    }
    if (law.friction != 0.0) {
      losses_.push_back(
          {told, law.friction, Power::sliding, static_cast<Index>(assembly_.shares()[e].contact)});
      forms.push_back(forms_.velocity(assembly_.incidences()[e]));
    }
  }
  const Eigen::MatrixXd rates = mechanics::structural_rates(system_);
  for (Index r = 0; r < rates.rows(); ++r) {
    losses_.push_back({system_.coefficients.size(), 1.0});
    forms.push_back(forms_.velocity(mechanics::structural_incidence(system_, rates.row(r))));
  }
  add_bends(mode, forms);
  return forms;
}

// Beyond a place of the displacement c u'^2, of the velocity its force times u'. The energy k g^2/2 of a stop
// that is past its place and pushes no more falls by -k g g', which nothing takes up.
void EnergyAccount::add_bends(const Mode& mode, std::vector<Form>& forms) {
  const auto& bends = flow_.equations().bends;
  for (Index j = 0; j < bends.count(); ++j) {
    const std::size_t element = assembly_.bends().element[static_cast<std::size_t>(j)];
    if (contains(mode.beyond & bends.of_velocity, j)) {
      losses_.push_back({element, 1.0, Power::product});
      forms.push_back(forms_.bend_force(j));
    } else if (contains(mode.beyond & bends.jumping, j)) {
      losses_.push_back({element, bends.damping[j] * flow_.equations().step});
    } else if (contains(bends.jumping & ~bends.pulling, j)) {
      losses_.push_back({element, bends.stiffness[j], Power::recoil});
      forms.push_back(forms_.zero());
      forms.back().z.head(bends.B.rows()) = bends.B.col(j);
      forms.back().u = bends.motion.row(j).transpose();
      forms.back().u[0] -= bends.place[j];
    } else {
      continue;
    }
    forms.push_back(forms_.bend_velocity(j));
  }
}

// Force and velocity of each mass on which an outside force acts, and of each prescribed node.
std::vector<EnergyAccount::Form> EnergyAccount::drive_forms(const Mode& mode) const {
  const auto& eq = flow_.equations();
  std::vector<Form> forms;
  for (Index i = 0; i < eq.masses(); ++i) {
    if (eq.applied_force.row(i).isZero(0.0)) continue;
    forms.push_back(forms_.zero());
    forms.back().u = eq.applied_force.row(i).transpose();
    forms.push_back(forms_.velocity(mass_incidences_[static_cast<std::size_t>(i)]));
  }
  for (Index s = 0; s < eq.motion.rows(); ++s) {
    const mechanics::Node node{mechanics::NodeKind::prescribed, static_cast<std::size_t>(s)};
    forms.push_back(forms_.node_force(node, system_, mode));
    forms.push_back(forms_.zero());
    forms.back().u = eq.motion_velocity.row(s).transpose() / eq.step;
  }
  return forms;
}

void EnergyAccount::integrate(const Mode& mode, const Expansion& step, double length,
                              Energies& energies) const {
  if (of_z_.rows() == 0) return;
  Eigen::Matrix<double, periodic::kTerms, kNodes> at;
  for (int i = 0; i < kNodes; ++i) at.col(i) = periodic::powers(length * periodic::kNodeAt[i]);
  const Eigen::Map<const Eigen::Matrix<double, kNodes, 1>> weight(periodic::kNodeWeight);
  const double seconds = length * flow_.equations().step;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, kNodes>;
  Values values = of_z_.lazyProduct((step.z.transpose().lazyProduct(at)).eval());
  values += of_u_.lazyProduct((step.u.transpose().lazyProduct(at)).eval());

  Index row = 0;
  for (const Loss& loss : losses_) {
    const auto x = values.row(row), y = values.row(row + (loss.has_two_forms() ? 1 : 0));
    row += loss.has_two_forms() ? 2 : 1;
    if (loss.power == Power::sliding && contains(mode.stuck, loss.contact)) continue;
    double mean = 0.0;
    if (loss.power == Power::square) mean = x.cwiseAbs2().dot(weight);
    if (loss.power == Power::sliding) mean = x.cwiseAbs().dot(weight);
    if (loss.power == Power::product) mean = x.cwiseProduct(y).dot(weight);
    if (loss.power == Power::recoil) mean = -x.cwiseMax(0.0).cwiseProduct(y).dot(weight);
    energies.dissipated[loss.element] += loss.coefficient * seconds * mean;
  }
  for (; row < values.rows(); row += 2) {
    const Eigen::Matrix<double, 1, kNodes> power = values.row(row).cwiseProduct(values.row(row + 1));
    energies.input += seconds * power.dot(weight);
    energies.input_size += seconds * power.cwiseAbs().dot(weight);
  }
}

EnergyBudget EnergyAccount::budget(double energy_now) const {
  EnergyBudget budget{.initial = initial_, .final = energy_now, .input = total_.input};
  budget.dissipated = total_.dissipated;
  const double dissipated = std::accumulate(budget.dissipated.begin(), budget.dissipated.end(), 0.0);
  const double stored = std::max(std::abs(initial_), std::abs(energy_now));
  const double forcing = forcing_ * forcing_;
  // Where nothing moves, velocities are rounding: work is linear in them, losses are quadratic.
  constexpr double work_rounding = 1e-11, loss_rounding = 1e-26;
  const double size = std::max({stored, dissipated, total_.input_size});
  const double missing = initial_ + total_.input - energy_now - dissipated;
  budget.balance = size > work_rounding * forcing ? std::abs(missing) / size : 0.0;
  const bool nothing = dissipated <= loss_rounding * std::max(forcing, stored);
  for (const double each : budget.dissipated) budget.share.push_back(nothing ? 0.0 : each / dissipated);
  return budget;
}

std::string why_unbalanced(const EnergyBudget& energy) {
  constexpr double kBalanced = 1e-7;
  if (energy.balance <= kBalanced) return "";
  return periodic::unbalanced_motion(energy.balance);
}

}  // namespace frahm::transient
