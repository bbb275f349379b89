// What the kernel is given of a network and its matrices: forms, integrals and the pack's arrays.
#include <algorithm>
#include <complex>
#include <cstdint>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "solvers/nonstop/nonstop_solver.hpp"
#include "solvers/quantities/fundamental_response.hpp"

namespace frahm::periodic::nonstop {
namespace {

using std::complex;

// Whether the element's loss is the square of the velocity across it.
bool loses_by_velocity(const mechanics::Element& element) {
  const mechanics::ElementKind& kind = mechanics::kind_of(element);
  return kind.dissipates && kind.law == nullptr && !kind.has_internal_force;
}

}  // namespace

// The integrals that the quantities need, as entries of the Gram matrix, and the powers of the excitation.
void NonstopSolver::lay_out_shape() {
  const mechanics::LinearSystem& system = systems_[0];
  const mechanics::Network& network = assembly_.network();
  const Eigen::Index n = system.masses(), s = system.internal_forces(), oscillators = 2 * n + s;
  const Eigen::Index signals = oscillators + 1 + 2 * static_cast<Eigen::Index>(system.orders.size());
  products_.clear();
  entries_.clear();
  integrated_.clear();
  const auto add = [&](Eigen::Index row, Eigen::Index column) {
    const auto place = [&](Eigen::Index of) {
      const auto found = std::ranges::find(integrated_, of);
      const auto index = static_cast<int>(found - integrated_.begin());
      if (found == integrated_.end()) integrated_.push_back(of);
      return index;
    };
    const int a = place(row);
    const bool is_oscillator = column >= oscillators && column < signals;
    products_.push_back({a, is_oscillator ? -1 - static_cast<int>(column - oscillators) : place(column)});
    entries_.push_back({row, column});
  };
  if (request_.needs.integrals) {
    const Eigen::Index reference = oscillators + 1 + 2 * reference_column(system);
    const auto add_row = [&](Eigen::Index row) {
      for (const Eigen::Index column : {row, oscillators, reference, reference + 1}) add(row, column);
    };
    for (Eigen::Index i = 0; i < n; ++i) add_row(i);
    for (std::size_t i = 0; i < network.signals.size(); ++i) add_row(signals + static_cast<Eigen::Index>(i));
  }
  if (request_.needs.energies) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = i; k < n; ++k) {
        bool is_lossy = false, moves_support = false;
        for (std::size_t e = 0; e < network.elements.size(); ++e) {
          const mechanics::Incidence& at = assembly_.incidences()[e];
          if (!loses_by_velocity(network.elements[e]) || at.w[i] == 0.0 || at.w[k] == 0.0) continue;
          is_lossy = true;
          moves_support = moves_support || !at.p.isZero(0.0);
        }
        if (is_lossy) add(n + i, n + k);
        if (i != k || !moves_support) continue;
        for (Eigen::Index column = 1; column <= 2 * static_cast<Eigen::Index>(system.orders.size()); ++column)
          add(n + i, oscillators + column);
      }
    }
    for (Eigen::Index i = 0; i < s; ++i) add(2 * n + i, 2 * n + i);
  }
  // The squares of the rates of the structure's damping come after the entries.
  structural_rates_.resize(0, 0);
  if (request_.needs.energies) structural_rates_ = mechanics::structural_rates(system);
  for (Eigen::Index r = 0; r < structural_rates_.rows(); ++r) {
    const auto form = static_cast<int>(integrated_.size()) + static_cast<int>(r);
    products_.push_back({form, form});
  }
  shape_ = {};
  shape_.modes = static_cast<int>(modes_.modes());
  shape_.states = static_cast<int>(2 * n + s);
  shape_.contacts = static_cast<int>(system.contacts());
  shape_.orders = static_cast<int>(system.orders.size());
  shape_.traces = static_cast<int>(request_.traces.size());
  shape_.half_period = system.odd_response;
  shape_.asks_phases = std::ranges::any_of(request_.uses, &TraceUse::instant);
  shape_.asks_strokes = request_.needs.energies || request_.needs.histories || asks(Measure::events);
  shape_.may_stop_once = n == 1 && s == 0 && system.contacts() == 1 && system.odd_forcing &&
                         system.orders.size() == 1 && system.orders[0] == 1 &&
                         system.W_support.col(0).isZero(0.0);
  shape_.is_judged = request_.needs.stability || request_.needs.energies || asks(Measure::residual);
  shape_.is_pair = modes_.is_pair.data();
  shape_.order = systems_[0].orders.data();
}

