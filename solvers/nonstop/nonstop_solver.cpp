#include "solvers/nonstop/nonstop_solver.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/laws/coulomb.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/quantities/fundamental_response.hpp"
#include "solvers/quantities/quantity_values.hpp"

namespace frahm::periodic::nonstop {
namespace {

using std::complex;

std::size_t size(Eigen::Index n) {
  return static_cast<std::size_t>(n);
}

// Whether the element's loss is the square of the velocity across it.
bool loses_by_velocity(const mechanics::Element& element) {
  const mechanics::ElementKind& kind = mechanics::kind_of(element);
  return kind.dissipates && kind.law == nullptr && !kind.has_internal_force;
}

bool asks(const Request& request, Measure measure) {
  return std::ranges::any_of(request.quantities,
                             [&](const Asked& asked) { return asked.quantity.measure == measure; });
}

}  // namespace

bool NonstopSolver::serves(const mechanics::Assembly& assembly) {
  return std::ranges::all_of(assembly.network().elements, [](const mechanics::Element& element) {
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
  if (values.mass != first.mass || values.second != first.second ||
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
      return true;
    }
    assembly_.set_forcing(values, system);
  } catch (const mechanics::MechanicsError&) {
    last = {};
    return false;
  }
  last = values;
  return true;
}

bool NonstopSolver::set_matrices() {
  constexpr double kIllConditioned = 30.0;  // rounding grows as its square
  const mechanics::LinearSystem& system = systems_[0];
  modes_ = sliding_modes(system);
  if (!(modes_.condition < kIllConditioned)) return false;
  M_inverse_ = algebra::inverse(system.M);
  K_inverse_ = algebra::inverse(system.K);
  left_force_ = modes_.left.middleCols(system.masses(), system.masses()) * M_inverse_;
  left_internal_ = modes_.left.rightCols(system.internal_forces());
  needs_forces_ = request_.needs.stability || request_.needs.integrals || asks(request_, Measure::residual);
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

// The integrals that the quantities need, as entries of the Gram matrix, and the powers of the excitation.
void NonstopSolver::lay_out_shape() {
  const mechanics::LinearSystem& system = systems_[0];
  const mechanics::Network& network = assembly_.network();
  const Eigen::Index n = system.masses(), s = system.internal_forces(), oscillators = 2 * n + s;
  products_.clear();
  entries_.clear();
  integrated_states_.clear();
  const auto add = [&](Eigen::Index row, Eigen::Index column) {
    const auto place = [&](Eigen::Index state) {
      const auto found = std::ranges::find(integrated_states_, state);
      const auto index = static_cast<int>(found - integrated_states_.begin());
      if (found == integrated_states_.end()) integrated_states_.push_back(state);
      return index;
    };
    const int a = place(row);
    products_.push_back(
        {a, column < oscillators ? place(column) : -1 - static_cast<int>(column - oscillators)});
    entries_.push_back({row, column});
  };
  if (request_.needs.integrals) {
    const Eigen::Index reference = oscillators + 1 + 2 * reference_column(system);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (const Eigen::Index column : {i, oscillators, reference, reference + 1}) add(i, column);
    }
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
  shape_ = {};
  shape_.modes = static_cast<int>(modes_.modes());
  shape_.states = static_cast<int>(2 * n + s);
  shape_.contacts = static_cast<int>(system.contacts());
  shape_.orders = static_cast<int>(system.orders.size());
  shape_.traces = static_cast<int>(request_.traces.size());
  shape_.half_period = system.odd_forcing;
  shape_.asks_phases = std::ranges::any_of(request_.uses, &TraceUse::instant);
  shape_.asks_strokes =
      request_.needs.energies || request_.needs.histories || asks(request_, Measure::events);
  shape_.may_stop_once = n == 1 && s == 0 && system.contacts() == 1 && system.odd_forcing &&
                         system.orders.size() == 1 && system.orders[0] == 1 &&
                         system.W_support.col(0).isZero(0.0);
  shape_.is_judged = request_.needs.stability || request_.needs.energies || asks(request_, Measure::residual);
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
  for (const Trace& trace : request_.traces) forms_.push_back(form_of(trace, forms, system.coefficients));
  const std::size_t first = forms_.size();
  for (const Eigen::Index state : integrated_states_) forms_.push_back(forms.state(state));
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
      add_power(forms.node_force(node, system.coefficients),
                forms.support_velocity(static_cast<Eigen::Index>(i)));
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
    is_direct_.push_back(!(form.motion.isZero(0.0) && form.velocity.isZero(0.0) &&
                           form.acceleration.isZero(0.0) && form.force.isZero(0.0) &&
                           form.applied.isZero(0.0)));
    if (!form.element.isZero(0.0)) forms_with_friction_.push_back(f);
  }
  shape_.is_direct = is_direct_.data();
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
                        {&pack_.section, 1},
                        {&pack_.state, 2 * M},
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

bool NonstopSolver::quantities(int lane, std::span<double> out) {
  constexpr double kBalanced = 1e-9;
  measure(lane);
  if (request_.needs.input && !(value::energy_balance(measured_, {}) <= kBalanced)) return false;
  tell_values(request_, measured_, out);
  return true;
}

// sqrt(1/2 sum_k f_k^H K^-1 f_k), the constant included.
double NonstopSolver::static_norm(const mechanics::LinearSystem& system) const {
  double sum = system.constant_force.dot(K_inverse_ * system.constant_force);
  for (Eigen::Index k = 0; k < system.force.cols(); ++k) {
    for (Eigen::Index i = 0; i < K_inverse_.rows(); ++i) {
      for (Eigen::Index j = 0; j < K_inverse_.cols(); ++j) {
        sum += K_inverse_(i, j) * (system.force(i, k).real() * system.force(j, k).real() +
                                   system.force(i, k).imag() * system.force(j, k).imag());
      }
    }
  }
  return std::sqrt(0.5 * sum);
}

// From what the kernel told to what all quantities follow from.
void NonstopSolver::measure(int lane) {
  const mechanics::LinearSystem& system = systems_[size(lane)];
  Measured& m = measured_;
  m.system = &system;
  m.period = 2.0 * std::numbers::pi / system.omega;
  m.half_period = shape_.half_period;
  m.status = Status::ok;
  m.newton_iterations = static_cast<int>(told(pack_.newton_iterations, 0, lane));
  m.events = 0;
  m.extremes.resize(request_.traces.size());
  for (std::size_t t = 0; t < m.extremes.size(); ++t) {
    Extremes& x = m.extremes[t];
    x.most = told(pack_.most, t, lane);
    x.least = told(pack_.least, t, lane);
    if (!shape_.asks_phases) continue;
    x.most_phase = whole_turns_removed(told(pack_.most_at, t, lane));
    x.least_phase = whole_turns_removed(shape_.half_period ? x.most_phase + std::numbers::pi
                                                           : told(pack_.least_at, t, lane));
  }
  m.histories.resize(size(shape_.contacts));
  for (std::size_t j = 0; j < m.histories.size(); ++j) {
    m.histories[j] = {};
    m.histories[j].reversals = static_cast<int>(told(pack_.contact_reversals, j, lane));
    m.events += m.histories[j].reversals;
    if (const double slides = told(pack_.slides, 0, lane); slides < 1.0) {
      m.histories[j].stops = m.histories[j].reversals;  // one at each, or none where nothing moves
      m.histories[j].stuck_fraction = 1.0 - slides;
      m.events += m.histories[j].stops;  // with a release each
    }
    m.histories[j].sliding_distance = told(pack_.slid, j, lane);
  }
  if (shape_.is_judged) {
    m.static_norm = static_norm(system);
    m.state_norm = told(pack_.state_norm, 0, lane);
    m.residual = told(pack_.residual, 0, lane) / std::max(m.state_norm, m.static_norm);
    m.floquet_radius = told(pack_.multiplier, 0, lane);
    m.error_bound = error_bound(lane);
  }
  if (request_.needs.integrals) {
    const Eigen::Index first = m.oscillators();
    const auto oscillators = static_cast<Eigen::Index>(1 + 2 * system.orders.size());
    m.gram.setZero(first + oscillators, first + oscillators);
    for (std::size_t p = 0; p < entries_.size(); ++p) {
      const double integral = told(pack_.integral, p, lane);
      m.gram(entries_[p].row, entries_[p].column) = m.gram(entries_[p].column, entries_[p].row) = integral;
    }
    for (Eigen::Index k = 0; k < oscillators; ++k)
      m.gram(first + k, first + k) = k == 0 ? m.period : 0.5 * m.period;
    set_motion(system);
  }
  m.input = m.input_size = 0.0;
  for (std::size_t p = 0; p < powers_.size(); ++p) {
    m.input += told(pack_.work, p, lane);
    m.input_size += told(pack_.work_size, p, lane);
  }
  if (!request_.needs.energies) return;
  m.friction_loss.assign(system.coefficients.size(), 0.0);
  for (std::size_t e = 0; e < system.coefficients.size(); ++e) {
    const double force = system.coefficients[e].friction;
    if (force == 0.0) continue;
    m.friction_loss[e] = force * m.histories[assembly_.shares()[e].contact].sliding_distance;
  }
  value::add_up_losses(m);
}

// Motion and velocity of the prescribed nodes as rows on the oscillators: Re(Y e^{i n phase}).
void NonstopSolver::set_motion(const mechanics::LinearSystem& system) {
  const auto oscillators = static_cast<Eigen::Index>(1 + 2 * system.orders.size());
  measured_.motion.setZero(system.constant_motion.size(), oscillators);
  measured_.motion_velocity.setZero(system.constant_motion.size(), oscillators);
  for (Eigen::Index p = 0; p < system.constant_motion.size(); ++p) {
    measured_.motion(p, 0) = system.constant_motion[p];
    for (std::size_t k = 0; k < system.orders.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const complex<double> Y = system.motion(p, column);
      const complex<double> V = complex<double>(0.0, system.orders[k] * system.omega) * Y;
      measured_.motion(p, 1 + 2 * column) = Y.real();
      measured_.motion(p, 2 + 2 * column) = -Y.imag();
      measured_.motion_velocity(p, 1 + 2 * column) = V.real();
      measured_.motion_velocity(p, 2 + 2 * column) = -V.imag();
    }
  }
}

// As the certificate of any orbit (orbits/certificate.hpp): ||z - z*||_E <= (||r||_E + rounding) / (1 - L),
// |x_n| <= sqrt(2 (K^-1)_nn) ||z||_E. Rounding grows with the number of radians of the fastest mode and by
// way of the modes.
double NonstopSolver::error_bound(int lane) const {
  const mechanics::LinearSystem& system = systems_[size(lane)];
  const double contraction = told(pack_.contraction, 0, lane), margin = told(pack_.margin, 0, lane);
  const double scale = std::max(told(pack_.state_norm, 0, lane), measured_.static_norm);
  const double friction = system.limit.dot(friction_norm_);
  const double radians = fastest_rate_ * measured_.period;
  const double operations =
      modes_.condition * modes_.condition * (16.0 + 2.0 * radians) + 16.0 * told(pack_.reversals, 0, lane);
  const double rounding =
      std::numeric_limits<double>::epsilon() * operations * (scale + friction + told(pack_.parts, 0, lane));
  const double ball = (told(pack_.residual, 0, lane) + rounding) / (1.0 - contraction);
  const bool holds = contraction < 1.0 && ball < 0.1 * margin * scale;
  return holds ? ball * displacement_of_energy_ : kNone;
}

}  // namespace frahm::periodic::nonstop
