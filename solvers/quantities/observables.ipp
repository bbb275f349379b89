// Included by observables.hpp.
namespace frahm::periodic {

template <int N, int H>
Observables<N, H>::Observables(const mechanics::Assembly& assembly, const Flow<N, H>& flow,
                               std::vector<Quantity> quantities)
    : assembly_(assembly),
      flow_(flow),
      forms_(assembly, flow),
      quantities_(std::move(quantities)),
      steps_(flow) {
  const auto masses = static_cast<Eigen::Index>(assembly.network().masses.size());
  const auto supports = static_cast<Eigen::Index>(assembly.network().prescribed.size());
  for (Eigen::Index i = 0; i < masses; ++i) {
    mass_incidences_.push_back({Eigen::VectorXd::Unit(masses, i), Eigen::VectorXd::Zero(supports)});
  }
  for (const Quantity& quantity : quantities_) plan(quantity);
}

// What has to be worked out for a quantity.
template <int N, int H>
void Observables<N, H>::plan(const Quantity& quantity) {
  const std::optional<Trace> trace = trace_of(quantity, assembly_);
  trace_index_.push_back(trace ? place_of(*trace, traces_) : 0);
  switch (quantity.measure) {
    case Measure::phase:
    case Measure::element_phase:
    case Measure::mean:
    case Measure::rms:
    case Measure::harmonic:
    case Measure::magnification:
    case Measure::transmissibility:
    case Measure::force_transmissibility:
      needs_integrals_ = true;
      break;
    case Measure::energy:
    case Measure::energy_share:
    case Measure::energy_input:
    case Measure::energy_balance:
      needs_integrals_ = needs_histories_ = true;
      break;
    case Measure::stops:
    case Measure::reversals:
    case Measure::stuck_fraction:
    case Measure::regime:
      needs_histories_ = true;
      break;
    case Measure::floquet_radius:
    case Measure::error_bound:
      needs_stability_ = true;
      break;
    case Measure::natural_frequency:
    case Measure::modal_damping:
      needs_modes_ = true;
      break;
    default:
      break;
  }
}

template <int N, int H>
void Observables<N, H>::set_system(const mechanics::LinearSystem& system) {
  if (needs_modes_) modes_of(system, natural_frequency_, modal_damping_);
}

template <int N, int H>
void Observables<N, H>::evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                                 std::span<double> out) {
  orbit_ = &orbit;
  system_ = &system;
  steps_.lay_out(orbit);
  if (needs_integrals_) integrate(orbit);
  extremes_.resize(traces_.size());
  for (std::size_t i = 0; i < traces_.size(); ++i) {
    const Extremes found = find_extremes(steps_, flow_, orbit.section, [&](const Mode<N, H>& mode) {
      return form_of(traces_[i], forms_, system.coefficients, mode);
    });
    extremes_[i] = orbit.half_period ? mirrored(found) : found;
  }
  if (needs_histories_) {
    histories_.resize(assembly_.contacts());
    for (std::size_t j = 0; j < histories_.size(); ++j) histories_[j] = history_of(j);
    if (needs_integrals_) balance_energy();
  }
  for (std::size_t i = 0; i < quantities_.size(); ++i) out[i] = value_of(i);
}

