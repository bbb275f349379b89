#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/integrals.hpp"
#include "solvers/quantities/quantity_values.hpp"
#include "solvers/quantities/step_rows.hpp"

namespace frahm::periodic {

// Whether an orbit's energies balance, at a fraction of what it costs to measure them: totals alone, of the
// same six nodes a step as Integrals. It is never more lenient than the measurement, which decides where this
// is in doubt.
template <int N, int H>
class EnergyScreen {
 public:
  // Both must outlive the screen.
  EnergyScreen(const mechanics::Assembly& assembly, const Flow<N, H>& flow)
      : assembly_(assembly), flow_(flow), forms_(assembly, flow), step_rows_(flow) {}

  // steps: of the orbit, laid out.
  bool is_balanced(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system, OrbitSteps<N, H>& steps);

 private:
  using S = Sizes<N, H>;
  using Form = LinearForm<N, H>;
  using Step = PassageStep<N, H>;
  using Rows = StepRows<N, H>;
  using Joined = Eigen::Matrix<double, Rows::kSize, 1>;
  using AtNodes = Eigen::Matrix<double, kNodes, 1>;
  using Nodes = Eigen::Matrix<double, kTerms, kNodes>;
  struct Power {
    double coefficient = 1.0;
    std::size_t x = 0, y = 0;  // of the forms
  };
  struct Entry {
    std::size_t form = 0;
    Eigen::Index column = 0;
    double factor = 0.0;
  };

  void list(const Mode<N, H>& mode, const mechanics::LinearSystem& system);
  void list_losses(const Mode<N, H>& mode, const mechanics::LinearSystem& system);
  void list_inputs();
  void set_driving_forces(const Mode<N, H>& mode, const mechanics::LinearSystem& system);
  std::size_t place_of(const Form& form);
  void sample(const Step& step);
  void sample(const Expansion<N, H>& x, double length);
  void find_entries();
  void add_powers(double length, const mechanics::LinearSystem& system);
  void add_friction(const Mode<N, H>& mode, const Step& first, const Step& last,
                    const mechanics::LinearSystem& system);

  const mechanics::Assembly& assembly_;
  const Flow<N, H>& flow_;
  Forms<N, H> forms_;

