#include "solvers/nonstop/nonstop_solver.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/solve.hpp"
#include "solvers/laws/coulomb.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/modes.hpp"

namespace frahm::periodic::nonstop {
bool NonstopSolver::asks(Measure measure) const {
  return std::ranges::any_of(request_.quantities,
                             [&](const Asked& asked) { return asked.quantity.measure == measure; });
}

bool NonstopSolver::serves(const mechanics::Assembly& assembly) {
  return assembly.contacts() <= kMostReversals && assembly.bends().count() == 0 &&
         !mechanics::has_belt(assembly.network()) && assembly.network().joints.empty() &&
         std::ranges::all_of(assembly.network().elements, [](const mechanics::Element& element) {
           return !mechanics::has_contact(element) || mechanics::kind_of(element).law == &laws::coulomb;
         });
}

NonstopSolver::NonstopSolver(const mechanics::Assembly& assembly, const std::vector<Quantity>& quantities)
    : assembly_(assembly), request_(values_of(quantities, assembly)) {
  measured_.assembly = &assembly_;
  measured_.traces = &request_.traces;
  for (std::size_t e = 0; e < assembly.network().elements.size(); ++e) {
    if (!mechanics::has_contact(assembly.network().elements[e])) elements_in_matrices_.push_back(e);
  }
  for (std::size_t i = 0; i < assembly.network().masses.size(); ++i) {
    const bool is_driven = std::ranges::any_of(assembly.network().excitations, [&](const auto& excitation) {
      return excitation.kind == mechanics::ExcitationKind::force && excitation.node == i;
    });
    if (is_driven) driven_masses_.push_back(static_cast<Eigen::Index>(i));
  }
}

// As the modes' own values, but for friction, forcing and a frequency on which no matrix depends.
bool NonstopSolver::shares_matrices(const mechanics::NetworkValues& values) const {
  const mechanics::NetworkValues& first = modes_of_;
  if (values.mass != first.mass || values.second != first.second || values.damping != first.damping ||
      values.element.size() != first.element.size())
    return false;
  for (const std::size_t e : elements_in_matrices_) {
    if (values.element[e] != first.element[e]) return false;
  }
  if (!assembly_.matrices_depend_on_frequency()) return true;
  return values.hysteretic_omega == first.hysteretic_omega &&
         (values.hysteretic_omega > 0.0 || values.omega == first.omega);
}

bool NonstopSolver::set_row(std::span<const mechanics::NetworkValues> points) {
  if (!has_modes_ || !shares_matrices(points[0])) {
    has_modes_ = false;
    for (mechanics::NetworkValues& values : values_) values = {};
    if (!set_point(0, points[0])) return false;
    modes_of_ = points[0];
    has_modes_ = set_matrices();
  }
  // The first two points and the last tell whether the row is worth the modes; set_point() looks at all.
  return has_modes_ && shares_matrices(points[points.size() > 1 ? 1 : 0]) && shares_matrices(points.back());
}

// Not where the response may be one of several: no proof holds there.
bool NonstopSolver::set_point(int lane, const mechanics::NetworkValues& values) {
  mechanics::LinearSystem& system = systems_[size(lane)];
  mechanics::NetworkValues& last = values_[size(lane)];
  if (has_modes_ && !shares_matrices(values)) return false;
  try {
    if (last.element.empty()) {
      assembly_.set_values(values, system);
    } else if (last.element != values.element) {
      assembly_.set_friction(values, system);
    } else if (!needs_forces_ && last.excitation == values.excitation && values.omega > 0.0 &&
               std::isfinite(values.omega)) {
      system.omega = values.omega;  // inputs are as they were, and nothing else is asked for
      return system.monotone;
    }
    assembly_.set_forcing(values, system);
  } catch (const mechanics::MechanicsError&) {
    last = {};
    return false;
  }
  last = values;
  return system.monotone;
}

bool NonstopSolver::set_matrices() {
  constexpr double kIllConditioned = 40.0;  // rounding grows as its square
  const mechanics::LinearSystem& system = systems_[0];
  if (system.free_directions.cols() > 0) return false;  // its sums over modes divide by their frequencies
  modes_ = sliding_modes(system);
  if (!(modes_.condition < kIllConditioned)) return false;
  M_inverse_ = algebra::inverse(system.M);
  K_inverse_ = algebra::inverse(system.K);
  left_force_ = modes_.left.middleCols(system.masses(), system.masses()) * M_inverse_;
  left_internal_ = modes_.left.rightCols(system.internal_forces());
  needs_forces_ = request_.needs.stability || request_.needs.integrals || asks(Measure::residual);
  fastest_rate_ = modes_.lambda.cwiseAbs().maxCoeff();
  displacement_of_energy_ = std::sqrt(2.0 * K_inverse_.diagonal().maxCoeff());
  friction_norm_ = (0.5 * (system.W.transpose() * K_inverse_ * system.W).diagonal()).cwiseSqrt();
  if (request_.needs.modes) modes_of(system, measured_.natural_frequency, measured_.modal_damping);
  lay_out_shape();
  set_forms();
  lay_out_pack();
  share_matrices();
  return true;
}

void NonstopSolver::solve(int count) {
  for (int lane = 0; lane < kLanes; ++lane) {
    give(pack_.is_there, 0, lane, lane < count ? 1.0 : 0.0);
    set_lane(std::min(lane, count - 1), lane);
  }
  kernel_->solve(pack_, workspace_);
}

// Inputs: the outside forces on the masses that are driven, then the motions of the supports.
void NonstopSolver::set_lane(int of, int lane) {
  const mechanics::LinearSystem& system = systems_[size(of)];
  const auto orders = system.orders.size(), contacts = size(system.contacts());
  give(pack_.omega, 0, lane, system.omega);
  for (Eigen::Index j = 0; j < system.contacts(); ++j) give(pack_.limit, size(j), lane, system.limit[j]);
  std::size_t input = 0;
  const auto give_input = [&](double constant, const auto& amplitudes) {
    give(pack_.constant_input, input, lane, constant);
    for (std::size_t k = 0; k < orders; ++k)
      give(pack_.input, input * orders + k, lane, amplitudes[static_cast<Eigen::Index>(k)]);
    ++input;
  };
  for (const Eigen::Index mass : driven_masses_)
    give_input(system.constant_applied_force[mass], system.applied_force.row(mass));
  for (Eigen::Index p = 0; p < system.constant_motion.size(); ++p)
    give_input(system.constant_motion[p], system.motion.row(p));
  for (const std::size_t f : forms_with_friction_) {
    const Form& form = forms_[f];
    for (std::size_t j = 0; j < contacts; ++j) give(pack_.form_own_friction, f * contacts + j, lane, 0.0);
    for (Eigen::Index e = 0; e < form.element.size(); ++e) {
      if (form.element[e] == 0.0) continue;
      const mechanics::ContactShare& share = assembly_.shares()[size(e)];
      pack_.form_own_friction[(f * contacts + share.contact) * kLanes + size(lane)] +=
          form.element[e] * share.orientation * system.coefficients[size(e)].friction;
    }
  }
}

}  // namespace frahm::periodic::nonstop
