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
namespace {

using Eigen::Index;
using periodic::contains, periodic::kNodes, periodic::kTerms;

constexpr std::size_t kMostAccounts = 64;  // of a structure with many contacts hardly a mode comes again
constexpr int kTabulated = 8;              // whole steps: what a table costs

using AtNodes = Eigen::Array<double, kNodes, 1>;
// Whole registers of nodes, the last ones idle.
constexpr int kLanes = 8;
using Powers = Eigen::Array<double, kLanes, kTerms>;

// Of the nodes of a step's first `length`, a row for each.
Powers powers_at_nodes(double length) {
  Powers at = Powers::Zero();
  for (int i = 0; i < kNodes; ++i)
    at.row(i) = periodic::powers(length * periodic::kNodeAt[i]).transpose().array();
  return at;
}

}  // namespace

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
  const Eigen::MatrixXd &S = system.structural_damping, &before = system_.structural_damping;
  if (S.rows() != before.rows() || S != before) rates_ = mechanics::structural_rates(system);
  system_ = system;
  forcing_ = std::max(forcing_, flow_.static_norm());
  accounts_.clear();
  turn_.resize(0, 0);
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
  const Account& account = account_of(mode);
  sample(account, step, length);
  integrate(account, mode, length, total_);
}

bool EnergyAccount::is_tabulated(const Mode& mode) {
  Account& account = account_of(mode);
  if (flow_.equations().is_large()) return false;
  if (++account.whole_steps == kTabulated) tabulate(mode, account);
  return account.whole_steps >= kTabulated;
}

void EnergyAccount::follow(const Mode& mode, const Instant& start) {
  const Account& account = account_of(mode);
  at_nodes_.noalias() = account.of_z * start.z;
  at_nodes_.noalias() += account.of_u * start.u;
  at_nodes_ += account.constant;
  integrate(account, mode, 1.0, total_);
}

std::vector<double> EnergyAccount::dissipated_within(const Mode& mode, const Expansion& step, double length) {
  const Account& account = account_of(mode);
  Energies energies = total_;
  sample(account, step, length);
  integrate(account, mode, length, energies);
  return energies.dissipated;
}

EnergyAccount::Account& EnergyAccount::account_of(const Mode& mode) {
  const auto is_of = [&](const Account& each) {
    return each.stuck == mode.stuck && each.positive == mode.positive && each.beyond == mode.beyond;
  };
  if (current_ < accounts_.size() && is_of(accounts_[current_])) return accounts_[current_];
  const auto known = std::ranges::find_if(accounts_, is_of);
  current_ = static_cast<std::size_t>(known - accounts_.begin());
  if (known != accounts_.end()) return *known;
  if (accounts_.size() == kMostAccounts) accounts_.clear();
  current_ = accounts_.size();
  Account& account = accounts_.emplace_back();
  account.stuck = mode.stuck;
  account.positive = mode.positive;
  account.beyond = mode.beyond;
  list_losses(account);
  add_bends(mode, account);
  add_drives(mode, account);
  find_columns(account);
  return account;
}

void EnergyAccount::Account::add(const Form& form) {
  std::vector<Factor>& factors = forms.emplace_back();
  const Index states = form.z.size();
  for (Index k = 0; k < states; ++k)
    if (form.z[k] != 0.0) factors.push_back({k, form.z[k]});
  for (Index k = 0; k < form.u.size(); ++k)
    if (form.u[k] != 0.0) factors.push_back({states + k, form.u[k]});
}

// The velocity of each element that damps or rubs, the force of each Maxwell element, and the rates of the
// structure's damping.
void EnergyAccount::list_losses(Account& account) const {
  for (std::size_t e = 0; e < system_.coefficients.size(); ++e) {
    const mechanics::ElementCoefficients& law = system_.coefficients[e];
    const std::size_t told = mechanics::told_by(assembly_.network(), e);
    if (law.damping != 0.0) {
      account.losses.push_back({told, law.damping});
      account.add(forms_.velocity(assembly_.incidences()[e]));
    }
    if (law.internal_damping != 0.0) {
      account.losses.push_back({told, 1.0 / law.internal_damping});
      Form force = forms_.zero();
      force.z[2 * flow_.equations().masses() + law.internal] = 1.0;
      account.add(force);
    }
    if (law.friction != 0.0) {
      account.losses.push_back(
          {told, law.friction, Power::sliding, static_cast<Index>(assembly_.shares()[e].contact)});
      account.add(forms_.velocity(assembly_.incidences()[e]));
    }
  }
  for (Index r = 0; r < rates_.rows(); ++r) {
    account.losses.push_back({system_.coefficients.size(), 1.0});
    account.add(forms_.velocity(mechanics::structural_incidence(system_, rates_.row(r))));
  }
}