  std::vector<Form> listed_;
  std::vector<Entry> of_states_, of_oscillators_;  // of the forms, that are not zero
  std::vector<Power> losses_, inputs_;
  std::size_t structure_ = 0;  // the first of the forms that the structure's damping takes
  std::size_t driving_ = 0;    // the first of the inputs that drive a prescribed node
  Rows step_rows_;
  std::vector<typename Rows::Row> rows_;  // of each form, in the mode
  std::vector<AtNodes> values_;           // of each form
  double input_ = 0.0, loss_ = 0.0;       // [J] in the orbit's passage
};

template <int N, int H>
bool EnergyScreen<N, H>::is_balanced(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                                     OrbitSteps<N, H>& steps) {
  constexpr double kTabulated = 3.0;  // steps: what the rows cost
  const StepEquations<N, H>& eq = flow_.equations();
  input_ = loss_ = 0.0;
  step_rows_.forget();
  std::size_t segment = 0;
  const Step* first = nullptr;
  bool is_tabulated = false;
  for (Step& step : steps.steps()) {
    const Mode<N, H>& mode = flow_.mode(step.mode);
    if (first == nullptr) {
      first = &step;
      const bool is_listed = segment > 0 && eq.bends.count() == 0;
      if (!is_listed) list(mode, system);
      if (!is_listed || eq.motion.rows() > 0) set_driving_forces(mode, system);
      is_tabulated = !eq.is_large() && orbit.passage.segments[segment].length >= kTabulated;
      for (std::size_t f = 0; is_tabulated && f < listed_.size(); ++f)
        rows_[f] = step_rows_.of(listed_[f], mode);
    }
    if (is_tabulated && step.length == 1.0)
      sample(step);
    else
      sample(steps.expand(step), step.length);
    add_powers(step.length, system);
    if (!step.ends_segment) continue;
    add_friction(mode, *first, step, system);
    first = nullptr;
    ++segment;
  }
  const double periods = orbit.half_period ? 2.0 : 1.0;
  const double size = periods * std::max(std::abs(input_), loss_);
  const double energy = std::max(flow_.static_norm(), eq.energy_norm(orbit.z));
  return value::is_balanced(periods * std::abs(input_ - loss_), size, energy);
}

template <int N, int H>
void EnergyScreen<N, H>::list(const Mode<N, H>& mode, const mechanics::LinearSystem& system) {
  listed_.clear();
  losses_.clear();
  inputs_.clear();
  list_losses(mode, system);
  list_inputs();
  values_.resize(listed_.size());
  rows_.resize(listed_.size());
}

// A form takes two masses, of however many there are.
template <int N, int H>
void EnergyScreen<N, H>::find_entries() {
  of_states_.clear();
  of_oscillators_.clear();
  for (std::size_t f = 0; f < listed_.size(); ++f) {
    for (Eigen::Index k = 0; k < listed_[f].z.size(); ++k)
      if (listed_[f].z[k] != 0.0) of_states_.push_back({f, k, listed_[f].z[k]});
    for (Eigen::Index k = 0; k < listed_[f].u.size(); ++k)
      if (listed_[f].u[k] != 0.0) of_oscillators_.push_back({f, k, listed_[f].u[k]});
  }
}

template <int N, int H>
std::size_t EnergyScreen<N, H>::place_of(const Form& form) {
  std::size_t place = 0;
  while (place < listed_.size() && !(listed_[place].z == form.z && listed_[place].u == form.u)) ++place;
  if (place == listed_.size()) listed_.push_back(form);
  return place;
}

// c v^2, s^2 / c, and the work that goes into what bends; of the structure's damping the velocities.
template <int N, int H>
void EnergyScreen<N, H>::list_losses(const Mode<N, H>& mode, const mechanics::LinearSystem& system) {
  const StepEquations<N, H>& eq = flow_.equations();
  structure_ = 0;
  if (system.structural_damping.size() > 0) {
    for (Eigen::Index i = 0; i < eq.masses(); ++i) {
      listed_.push_back(forms_.zero());
      listed_.back().z[eq.masses() + i] = 1.0 / eq.step;
    }
    listed_.push_back(forms_.zero());  // the ground
    for (Eigen::Index s = 0; s < eq.motion.rows(); ++s) {
      listed_.push_back(forms_.zero());
      listed_.back().u = eq.motion_velocity.row(s).transpose() / eq.step;
    }
  }
  for (std::size_t e = 0; e < system.coefficients.size(); ++e) {
    const mechanics::ElementCoefficients& law = system.coefficients[e];
    if (law.damping != 0.0) {
      const std::size_t velocity = place_of(forms_.velocity(assembly_.incidences()[e]));
      losses_.push_back({law.damping, velocity, velocity});
    }
    if (law.internal_damping > 0.0) {
      Form force = forms_.zero();
      force.z[2 * eq.masses() + law.internal] = 1.0;
      const std::size_t place = place_of(force);
      losses_.push_back({1.0 / law.internal_damping, place, place});
    }
  }
  for (Eigen::Index j = 0; j < eq.bends.count(); ++j) {
    if (!contains(mode.beyond, j) || eq.bends.damping[j] == 0.0) continue;
    const std::size_t force = place_of(forms_.bend_force(j));
    losses_.push_back({1.0, force, place_of(forms_.bend_velocity(j))});
  }
}

// Outside forces on masses, and a place for the force that drives each prescribed node.
template <int N, int H>
void EnergyScreen<N, H>::list_inputs() {
  const StepEquations<N, H>& eq = flow_.equations();
  for (Eigen::Index i = 0; i < eq.masses(); ++i) {
    if (eq.applied_force.row(i).isZero(0.0)) continue;
    Form force = forms_.zero(), velocity = forms_.zero();
    force.u = eq.applied_force.row(i).transpose();
    velocity.z[eq.masses() + i] = 1.0 / eq.step;
    const std::size_t place = place_of(force);
    inputs_.push_back({1.0, place, place_of(velocity)});
  }
  for (Eigen::Index j = 0; j < eq.joints.load.rows(); ++j) {
    if (eq.joints.load.row(j).isZero(0.0)) continue;
    Form force = forms_.zero();
    force.u = eq.joints.load.row(j).transpose();
    const std::size_t place = place_of(force);
    inputs_.push_back({1.0, place, place_of(forms_.velocity_of_joint(j))});
  }
  driving_ = inputs_.size();
  for (Eigen::Index s = 0; s < eq.motion.rows(); ++s) {
    Form velocity = forms_.zero();
    velocity.u = eq.motion_velocity.row(s).transpose() / eq.step;
    const std::size_t place = place_of(velocity);
    listed_.push_back(forms_.zero());
    inputs_.push_back({1.0, listed_.size() - 1, place});
  }
}

template <int N, int H>
void EnergyScreen<N, H>::set_driving_forces(const Mode<N, H>& mode, const mechanics::LinearSystem& system) {
  for (std::size_t i = driving_; i < inputs_.size(); ++i) {
    const mechanics::Node node{mechanics::NodeKind::prescribed, i - driving_};
    listed_[inputs_[i].x] = forms_.node_force(node, system, mode);
  }
  find_entries();
}

template <int N, int H>
void EnergyScreen<N, H>::sample(const Step& step) {
  Joined y(step.left.z.size() + step.left.u.size());
  y << step.left.z, step.left.u;
  for (std::size_t f = 0; f < listed_.size(); ++f) values_[f].noalias() = rows_[f].lazyProduct(y);
}

template <int N, int H>
void EnergyScreen<N, H>::sample(const Expansion<N, H>& x, double length) {
  Nodes at;
  for (int i = 0; i < kNodes; ++i) at.col(i) = powers(length * kNodeAt[i]);
  for (AtNodes& value : values_) value.setZero();
  for (const Entry& entry : of_states_)
    values_[entry.form].noalias() += at.transpose().lazyProduct(entry.factor * x.z.col(entry.column));
  for (const Entry& entry : of_oscillators_)
    values_[entry.form].noalias() += at.transpose().lazyProduct(entry.factor * x.u.col(entry.column));
}

template <int N, int H>
void EnergyScreen<N, H>::add_powers(double length, const mechanics::LinearSystem& system) {
  const Eigen::Map<const AtNodes> weight(kNodeWeight);
  const double seconds = length * flow_.equations().step;
  const auto work = [&](const Power& power) {
    return power.coefficient * seconds * values_[power.x].cwiseProduct(values_[power.y]).dot(weight);
  };
  for (const Power& power : inputs_) input_ += work(power);
  for (const Power& power : losses_) loss_ += work(power);
  const Eigen::MatrixXd& damping = system.structural_damping;
  if (damping.size() == 0) return;
  Eigen::MatrixXd velocities(kNodes, damping.rows());
  for (Eigen::Index i = 0; i < damping.rows(); ++i)
    velocities.col(i) = values_[structure_ + static_cast<std::size_t>(i)];
  loss_ += seconds * ((velocities * damping).cwiseProduct(velocities).rowwise().sum().dot(weight));
}

// F |u(end) - u(start)| of what slides over a segment, with what a belt moves on.
template <int N, int H>
void EnergyScreen<N, H>::add_friction(const Mode<N, H>& mode, const Step& first, const Step& last,
                                      const mechanics::LinearSystem& system) {
  const StepEquations<N, H>& eq = flow_.equations();
  const double steps = last.start + last.length - first.start;
  for (std::size_t e = 0; e < system.coefficients.size(); ++e) {
    const double force = system.coefficients[e].friction;
    if (force == 0.0) continue;
    const auto j = static_cast<Eigen::Index>(assembly_.shares()[e].contact);
    if (flow_.rests(mode, j)) continue;
    double slid = system.W.col(j).dot(last.right.z.head(eq.masses()) - first.left.z.head(eq.masses()));
    for (Eigen::Index s = 0; s < eq.motion.rows(); ++s)
      slid += system.W_support(s, j) *
              (eq.motion.row(s).dot(last.right.u - first.left.u) + system.belt_velocity[s] * eq.step * steps);
    loss_ += force * std::abs(slid);
  }
}

extern template class EnergyScreen<1, 1>;
extern template class EnergyScreen<2, 1>;
extern template class EnergyScreen<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
