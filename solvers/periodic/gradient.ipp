// Included by gradient.hpp.
namespace frahm::periodic {

template <int N, int H>
Gradient<N, H>::Gradient(const mechanics::Assembly& assembly, const Flow<N, H>& flow,
                         std::vector<Quantity> quantities)
    : assembly_(assembly),
      flow_(flow),
      forms_(assembly, flow),
      quantities_(std::move(quantities)),
      why_none_(quantities_.size(), ""),
      steps_(flow),
      sensitivity_(flow) {
  for (const Quantity& quantity : quantities_) {
    const bool is_phase = quantity.measure == Measure::phase || quantity.measure == Measure::element_phase;
    const std::optional<Trace> trace = is_phase ? std::nullopt : trace_of(quantity, assembly);
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
      case Measure::energy:
      case Measure::energy_share:
      case Measure::energy_input:
        needs_integrals_ = true;
        break;
      case Measure::natural_frequency:
      case Measure::modal_damping:
        needs_modes_ = true;
        break;
      default:
        break;
    }
  }
  candidates_.resize(traces_.size());
}

template <int N, int H>
const char* Gradient<N, H>::evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                                     const mechanics::NetworkValues& values,
                                     std::span<const mechanics::NetworkValues> directions,
                                     std::span<double> out) {
  orbit_ = &orbit;
  system_ = &system;
  values_ = &values;
  std::fill(why_none_.begin(), why_none_.end(), "");
  const char* reason = why_no_orbit_derivative(orbit);
  if (*reason == '\0') reason = sensitivity_.prepare(orbit, steps_);
  if (*reason == '\0') reason = differentiate_all(directions, out);
  if (*reason == '\0') return reason;
  std::fill(out.begin(), out.end(), std::numeric_limits<double>::quiet_NaN());
  std::fill(why_none_.begin(), why_none_.end(), reason);
  return reason;
}

template <int N, int H>
const char* Gradient<N, H>::why_no_orbit_derivative(const Orbit<N, H>& orbit) {
  switch (orbit.status) {
    case Status::ok:
      return "";
    case Status::grazing:
      return "grazing: an event only just happens, and the derivatives on both sides differ";
    case Status::unbounded:
      return "the response is unbounded";
    default:
      return "there is no response";
  }
}

template <int N, int H>
const char* Gradient<N, H>::differentiate_all(std::span<const mechanics::NetworkValues> directions,
                                              std::span<double> out) {
  for (std::size_t i = 0; i < traces_.size(); ++i) {
    const auto form = [&](const Mode<N, H>& mode) {
      return form_of(traces_[i], forms_, system_->laws, mode);
    };
    find_candidates(steps_, flow_, orbit_->section, form, candidates_[i]);
  }
  if (needs_integrals_) {
    integrals_.integrate(steps_, flow_, orbit_->half_period,
                         [](const auto&, auto& powers) { powers.clear(); });
  }
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const char* reason =
        differentiate(directions[d], out.subspan(d * quantities_.size(), quantities_.size()));
    if (*reason != '\0') return reason;
  }
  return "";
}

template <int N, int H>
const char* Gradient<N, H>::differentiate(const mechanics::NetworkValues& direction, std::span<double> out) {
  mechanics::differentiate(assembly_, *values_, direction, *system_, system_by_);
  by_.set(flow_.equations(), *system_, system_by_);
  if (const char* reason = sensitivity_.differentiate(by_); *reason != '\0') return reason;
  if (needs_integrals_) integrate();
  if (needs_modes_) modes_derivative(*system_, system_by_, natural_frequency_by_, modal_damping_by_);
  for (std::size_t i = 0; i < quantities_.size(); ++i) out[i] = derivative_of(i);
  return "";
}