template <int N, int H>
void Observables<N, H>::fill_missing(Status status, std::span<double> out) const {
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    switch (quantities_[i].measure) {
      case Measure::status:
        out[i] = static_cast<double>(status);
        break;
      case Measure::regime:
        out[i] = static_cast<double>(Regime::not_computed);
        break;
      case Measure::stops:
      case Measure::reversals:
      case Measure::newton_iterations:
      case Measure::events:
        out[i] = -1.0;
        break;
      default:
        out[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

// What puts energy in: outside forces on masses, and what drives each prescribed node.
template <int N, int H>
void Observables<N, H>::integrate(const Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow_.equations();
  const auto powers_of = [&](const Mode<N, H>& mode, std::vector<typename Integrals<N, H>::Power>& powers) {
    powers.clear();
    for (Eigen::Index i = 0; i < eq.masses(); ++i) {
      if (eq.applied_force.row(i).isZero(0.0)) continue;
      Form force = forms_.zero();
      force.u = eq.applied_force.row(i).transpose();
      powers.push_back({force, forms_.velocity(mass_incidences_[static_cast<std::size_t>(i)])});
    }
    for (Eigen::Index s = 0; s < eq.motion.rows(); ++s) {
      Form velocity = forms_.zero();
      velocity.u = eq.motion_velocity.row(s).transpose() / eq.step;
      const mechanics::Node node{mechanics::NodeKind::prescribed, static_cast<std::size_t>(s)};
      powers.push_back({forms_.node_force(node, system_->coefficients, mode), velocity});
    }
  };
  integrals_.integrate(steps_, flow_, orbit.half_period, powers_of);
}

template <int N, int H>
ContactHistory Observables<N, H>::history_of(std::size_t contact) const {
  const auto column = static_cast<Eigen::Index>(contact);
  const StepEquations<N, H>& eq = flow_.equations();
  const bool moving_support = !eq.support_velocity.row(column).isZero(0.0);
  const auto relative = [&](const typename S::State& z, double at) {
    double u = system_->W.col(column).dot(z.head(eq.masses()));
    if (moving_support) {
      typename S::Oscillators oscillators(eq.oscillators());
      eq.oscillators_at(orbit_->section + at * flow_.fundamental_rate(), flow_.orders(), oscillators);
      u += (system_->W_support.col(column).transpose() * eq.motion).dot(oscillators);
    }
    return u;
  };
  return contact_history(*orbit_, flow_, column, relative);
}

template <int N, int H>
double Observables<N, H>::element_energy(std::size_t element) const {
  const mechanics::ElementCoefficients& law = system_->coefficients[element];
  double energy = 0.0;
  if (law.damping != 0.0) {
    // integral of c v^2
    const Form velocity = forms_.velocity(assembly_.incidences()[element]);
    energy += law.damping * integrals_.product(velocity, velocity);
  }
  if (law.internal >= 0) {
    // integral of s^2 / c
    Form force = forms_.zero();
    force.z[2 * flow_.equations().masses() + law.internal] = 1.0;
    energy += integrals_.product(force, force) / law.internal_damping;
  }
  if (law.friction != 0.0) {
    energy += law.friction * histories_[assembly_.shares()[element].contact].sliding_distance;
  }
  return energy;
}

template <int N, int H>
void Observables<N, H>::balance_energy() {
  dissipated_ = 0.0;
  for (std::size_t e = 0; e < assembly_.network().elements.size(); ++e) dissipated_ += element_energy(e);
}

// X_n of a form, x_n(t) = Re X_n e^{i n omega t} its component at the reference order n.
template <int N, int H>
std::complex<double> Observables<N, H>::reference_component(const Form& form) const {
  const int reference = assembly_.network().reference_order;
  if (orbit_->half_period && reference % 2 == 0) return 0.0;
  const auto& orders = flow_.orders();
  const auto place = std::find(orders.begin(), orders.end(), reference) - orders.begin();
  const auto component = [&](Eigen::Index oscillator) {
    Form unit = forms_.zero();
    unit.u[oscillator] = 1.0;
    return integrals_.product(form, unit);
  };
  const double period = flow_.equations().period * flow_.equations().step;
  return {2.0 / period * component(1 + 2 * place), -2.0 / period * component(2 + 2 * place)};
}

// x_n = |X_n| cos(n omega t - phase); NaN where there is none.
template <int N, int H>
double Observables<N, H>::phase_of(const Form& form, double magnitude) const {
  const std::complex<double> component = reference_component(form);
  if (std::abs(component) <= 1e-12 * magnitude) return std::numeric_limits<double>::quiet_NaN();
  return -std::arg(component);
}

template <int N, int H>
double Observables<N, H>::value_of(std::size_t i) const {
  const Quantity& quantity = quantities_[i];
  switch (quantity.measure) {
    case Measure::amplitude:
    case Measure::peak:
    case Measure::peak_phase:
    case Measure::velocity_peak:
    case Measure::acceleration_peak:
    case Measure::mean:
    case Measure::rms:
    case Measure::phase:
    case Measure::harmonic:
    case Measure::magnification:
    case Measure::transmissibility:
      return value_of_mass(i);
    case Measure::stroke:
    case Measure::force_peak:
    case Measure::element_phase:
    case Measure::energy:
    case Measure::energy_share:
    case Measure::stops:
    case Measure::reversals:
    case Measure::stuck_fraction:
    case Measure::regime:
      return value_of_element(i);
    case Measure::transmitted_force:
      return extremes_[trace_index_[i]].peak(quantity.side);
    default:
      return value_of_point(quantity);
  }
}

template <int N, int H>
double Observables<N, H>::value_of_mass(std::size_t i) const {
  const Quantity& quantity = quantities_[i];
  const auto mass = static_cast<Eigen::Index>(quantity.index);
  const Extremes extremes = traces_.empty() ? Extremes{} : extremes_[trace_index_[i]];
  const double period = flow_.equations().period * flow_.equations().step;  // [s]
  switch (quantity.measure) {
    case Measure::amplitude:
      return 0.5 * (extremes.most - extremes.least);
    case Measure::peak_phase:
      return std::isnan(extremes.most_phase) ? 0.0 : extremes.most_phase;  // 0: at rest all the time
    case Measure::mean: {
      if (orbit_->half_period) return 0.0;
      return integrals_.gram()(mass, flow_.equations().states()) / period;
    }
    case Measure::rms:
      return std::sqrt(integrals_.gram()(mass, mass) / period);
    case Measure::phase:
      return phase_of(forms_.displacement(mass_incidences_[quantity.index]), extremes.magnitude());
    case Measure::harmonic:
      return harmonic_of(quantity.index);
    case Measure::magnification:
      return ratio(harmonic_of(quantity.index), static_displacement(*system_)[mass]);
    case Measure::transmissibility:
      return ratio(harmonic_of(quantity.index), support_amplitude(*system_));
    default:
      return extremes.peak(quantity.side);
  }
}

template <int N, int H>
double Observables<N, H>::value_of_element(std::size_t i) const {
  const Quantity& quantity = quantities_[i];
  const std::size_t element = quantity.index;
  switch (quantity.measure) {
    case Measure::energy:
      return element_energy(element);
    case Measure::energy_share: {
      // Where nothing moves dampers lose the square of a rounding, which nobody has a share of.
      const double rounding = 1e-26 * flow_.static_norm() * flow_.static_norm();
      return dissipated_ > rounding ? element_energy(element) / dissipated_ : 0.0;
    }
    case Measure::element_phase:
      return phase_of(forms_.displacement(assembly_.incidences()[element]),
                      extremes_[trace_index_[i]].magnitude());
    case Measure::stroke:
    case Measure::force_peak:
      return extremes_[trace_index_[i]].peak(quantity.side);
    default:
      break;
  }
  const ContactHistory& history = histories_[assembly_.shares()[element].contact];
  switch (quantity.measure) {
    case Measure::stops:
      return history.stops;
    case Measure::reversals:
      return history.reversals;
    case Measure::stuck_fraction:
      return history.stuck_fraction;
    default:
      return static_cast<double>(regime_of(system_->coefficients[element].friction, history));
  }
}

template <int N, int H>
double Observables<N, H>::value_of_point(const Quantity& quantity) const {
  switch (quantity.measure) {
    case Measure::status:
      return static_cast<double>(orbit_->status);
    case Measure::floquet_radius:
      return orbit_->floquet_radius;
    case Measure::error_bound:
      return orbit_->error_bound;
    case Measure::force_transmissibility: {
      Eigen::VectorXcd X(system_->masses());
      for (Eigen::Index i = 0; i < X.size(); ++i) {
        X[i] = reference_component(forms_.displacement(mass_incidences_[static_cast<std::size_t>(i)]));
      }
      return force_transmissibility(*system_, X);
    }
    case Measure::residual:
      return orbit_->residual;
    case Measure::newton_iterations:
      return orbit_->newton_iterations;
    case Measure::events:
      return (orbit_->half_period ? 2.0 : 1.0) * orbit_->passage.events;
    case Measure::energy_input:
      return integrals_.input();
    case Measure::energy_balance: {
      // Where nothing moves both are rounding of the forcing's energy; where nothing that moves is strained
      // they are what the orbit's own energy fails to close by.
      const double forcing = flow_.static_norm(), moving = flow_.equations().energy_norm(orbit_->z);
      const double closing = 1e-13 + 100.0 * orbit_->residual;
      const double rounding = std::max(1e-11 * forcing * forcing, closing * moving * moving);
      const double size = std::max(integrals_.input_size(), dissipated_);
      return size > rounding ? std::abs(integrals_.input() - dissipated_) / size : 0.0;
    }
    case Measure::natural_frequency:
      return natural_frequency_[quantity.index];
    case Measure::modal_damping:
      return modal_damping_[quantity.index];
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace frahm::periodic
