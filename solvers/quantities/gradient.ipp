// Gradient: what is differentiated, and extremes. Included by gradient.hpp.
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
    std::optional<Trace> trace = trace_of(quantity, assembly);
    switch (quantity.measure) {
      case Measure::harmonic:
      case Measure::magnification:
      case Measure::transmissibility:
        trace = Trace{.at = mass_incidence(assembly.network(), quantity.index)};
        needs_integrals_ = true;
        break;
      case Measure::phase:
      case Measure::element_phase:
      case Measure::mean:
      case Measure::rms:
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
    trace_index_.push_back(trace ? place_of(std::move(*trace), traces_) : 0);
  }
  candidates_.resize(traces_.size());
  extremes_.resize(traces_.size());
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
const char* Gradient<N, H>::differentiate_all(std::span<const mechanics::NetworkValues> directions,
                                              std::span<double> out) {
  for (std::size_t i = 0; i < traces_.size(); ++i) {
    const auto form = [&](const Mode<N, H>& mode) {
      return form_of(traces_[i], forms_, system_->coefficients, mode);
    };
    extremes_[i] = find_candidates(steps_, flow_, orbit_->section, orbit_->sign(), form, candidates_[i]);
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

// The envelope theorem: at a stationary value only the trace itself changes; a one-sided limit moves with its
// event besides.
template <int N, int H>
double Gradient<N, H>::at_candidate(std::size_t trace, const Candidate<N, H>& candidate) const {
  const TraceDerivative<N, H> traced(assembly_, flow_, sensitivity_.passage(), system_->coefficients,
                                     system_by_.coefficients);
  const InstantDerivative<N, H> d = sensitivity_.passage().at(candidate.step, candidate.s, candidate.at);
  const std::size_t mode = steps_.steps()[candidate.step].mode;
  double by = traced.of(traces_[trace], candidate.at, d, mode);
  if (candidate.change >= 0) {
    by += candidate.slope * sensitivity_.passage().shift(static_cast<std::size_t>(candidate.change));
  }
  return by;
}

template <int N, int H>
double Gradient<N, H>::extreme(std::size_t i, Side side) {
  constexpr double kAgree = 1e-7;  // of derivatives that are one but for rounding
  double state_change = 0.0;       // of the orbit at the extremes, relative, a unit of the parameter
  const std::size_t trace = trace_index_[i];
  const Extremes& found = extremes_[trace];
  const double magnitude = found.magnitude(), tie = kTiedExtremes * magnitude;
  if (orbit_->half_period) side = Side::either;  // both sides are alike
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  for (const auto& candidate : candidates_[trace]) {
    const bool at_most = candidate.can_be_most &&
                         (side == Side::either ? candidate.value >= magnitude - tie
                                               : side == Side::most && candidate.value >= found.most - tie);
    const bool at_least =
        candidate.can_be_least &&
        (side == Side::either ? candidate.value <= tie - magnitude
                              : side == Side::least && candidate.value <= found.least + tie);
    if (!at_most && !at_least) continue;
    const double by = at_candidate(trace, candidate);
    const InstantDerivative<N, H> d = sensitivity_.passage().at(candidate.step, candidate.s, candidate.at);
    state_change = std::max(state_change, d.z.norm() / candidate.at.z.norm());
    if (at_most) {
      smallest = std::min(smallest, by);
      largest = std::max(largest, by);
    }
    if (at_least) {
      smallest = std::min(smallest, -by);
      largest = std::max(largest, -by);
    }
  }
  // Where the extreme itself is stationary in the parameter its derivative is rounding of the state's.
  const double size = std::max({std::abs(largest), std::abs(smallest), magnitude * state_change});
  if (largest - smallest > kAgree * size) return none(i, "two extremes tie: it has a kink here");
  return 0.5 * (largest + smallest);
}

// Of omega t where the largest value is first reached, omega h held.
template <int N, int H>
double Gradient<N, H>::peak_phase(std::size_t i) {
  const std::size_t trace = trace_index_[i];
  const double most = orbit_->half_period ? extremes_[trace].magnitude() : extremes_[trace].most;
  const Candidate<N, H>* peak = nullptr;
  for (const auto& candidate : candidates_[trace]) {
    const double value = orbit_->half_period ? std::abs(candidate.value) : candidate.value;
    if (!candidate.reached || value < most - kTiedExtremes * std::abs(most)) continue;
    if (peak != nullptr) return none(i, "two extremes tie: it has a jump here");
    peak = &candidate;
  }
  if (peak == nullptr) return none(i, "the largest value is held, never reached");
  if (!peak->stationary) {
    return flow_.fundamental_rate() * sensitivity_.passage().shift(static_cast<std::size_t>(peak->change));
  }
  // u'(t) = 0:  dt = -du' / u''
  const Eigen::Index mass = static_cast<Eigen::Index>(quantities_[i].index), n = flow_.equations().masses();
  const InstantDerivative<N, H> d = sensitivity_.passage().at(peak->step, peak->s, peak->at);
  return -flow_.fundamental_rate() * d.z[n + mass] / peak->at.a[mass];
}

}  // namespace frahm::periodic