// d of the integral of y y^T dt: y is continuous at events, so that their shifts add nothing, and dt in
// seconds grows with the step.
template <int N, int H>
void Gradient<N, H>::integrate() {
  const StepEquations<N, H>& eq = flow_.equations();
  using Nodes = Eigen::Matrix<double, kTerms, kNodes>;
  Eigen::Matrix<double, Integrals<N, H>::kSize, kNodes> y(eq.states() + eq.oscillators(), kNodes);
  Eigen::Matrix<double, S::kState, kNodes> y_by(eq.states(), kNodes);
  const auto steps = steps_.steps();
  gram_by_.setZero(y.rows(), y.rows());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    Nodes at;
    for (int node = 0; node < kNodes; ++node) at.col(node) = powers(kNodeAt[node] * steps[i].length);
    y.topRows(eq.states()).noalias() = steps[i].expansion.z.transpose() * at;
    y.bottomRows(eq.oscillators()).noalias() = steps[i].expansion.u.transpose() * at;
    y_by.noalias() = sensitivity_.polynomials(i).transpose() * at;
    for (int node = 0; node < kNodes; ++node) y_by.col(node) *= steps[i].length * kNodeWeight[node];
    gram_by_.topRows(eq.states()).noalias() += y_by * y.transpose();
  }
  gram_by_ = (gram_by_ + gram_by_.transpose()).eval() * ((orbit_->half_period ? 2.0 : 1.0) * eq.step);
  gram_by_ += by_.log_step * integrals_.gram();
}

template <int N, int H>
double Gradient<N, H>::none(std::size_t quantity, const char* reason) {
  why_none_[quantity] = reason;
  return std::numeric_limits<double>::quiet_NaN();
}

template <int N, int H>
double Gradient<N, H>::derivative_of(std::size_t i) {
  const Quantity& quantity = quantities_[i];
  const auto mass = static_cast<Eigen::Index>(quantity.index);
  const double period = flow_.equations().period * flow_.equations().step;  // [s]
  switch (quantity.measure) {
    case Measure::peak:
    case Measure::velocity_peak:
    case Measure::acceleration_peak:
    case Measure::stroke:
    case Measure::force_peak:
    case Measure::transmitted_force:
      return extreme(i, quantity.side);
    case Measure::amplitude:
      return 0.5 * (extreme(i, Side::most) + extreme(i, Side::least));
    case Measure::peak_phase:
      return peak_phase(i);
    case Measure::mean: {
      if (orbit_->half_period) return 0.0;
      const Eigen::Index one = flow_.equations().states();
      return (gram_by_(mass, one) - by_.log_step * integrals_.gram()(mass, one)) / period;
    }
    case Measure::rms:
      return root_mean_square(i);
    case Measure::phase:
      return phase(i, mass_incidence(assembly_.network(), quantity.index));
    case Measure::harmonic:
    case Measure::magnification:
    case Measure::transmissibility:
      return harmonic_ratio(i);
    case Measure::element_phase:
    case Measure::energy:
    case Measure::energy_share:
    case Measure::stuck_fraction:
      return derivative_of_element(i);
    default:
      return derivative_of_point(i);
  }
}

template <int N, int H>
double Gradient<N, H>::derivative_of_element(std::size_t i) {
  const std::size_t element = quantities_[i].index;
  switch (quantities_[i].measure) {
    case Measure::element_phase:
      return phase(i, assembly_.incidences()[element]);
    case Measure::energy:
      return element_loss(element).by;
    case Measure::stuck_fraction:
      return stuck_fraction(assembly_.shares()[element].contact);
    default: {
      const Loss own = element_loss(element), all = all_losses();
      if (!(all.value > 1e-26 * flow_.static_norm() * flow_.static_norm()))
        return none(i, "nothing is dissipated");
      return (own.by - own.value / all.value * all.by) / all.value;
    }
  }
}

template <int N, int H>
double Gradient<N, H>::derivative_of_point(std::size_t i) {
  const Quantity& quantity = quantities_[i];
  switch (quantity.measure) {
    case Measure::energy_input:
      return all_losses().by;  // work in = energy lost, for every orbit
    case Measure::force_transmissibility:
      return force_transmissibility_by(i);
    case Measure::natural_frequency:
    case Measure::modal_damping: {
      const auto& by =
          quantity.measure == Measure::natural_frequency ? natural_frequency_by_ : modal_damping_by_;
      if (std::isnan(by[quantity.index])) return none(i, "two modes have one frequency");
      return by[quantity.index];
    }
    default:
      return none(i, "it is not differentiated");
  }
}