// Beyond a place of the displacement c u'^2, of the velocity its force times u'. The energy k g^2/2 of a stop
// that is past its place and pushes no more falls by -k g g', which nothing takes up.
void EnergyAccount::add_bends(const Mode& mode, Account& account) const {
  const auto& bends = flow_.equations().bends;
  for (Index j = 0; j < bends.count(); ++j) {
    const std::size_t element = assembly_.bends().element[static_cast<std::size_t>(j)];
    if (contains(mode.beyond & bends.of_velocity, j)) {
      account.losses.push_back({element, 1.0, Power::product});
      account.add(forms_.bend_force(j));
    } else if (contains(mode.beyond & bends.jumping, j)) {
      account.losses.push_back({element, bends.damping[j] * flow_.equations().step});
    } else if (contains(bends.jumping & ~bends.pulling, j)) {
      account.losses.push_back({element, bends.stiffness[j], Power::recoil});
      Form past = forms_.zero();
      past.z.head(bends.B.rows()) = bends.B.col(j);
      past.u = bends.motion.row(j).transpose();
      past.u[0] -= bends.place[j];
      account.add(past);
    } else {
      continue;
    }
    account.add(forms_.bend_velocity(j));
  }
}

// Force and velocity of each mass on which an outside force acts, and of each prescribed node.
void EnergyAccount::add_drives(const Mode& mode, Account& account) const {
  const auto& eq = flow_.equations();
  for (Index i = 0; i < eq.masses(); ++i) {
    if (eq.applied_force.row(i).isZero(0.0)) continue;
    Form force = forms_.zero();
    force.u = eq.applied_force.row(i).transpose();
    account.add(force);
    account.add(forms_.velocity(mass_incidences_[static_cast<std::size_t>(i)]));
  }
  for (Index s = 0; s < eq.motion.rows(); ++s) {
    const mechanics::Node node{mechanics::NodeKind::prescribed, static_cast<std::size_t>(s)};
    account.add(forms_.node_force(node, system_, mode));
    Form velocity = forms_.zero();
    velocity.u = eq.motion_velocity.row(s).transpose() / eq.step;
    account.add(velocity);
  }
}

void EnergyAccount::find_columns(Account& account) const {
  const auto& eq = flow_.equations();
  std::vector<char> is_read(static_cast<std::size_t>(eq.states() + eq.oscillators()), 0);
  for (const std::vector<Factor>& form : account.forms)
    for (const Factor& factor : form) is_read[static_cast<std::size_t>(factor.column)] = 1;
  for (std::size_t k = 0; k < is_read.size(); ++k)
    if (is_read[k] != 0) account.columns.push_back(static_cast<Index>(k));
}

// The series of a whole step, z(s) = series_z(s) z + series_u(s) u + series(s), at the nodes.
void EnergyAccount::tabulate(const Mode& mode, Account& account) {
  const auto& eq = flow_.equations();
  const auto& tables = flow_.configuration(mode).tables;
  if (turn_.size() == 0) turn_oscillators(mode);
  const Eigen::Matrix<double, kNodes, kTerms> at = powers_at_nodes(1.0).topRows<kNodes>().matrix();
  const auto rows = kNodes * static_cast<Index>(account.forms.size());
  account.of_z.setZero(rows, eq.states());
  account.of_u.setZero(rows, eq.oscillators());
  account.constant.setZero(rows);
  Eigen::MatrixXd of_z(kTerms, eq.states()), of_u(kTerms, eq.oscillators());
  Eigen::VectorXd constant(kTerms);
  for (std::size_t f = 0; f < account.forms.size(); ++f) {
    const Index row = kNodes * static_cast<Index>(f);
    of_z.setZero();
    of_u.setZero();
    constant.setZero();
    for (const auto& [column, value] : account.forms[f]) {
      if (column >= eq.states()) {
        account.of_u.middleRows<kNodes>(row) +=
            value * turn_.middleRows<kNodes>(kNodes * (column - eq.states()));
        continue;
      }
      of_z += value * tables.series_z.middleRows<kTerms>(kTerms * column);
      of_u += value * tables.series_u.middleRows<kTerms>(kTerms * column);
      constant += value * mode.series.segment<kTerms>(kTerms * column);
    }
    account.of_z.middleRows<kNodes>(row).noalias() += at * of_z;
    account.of_u.middleRows<kNodes>(row).noalias() += at * of_u;
    account.constant.segment<kNodes>(row).noalias() += at * constant;
  }
}