void NonstopSolver::set_forms() {
  const mechanics::LinearSystem& system = systems_[0];
  const mechanics::Network& network = assembly_.network();
  const SlidingForms forms(assembly_, system);
  forms_.clear();
  for (const bool is_velocity : {true, false}) {
    for (Eigen::Index j = 0; j < system.contacts(); ++j) {
      const mechanics::Incidence at{system.W.col(j), system.W_support.col(j)};
      forms_.push_back(is_velocity ? forms.velocity(at) : forms.displacement(at));
    }
  }
  for (const Trace& trace : request_.traces) forms_.push_back(form_of(trace, forms, system));
  const std::size_t first = forms_.size();
  for (const Eigen::Index row : integrated_) forms_.push_back(integrated_form(forms, row));
  for (Eigen::Index r = 0; r < structural_rates_.rows(); ++r)
    forms_.push_back(forms.velocity(mechanics::structural_incidence(system, structural_rates_.row(r))));
  powers_.clear();
  const auto add_power = [&](Form force, Form velocity) {
    const auto index = static_cast<int>(forms_.size() - first);
    powers_.push_back({index, index + 1});
    forms_.push_back(std::move(force));
    forms_.push_back(std::move(velocity));
  };
  if (request_.needs.input) {
    for (const Eigen::Index mass : driven_masses_)
      add_power(forms.applied_force(mass), forms.state(system.masses() + mass));
    for (std::size_t i = 0; i < network.prescribed.size(); ++i) {
      const mechanics::Node node{mechanics::NodeKind::prescribed, i};
      add_power(forms.node_force(node, system), forms.support_velocity(static_cast<Eigen::Index>(i)));
    }
  }
  shape_.integrated = static_cast<int>(forms_.size() - first);
  shape_.products = static_cast<int>(products_.size());
  shape_.powers = static_cast<int>(powers_.size());
  shape_.product = products_.data();
  shape_.power = powers_.data();

  shape_.inputs = static_cast<int>(driven_masses_.size() + network.prescribed.size());
  is_direct_.clear();
  forms_with_friction_.clear();
  for (std::size_t f = 0; f < forms_.size(); ++f) {
    const Form& form = forms_[f];
    const bool is_of_state = form.motion.isZero(0.0) && form.velocity.isZero(0.0) &&
                             form.acceleration.isZero(0.0) && form.force.isZero(0.0) &&
                             form.applied.isZero(0.0);
    is_direct_.push_back(is_of_state ? 0 : 1);
    if (!form.element.isZero(0.0)) forms_with_friction_.push_back(f);
  }
  shape_.is_direct = is_direct_.data();
}

// A state itself, or the displacement of a signal.
Form NonstopSolver::integrated_form(const SlidingForms& forms, Eigen::Index row) const {
  const mechanics::LinearSystem& system = systems_[0];
  const Eigen::Index states = 2 * system.masses() + system.internal_forces();
  if (row < states) return forms.state(row);
  const Eigen::Index signals = states + 1 + 2 * static_cast<Eigen::Index>(system.orders.size());
  return forms.displacement(
      mechanics::coordinate_incidence(assembly_.network(), size(system.masses() + row - signals)));
}

void NonstopSolver::lay_out_pack() {
  const auto M = size(shape_.modes), D = size(shape_.states), m = size(shape_.contacts),
             H = size(shape_.orders), I = size(shape_.inputs), F = size(shape_.forms()),
             T = size(shape_.traces);
  struct Part {
    double** array;
    std::size_t values;
  };
  const Part parts[] = {{&pack_.is_there, 1},
                        {&pack_.omega, 1},
                        {&pack_.lambda, 2 * M},
                        {&pack_.mode_norm, M},
                        {&pack_.push, 2 * m * M},
                        {&pack_.unit_jump, 2 * m * M},
                        {&pack_.push_norm, m},
                        {&pack_.limit, m},
                        {&pack_.input, 2 * I * H},
                        {&pack_.constant_input, I},
                        {&pack_.mode_input, 6 * M * I},
                        {&pack_.form_modal, 2 * F * M},
                        {&pack_.form_input, 3 * F * I},
                        {&pack_.form_constant_input, F * I},
                        {&pack_.form_friction, F * m},
                        {&pack_.form_own_friction, F * m},
                        {&pack_.to_energy, D * D},
                        {&pack_.from_energy, D * D},
                        {&pack_.is_found, 1},
                        {&pack_.newton_iterations, 1},
                        {&pack_.reversals, 1},
                        {&pack_.margin, 1},
                        {&pack_.most, T},
                        {&pack_.least, T},
                        {&pack_.most_at, T},
                        {&pack_.least_at, T},
                        {&pack_.integral, size(shape_.products)},
                        {&pack_.work, size(shape_.powers)},
                        {&pack_.work_size, size(shape_.powers)},
                        {&pack_.slid, m},
                        {&pack_.contact_reversals, m},
                        {&pack_.slides, 1},
                        {&pack_.state_norm, 1},
                        {&pack_.residual, 1},
                        {&pack_.parts, 1},
                        {&pack_.multiplier, 1},
                        {&pack_.contraction, 1}};
  pack_.shape = &shape_;
  std::size_t values = 0;
  for (const Part& part : parts) values += part.values * kLanes;
  buffer_.assign(values + workspace_size(shape_) + kLanes, 0.0);
  // Aligned as the kernel's registers.
  const auto odd = reinterpret_cast<std::uintptr_t>(buffer_.data()) % (kLanes * sizeof(double));
  double* next = buffer_.data() + (odd == 0 ? 0 : kLanes - odd / sizeof(double));
  for (const Part& part : parts) {
    *part.array = next;
    next += part.values * kLanes;
  }
  workspace_ = next;
}