// ---- Extremes

// The envelope theorem: at a stationary value only the trace itself changes; a one-sided limit moves with its
// event besides.
template <int N, int H>
double Gradient<N, H>::at_candidate(std::size_t trace, const Candidate<N, H>& candidate) const {
  const TraceDerivative<N, H> traced(assembly_, flow_, sensitivity_, system_->laws, system_by_.laws);
  const InstantDerivative<N, H> d = sensitivity_.at(candidate.step, candidate.s, candidate.at);
  const std::size_t mode = steps_.steps()[candidate.step].mode;
  double by = traced.of(traces_[trace], candidate.at, d, mode);
  if (candidate.change >= 0) {
    by += candidate.slope * sensitivity_.shift(static_cast<std::size_t>(candidate.change));
  }
  return by;
}

template <int N, int H>
double Gradient<N, H>::extreme(std::size_t i, Side side) {
  constexpr double kAgree = 1e-7;  // of derivatives that are one but for rounding
  const std::size_t trace = trace_index_[i];
  Extremes found;
  for (const auto& candidate : candidates_[trace]) {
    found.most = std::max(found.most, candidate.value);
    found.least = std::min(found.least, candidate.value);
  }
  const double magnitude = found.magnitude(), tie = kTiedExtremes * magnitude;
  if (orbit_->half_period) side = Side::either;  // both sides are alike
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  for (const auto& candidate : candidates_[trace]) {
    const bool at_most = side == Side::either ? candidate.value >= magnitude - tie
                                              : side == Side::most && candidate.value >= found.most - tie;
    const bool at_least = side == Side::either ? candidate.value <= tie - magnitude
                                               : side == Side::least && candidate.value <= found.least + tie;
    if (!at_most && !at_least) continue;
    const double by = at_candidate(trace, candidate);
    if (at_most) {
      smallest = std::min(smallest, by);
      largest = std::max(largest, by);
    }
    if (at_least) {
      smallest = std::min(smallest, -by);
      largest = std::max(largest, -by);
    }
  }
  if (largest - smallest > kAgree * std::max(std::abs(largest), std::abs(smallest)))
    return none(i, "two extremes tie: it has a kink here");
  return 0.5 * (largest + smallest);
}

// Of omega t where the largest value is first reached, omega h held.
template <int N, int H>
double Gradient<N, H>::peak_phase(std::size_t i) {
  const std::size_t trace = trace_index_[i];
  double most = 0.0;
  for (const auto& candidate : candidates_[trace])
    most = std::max(most, orbit_->half_period ? std::abs(candidate.value) : candidate.value);
  const Candidate<N, H>* peak = nullptr;
  for (const auto& candidate : candidates_[trace]) {
    const double value = orbit_->half_period ? std::abs(candidate.value) : candidate.value;
    if (!candidate.reached || value < most - kTiedExtremes * std::abs(most)) continue;
    if (peak != nullptr) return none(i, "two extremes tie: it has a jump here");
    peak = &candidate;
  }
  if (peak == nullptr) return none(i, "the largest value is held, never reached");
  if (!peak->stationary) {
    return flow_.fundamental_rate() * sensitivity_.shift(static_cast<std::size_t>(peak->change));
  }
  // u'(t) = 0:  dt = -du' / u''
  const Eigen::Index mass = static_cast<Eigen::Index>(quantities_[i].index), n = flow_.equations().masses();
  const InstantDerivative<N, H> d = sensitivity_.at(peak->step, peak->s, peak->at);
  return -flow_.fundamental_rate() * d.z[n + mass] / peak->at.a[mass];
}

// ---- Integrals

// d of the integral of f g for a g that does not change.
template <int N, int H>
double Gradient<N, H>::product(const Form& f, const Form& f_by, const Form& g) const {
  const auto joined = [](const Form& form) { return Integrals<N, H>::joined(form); };
  return joined(f).dot(gram_by_ * joined(g)) + integrals_.product(f_by, g);
}