void EnergyAccount::turn_oscillators(const Mode& mode) {
  const auto& eq = flow_.equations();
  const Eigen::Matrix<double, kNodes, kTerms> at = powers_at_nodes(1.0).topRows<kNodes>().matrix();
  turn_.setZero(kNodes * eq.oscillators(), eq.oscillators());
  Instant unit;
  unit.z.setZero(eq.states());
  Expansion x;
  for (Index k = 0; k < eq.oscillators(); ++k) {
    unit.u.setZero(eq.oscillators());
    unit.u[k] = 1.0;
    flow_.expand(unit, mode, x);
    // The first one is 1, whatever the others are.
    for (Index j = k == 0 ? 0 : 1; j < eq.oscillators(); ++j)
      turn_.col(k).segment<kNodes>(kNodes * j).noalias() = at * x.u.col(j);
  }
}

// The forms at the nodes of a step's first `length`.
void EnergyAccount::sample(const Account& account, const Expansion& step, double length) {
  static const Powers whole = powers_at_nodes(1.0);
  const Powers at = length == 1.0 ? whole : powers_at_nodes(length);
  const Index states = step.z.cols();
  at_columns_.resize(static_cast<std::size_t>(kLanes * (states + step.u.cols())));
  const auto at_column = [&](Index column) {
    return Eigen::Map<Eigen::Array<double, kLanes, 1>>(at_columns_.data() + kLanes * column);
  };
  for (const Index column : account.columns) {
    const double* const terms =
        column < states ? step.z.col(column).data() : step.u.col(column - states).data();
    Eigen::Array<double, kLanes, 1> sum = terms[0] * at.col(0);
    for (int k = 1; k < kTerms; ++k) sum += terms[k] * at.col(k);
    at_column(column) = sum;
  }
  at_nodes_.resize(kNodes * static_cast<Index>(account.forms.size()));
  for (std::size_t f = 0; f < account.forms.size(); ++f) {
    Eigen::Array<double, kLanes, 1> sum = Eigen::Array<double, kLanes, 1>::Zero();
    for (const auto& [column, value] : account.forms[f]) sum += value * at_column(column);
    at_nodes_.segment<kNodes>(kNodes * static_cast<Index>(f)) = sum.head<kNodes>().matrix();
  }
}

// Of the forms at the nodes.
void EnergyAccount::integrate(const Account& account, const Mode& mode, double length,
                              Energies& energies) const {
  const Eigen::Map<const AtNodes> weight(periodic::kNodeWeight);
  const double seconds = length * flow_.equations().step;
  const auto form = [&](Index f) { return at_nodes_.segment<kNodes>(kNodes * f).array(); };
  Index f = 0;
  for (const Loss& loss : account.losses) {
    const AtNodes x = form(f), y = form(f + (loss.has_two_forms() ? 1 : 0));
    f += loss.has_two_forms() ? 2 : 1;
    if (loss.power == Power::sliding && contains(mode.stuck, loss.contact)) continue;
    double mean = 0.0;
    if (loss.power == Power::square) mean = (x.square() * weight).sum();
    if (loss.power == Power::sliding) mean = (x.abs() * weight).sum();
    if (loss.power == Power::product) mean = (x * y * weight).sum();
    if (loss.power == Power::recoil) mean = -(x.max(0.0) * y * weight).sum();
    energies.dissipated[loss.element] += loss.coefficient * seconds * mean;
  }
  for (; f < static_cast<Index>(account.forms.size()); f += 2) {
    const AtNodes power = form(f) * form(f + 1);
    energies.input += seconds * (power * weight).sum();
    energies.input_size += seconds * (power.abs() * weight).sum();
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
