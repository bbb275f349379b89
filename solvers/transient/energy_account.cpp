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
constexpr int kTabulated = 16;             // whole steps: what their quadratic forms cost
constexpr Index kPending = 64;             // whole steps that are summed up together

using AtNodes = Eigen::Array<double, kNodes, 1>;
// Whole registers of nodes, the last ones idle.
constexpr int kLanes = 8;
using Powers = Eigen::Array<double, kLanes, kTerms>;

// For the nodes of a step's first `length`, a row for each.
Powers powers_at_nodes(double length) {
  Powers at = Powers::Zero();
  for (int i = 0; i < kNodes; ++i)
    at.row(i) = periodic::powers(length * periodic::kNodeAt[i]).transpose().array();
  return at;
}

}  // namespace

EnergyAccount::EnergyAccount(const mechanics::Assembly& assembly, const Flow& flow, EnergyDetail detail)
    : assembly_(assembly), flow_(flow), detail_(detail), forms_(assembly, flow), step_rows_(flow) {
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
  sum_up_all();
  accounts_.clear();
  step_rows_.forget();
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

bool EnergyAccount::follow_whole(const Mode& mode, const Instant& start, const Instant& end) {
  if (detail_ != EnergyDetail::total || flow_.equations().is_large()) return false;
  Account& account = account_of(mode);
  if (account.whole_steps < kTabulated && ++account.whole_steps < kTabulated) return false;
  if (account.input.size() == 0) tabulate(mode, account);
  if (!keeps_signs(account, mode, start, end)) return false;
  account.starts.col(account.pending) << start.z, start.u;
  if (++account.pending == kPending) sum_up(account);
  return true;
}

// Whether each contact's speed has the sign of its friction, so that |v| is linear, and no stop is past its
// place while it pushes no more.
bool EnergyAccount::keeps_signs(const Account& account, const Mode& mode, const Instant& start,
                                const Instant& end) const {
  for (const Index contact : account.sliding) {
    if (flow_.sliding_speed(start, contact).value * mode.sign(contact) < 0.0) return false;
    if (flow_.sliding_speed(end, contact).value * mode.sign(contact) < 0.0) return false;
  }
  const auto& bends = flow_.equations().bends;
  for (Index j = 0; j < bends.count(); ++j) {
    if (!contains(bends.jumping & ~bends.pulling & ~mode.beyond & ~bends.of_velocity, j)) continue;
    for (const Instant* at : {&start, &end}) {
      const double past =
          bends.B.col(j).dot(at->z.head(bends.B.rows())) + bends.motion.row(j).dot(at->u) - bends.place[j];
      if (past > 0.0) return false;
    }
  }
  return true;
}

void EnergyAccount::sum_up(Account& account) {
  if (account.pending == 0) return;
  const auto starts = account.starts.leftCols(account.pending);
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(starts.rows(), starts.rows());
  squares.selfadjointView<Eigen::Lower>().rankUpdate(starts);
  squares.triangularView<Eigen::StrictlyUpper>() = squares.transpose();
  const double input = account.input.cwiseProduct(squares).sum();
  total_.input += input;
  total_.input_size += std::abs(input);
  total_.of_whole_steps += account.loss.cwiseProduct(squares).sum();
  account.pending = 0;
}

void EnergyAccount::sum_up_all() {
  for (Account& account : accounts_) sum_up(account);
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
  if (accounts_.size() == kMostAccounts) {
    sum_up_all();
    accounts_.clear();
  }
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
    const std::size_t reported = mechanics::reported_by(assembly_.network(), e);
    if (law.damping != 0.0) {
      account.losses.push_back({reported, law.damping});
      account.add(forms_.velocity(assembly_.incidences()[e]));
    }
    if (law.internal_damping != 0.0) {
      account.losses.push_back({reported, 1.0 / law.internal_damping});
      Form force = forms_.zero();
      force.z[2 * flow_.equations().masses() + law.internal] = 1.0;
      account.add(force);
    }
    if (law.friction != 0.0) {
      const mechanics::ContactShare& share = assembly_.shares()[e];
      account.losses.push_back(
          {reported, law.friction, Power::sliding, static_cast<Index>(share.contact), share.orientation});
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
  for (Index j = 0; j < eq.joints.load.rows(); ++j) {
    if (eq.joints.load.row(j).isZero(0.0)) continue;
    Form force = forms_.zero();
    force.u = eq.joints.load.row(j).transpose();
    account.add(force);
    account.add(forms_.velocity_of_joint(j));
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

// The forms at the nodes of a whole step, kNodes rows each.
Eigen::MatrixXd EnergyAccount::rows_at_nodes(const Mode& mode, const Account& account) {
  const Index states = flow_.equations().states();
  Eigen::MatrixXd rows(kNodes * static_cast<Index>(account.forms.size()),
                       states + flow_.equations().oscillators());
  for (std::size_t f = 0; f < account.forms.size(); ++f) {
    Form form = forms_.zero();
    for (const auto& [column, value] : account.forms[f])
      (column < states ? form.z[column] : form.u[column - states]) = value;
    rows.middleRows<kNodes>(kNodes * static_cast<Index>(f)) = step_rows_.of(form, mode);
  }
  return rows;
}

void EnergyAccount::tabulate(const Mode& mode, Account& account) {
  const auto& eq = flow_.equations();
  const Eigen::MatrixXd rows = rows_at_nodes(mode, account);
  const Index size = rows.cols();
  account.starts.resize(size, kPending);
  account.input.setZero(size, size);
  account.loss.setZero(size, size);
  add_whole_losses(mode, rows, account);
  const Eigen::Map<const Eigen::VectorXd> weight(periodic::kNodeWeight, kNodes);
  Index f = 0;
  for (const Loss& loss : account.losses) f += loss.has_two_forms() ? 2 : 1;
  for (; f < static_cast<Index>(account.forms.size()); f += 2) {
    const auto force = rows.middleRows<kNodes>(kNodes * f),
               velocity = rows.middleRows<kNodes>(kNodes * (f + 1));
    account.input.noalias() += eq.step * (force.transpose() * weight.asDiagonal() * velocity);
  }
}

void EnergyAccount::add_whole_losses(const Mode& mode, const Eigen::MatrixXd& rows, Account& account) const {
  const auto& eq = flow_.equations();
  const Eigen::Map<const Eigen::VectorXd> weight(periodic::kNodeWeight, kNodes);
  Index f = 0;
  for (const Loss& loss : account.losses) {
    const auto x = rows.middleRows<kNodes>(kNodes * f);
    const auto y = rows.middleRows<kNodes>(kNodes * (f + (loss.has_two_forms() ? 1 : 0)));
    f += loss.has_two_forms() ? 2 : 1;
    const double factor = loss.coefficient * eq.step;
    if (loss.power == Power::sliding) {
      if (contains(mode.stuck, loss.contact)) continue;
      account.loss.row(eq.states()) +=
          factor * loss.orientation * mode.sign(loss.contact) * (weight.transpose() * x);
      if (!flow_.rests(mode, loss.contact)) account.sliding.push_back(loss.contact);
    } else if (loss.power != Power::recoil) {
      account.loss.noalias() += factor * (x.transpose() * weight.asDiagonal() * y);
    }
  }
  std::ranges::sort(account.sliding);
  account.sliding.erase(std::unique(account.sliding.begin(), account.sliding.end()), account.sliding.end());
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

// For the forms at the nodes.
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

EnergyBudget EnergyAccount::budget(double energy_now) {
  sum_up_all();
  EnergyBudget budget{.initial = initial_, .final = energy_now, .input = total_.input};
  budget.dissipated = total_.dissipated;
  const double dissipated =
      std::accumulate(budget.dissipated.begin(), budget.dissipated.end(), total_.of_whole_steps);
  const double stored = std::max(std::abs(initial_), std::abs(energy_now));
  const double forcing = forcing_ * forcing_;
  // Where nothing moves, velocities are rounding: work is linear in them, losses are quadratic.
  constexpr double work_rounding = 1e-11, loss_rounding = 1e-26;
  const double size = std::max({stored, dissipated, total_.input_size});
  const double missing = initial_ + total_.input - energy_now - dissipated;
  if (detail_ == EnergyDetail::total) {
    budget.balance = missing == 0.0 ? 0.0 : std::abs(missing) / size;
    budget.dissipated = {dissipated};
    return budget;
  }
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