template <int N, int H>
LinearForm<N, H> Gradient<N, H>::displacement_derivative(const mechanics::Incidence& at) const {
  Form form = forms_.zero();
  if (at.p.size() > 0) form.u = by_.motion.transpose() * at.p;
  return form;
}

template <int N, int H>
LinearForm<N, H> Gradient<N, H>::velocity_derivative(const mechanics::Incidence& at,
                                                     const Form& velocity) const {
  Form form = forms_.zero();
  if (at.p.size() > 0) form.u = by_.motion_velocity.transpose() * at.p / flow_.equations().step;
  return form.add(-by_.log_step, velocity);
}

template <int N, int H>
typename Gradient<N, H>::Component Gradient<N, H>::reference_component(const mechanics::Incidence& at) const {
  const int reference = assembly_.network().reference_order;
  if (orbit_->half_period && reference % 2 == 0) return {};
  const Eigen::Index place = reference_place(*system_);
  const Form form = forms_.displacement(at), form_by = displacement_derivative(at);
  const double period = flow_.equations().period * flow_.equations().step;
  const auto component = [&](Eigen::Index oscillator) -> std::pair<double, double> {
    Form unit = forms_.zero();
    unit.u[oscillator] = 2.0 / period;
    const double value = integrals_.product(form, unit);
    return {value, product(form, form_by, unit) - by_.log_step * value};
  };
  const auto [real, real_by] = component(1 + 2 * place);
  const auto [imaginary, imaginary_by] = component(2 + 2 * place);
  return {{real, -imaginary}, {real_by, -imaginary_by}};
}

// The phase lag is -arg X:  d = -Im(conj(X) dX) / |X|^2
template <int N, int H>
double Gradient<N, H>::phase(std::size_t i, const mechanics::Incidence& at) {
  const auto [X, X_by] = reference_component(at);
  if (X == 0.0) return none(i, "there is no component at the reference order");
  return -(std::conj(X) * X_by).imag() / std::norm(X);
}

template <int N, int H>
double Gradient<N, H>::harmonic_ratio(std::size_t i) {
  const Quantity& quantity = quantities_[i];
  const auto [X, X_by] = reference_component(mass_incidence(assembly_.network(), quantity.index));
  if (X == 0.0) return none(i, "there is no component at the reference order");
  double below = 1.0, below_by = 0.0;
  if (quantity.measure == Measure::magnification) {
    const auto mass = static_cast<Eigen::Index>(quantity.index);
    below = static_displacement(*system_)[mass];
    if (below > 0.0) below_by = static_displacement_derivative(*system_, system_by_)[mass];
  } else if (quantity.measure == Measure::transmissibility) {
    below = support_amplitude(*system_);
    if (below > 0.0) below_by = support_amplitude_derivative(*system_, system_by_);
  }
  if (!(below > 0.0)) return none(i, "it has no value");
  return (modulus_derivative(X, X_by) - std::abs(X) / below * below_by) / below;
}

template <int N, int H>
double Gradient<N, H>::force_transmissibility_by(std::size_t i) {
  const auto& network = assembly_.network();
  Eigen::VectorXcd X(system_->masses()), X_by(system_->masses());
  for (std::size_t mass = 0; mass < network.masses.size(); ++mass) {
    const Component component = reference_component(mass_incidence(network, mass));
    X[static_cast<Eigen::Index>(mass)] = component.value;
    X_by[static_cast<Eigen::Index>(mass)] = component.by;
  }
  const double by = force_transmissibility_derivative(*system_, system_by_, X, X_by);
  return std::isnan(by) ? none(i, "no force is applied at the reference order") : by;
}