// What all lanes have in common.
void NonstopSolver::share_matrices() {
  const mechanics::LinearSystem& system = systems_[0];
  const auto share = [](double* array, std::size_t index, auto value) {
    for (int lane = 0; lane < kLanes; ++lane) give(array, index, lane, value);
  };
  const auto modes = size(modes_.modes());
  for (std::size_t s = 0; s < modes; ++s) {
    const auto mode = static_cast<Eigen::Index>(s);
    share(pack_.lambda, s, modes_.lambda[mode]);
    share(pack_.mode_norm, s, modes_.norms[mode]);
    for (Eigen::Index j = 0; j < system.contacts(); ++j) {
      const complex<double> push = left_force_.row(mode) * system.W.col(j);
      share(pack_.push, size(j) * modes + s, push);
      share(pack_.unit_jump, size(j) * modes + s, -2.0 * push / modes_.lambda[mode]);
    }
    for (std::size_t f = 0; f < forms_.size(); ++f) {
      share(pack_.form_modal, f * modes + s,
            complex<double>(forms_[f].state.transpose() * modes_.vectors.col(mode)));
    }
  }
  for (Eigen::Index j = 0; j < system.contacts(); ++j) {
    const double compliance = system.W.col(j).dot(M_inverse_ * system.W.col(j));
    share(pack_.push_norm, size(j), std::sqrt(0.5 * compliance));
  }
  share_inputs(share);
  // With the directions of the contacts held, friction moves the state by -K^-1 w_j F_j sigma_j.
  const Eigen::MatrixXd yielding = -K_inverse_ * system.W;
  const auto contacts = size(system.contacts());
  for (std::size_t f = 0; f < forms_.size(); ++f) {
    for (std::size_t j = 0; j < contacts; ++j) {
      const auto contact = static_cast<Eigen::Index>(j);
      share(pack_.form_friction, f * contacts + j,
            forms_[f].contact[contact] + forms_[f].state.head(system.masses()).dot(yielding.col(contact)));
    }
  }
  for (Eigen::Index i = 0; i < modes_.to_energy.size(); ++i) {
    const Eigen::Index row = i / shape_.states, column = i % shape_.states;
    share(pack_.to_energy, size(i), modes_.to_energy(row, column));
    share(pack_.from_energy, size(i), modes_.from_energy(row, column));
  }
}

// How inputs, their rates and the rates of these act on modes and forms, by
// f = f_applied - (K_s y + C_s y' + M_s y'') and the internal forces' k p^T y'.
template <class Share>
void NonstopSolver::share_inputs(const Share& share) {
  const mechanics::LinearSystem& system = systems_[0];
  const auto modes = size(modes_.modes()), inputs = size(shape_.inputs);
  const auto give_input = [&](std::size_t input, const Eigen::MatrixXd& force, Eigen::Index support) {
    // force: n x 3, of the input and its rates.  support: number of the one that moves, -1: none.
    for (std::size_t s = 0; s < modes; ++s) {
      const auto mode = static_cast<Eigen::Index>(s);
      Eigen::RowVectorXcd on = left_force_.row(mode) * force;
      if (support >= 0) {
        for (Eigen::Index i = 0; i < system.internal_forces(); ++i)
          on[1] += left_internal_(mode, i) * system.internal_stiffness[i] * system.D_support(support, i);
      }
      for (Eigen::Index rate = 0; rate < 3; ++rate) {
        share(pack_.mode_input, (s * inputs + input) * 3 + size(rate),
              complex<double>((modes_.is_pair[s] != 0 ? 0.5 : 1.0) * on[rate]));
      }
    }
    for (std::size_t f = 0; f < forms_.size(); ++f) {
      const Form& form = forms_[f];
      Eigen::RowVector3d on = form.force.transpose() * force;
      if (support >= 0) {
        on += Eigen::RowVector3d(form.motion[support], form.velocity[support], form.acceleration[support]);
      } else {
        on += form.applied.transpose() * force;
      }
      for (Eigen::Index rate = 0; rate < 3; ++rate)
        share(pack_.form_input, (f * inputs + input) * 3 + size(rate), on[rate]);
      share(pack_.form_constant_input, f * inputs + input,
            on[0] + form.state.head(system.masses()).dot(K_inverse_ * force.col(0)));
    }
  };
  std::size_t input = 0;
  for (const Eigen::Index mass : driven_masses_) {
    Eigen::MatrixXd force = Eigen::MatrixXd::Zero(system.masses(), 3);
    force(mass, 0) = 1.0;
    give_input(input++, force, -1);
  }
  for (Eigen::Index p = 0; p < system.constant_motion.size(); ++p) {
    Eigen::MatrixXd force(system.masses(), 3);
    force << -system.K_support.col(p), -system.C_support.col(p), -system.M_support.col(p);
    give_input(input++, force, p);
  }
}

}  // namespace frahm::periodic::nonstop