// sqrt(G/T):  d = (dG - G dT/T) / (2 T rms)
template <int N, int H>
double Gradient<N, H>::root_mean_square(std::size_t i) {
  const auto mass = static_cast<Eigen::Index>(quantities_[i].index);
  const double period = flow_.equations().period * flow_.equations().step;
  const double square = integrals_.gram()(mass, mass);
  if (!(square > 0.0)) return none(i, "nothing moves");
  return (gram_by_(mass, mass) - by_.log_step * square) / (2.0 * std::sqrt(square * period));
}

// ---- Losses

// Integral of c v^2, of s^2 / c, and friction times the distance slid.
template <int N, int H>
typename Gradient<N, H>::Loss Gradient<N, H>::element_loss(std::size_t e) const {
  const mechanics::ElementLaw &law = system_->laws[e], &law_by = system_by_.laws[e];
  Loss loss;
  if (law.damping != 0.0 || law_by.damping != 0.0) {
    const Form v = forms_.velocity(assembly_.incidences()[e]);
    const Form v_by = velocity_derivative(assembly_.incidences()[e], v);
    const double square = integrals_.product(v, v);
    loss.value += law.damping * square;
    loss.by += law_by.damping * square + law.damping * (product(v, v_by, v) + integrals_.product(v, v_by));
  }
  if (law.maxwell >= 0) {
    const Eigen::Index place = 2 * flow_.equations().masses() + law.maxwell;
    const double value = integrals_.gram()(place, place) / law.maxwell_damping;
    loss.value += value;
    loss.by += (gram_by_(place, place) - value * law_by.maxwell_damping) / law.maxwell_damping;
  }
  if (law.friction != 0.0 || law_by.friction != 0.0) {
    const Loss distance = sliding_distance(assembly_.shares()[e].contact);
    loss.value += law.friction * distance.value;
    loss.by += law_by.friction * distance.value + law.friction * distance.by;
  }
  return loss;
}

template <int N, int H>
typename Gradient<N, H>::Loss Gradient<N, H>::all_losses() const {
  Loss sum;
  for (std::size_t e = 0; e < assembly_.network().elements.size(); ++e) {
    const Loss loss = element_loss(e);
    sum.value += loss.value;
    sum.by += loss.by;
  }
  return sum;
}

// Sum of sigma (u(end) - u(start)) over the steps in which the contact slides; at the ends of its slides its
// velocity is zero, so that they may shift.
template <int N, int H>
typename Gradient<N, H>::Loss Gradient<N, H>::sliding_distance(std::size_t contact) const {
  const auto j = static_cast<Eigen::Index>(contact);
  const Eigen::Index n = flow_.equations().masses();
  const auto w = flow_.equations().W.col(j);
  const Eigen::RowVectorXd support = system_->W_support.col(j).transpose() * flow_.equations().motion;
  Loss distance;
  const auto steps = steps_.steps();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const OrbitStep<N, H>& step = steps[i];
    const Mode<N, H>& mode = flow_.mode(step.mode);
    if (contains(mode.stuck, j)) continue;
    const auto& p = sensitivity_.polynomials(i);
    const typename S::State d = p.transpose() * powers(step.length);
    const typename S::Oscillators du = step.right.u - step.left.u;
    distance.value += mode.sign(j) * (w.dot(step.right.z.head(n) - step.left.z.head(n)) + support.dot(du));
    distance.by += mode.sign(j) * (w.dot(d.head(n) - p.row(0).head(n).transpose()) +
                                   by_.support_displacement.row(j).dot(du));
  }
  const double halves = orbit_->half_period ? 2.0 : 1.0;
  return {halves * distance.value, halves * distance.by};
}

template <int N, int H>
double Gradient<N, H>::stuck_fraction(std::size_t contact) const {
  const auto& segments = orbit_->passage.segments;
  double stuck_by = 0.0;  // [steps]
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (!contains(flow_.mode(segments[k].mode).stuck, static_cast<Eigen::Index>(contact))) continue;
    if (k + 1 < segments.size()) stuck_by += sensitivity_.shift(k);
    if (k > 0) stuck_by -= sensitivity_.shift(k - 1);
  }
  return stuck_by / ((orbit_->half_period ? 0.5 : 1.0) * flow_.equations().period);
}

}  // namespace frahm::periodic
