// Gradient: integrals over the orbit, and losses. Included by gradient.hpp.
namespace frahm::periodic {

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
    y_by.noalias() = sensitivity_.passage().polynomials(i).transpose() * at;
    for (int node = 0; node < kNodes; ++node) y_by.col(node) *= steps[i].length * kNodeWeight[node];
    gram_by_.topRows(eq.states()).noalias() += y_by * y.transpose();
  }
  gram_by_ = (gram_by_ + gram_by_.transpose()).eval() * ((orbit_->half_period ? 2.0 : 1.0) * eq.step);
  gram_by_ += by_.log_step * integrals_.gram();
}

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

// Below this part of what moves at its nodes, a component is rounding.
template <int N, int H>
bool Gradient<N, H>::has_component(std::size_t i, std::complex<double> component) const {
  constexpr double kRounding = 1e-12;
  const Trace& trace = traces_[trace_index_[i]];
  const double period = flow_.equations().period * flow_.equations().step;
  double moving = extremes_[trace_index_[i]].magnitude();
  for (Eigen::Index mass = 0; mass < trace.at.w.size(); ++mass) {
    moving = std::max(moving, std::abs(trace.at.w[mass]) * std::sqrt(integrals_.gram()(mass, mass) / period));
  }
  return std::abs(component) > kRounding * moving;
}

// The phase lag is -arg X:  d = -Im(conj(X) dX) / |X|^2
template <int N, int H>
double Gradient<N, H>::phase(std::size_t i, const mechanics::Incidence& at) {
  const auto [X, X_by] = reference_component(at);
  if (!has_component(i, X)) return none(i, "there is no component at the reference order");
  return -(std::conj(X) * X_by).imag() / std::norm(X);
}

template <int N, int H>
double Gradient<N, H>::harmonic_ratio(std::size_t i) {
  const Quantity& quantity = quantities_[i];
  const auto [X, X_by] = reference_component(mass_incidence(assembly_.network(), quantity.index));
  if (!has_component(i, X)) return none(i, "there is no component at the reference order");
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

// Integral of c v^2, of s^2 / c, and friction times the distance slid.
template <int N, int H>
typename Gradient<N, H>::Loss Gradient<N, H>::element_loss(std::size_t e) const {
  const mechanics::ElementCoefficients &law = system_->coefficients[e], &law_by = system_by_.coefficients[e];
  Loss loss;
  if (law.damping != 0.0 || law_by.damping != 0.0) {
    const Form v = forms_.velocity(assembly_.incidences()[e]);
    const Form v_by = velocity_derivative(assembly_.incidences()[e], v);
    const double square = integrals_.product(v, v);
    loss.value += law.damping * square;
    loss.by += law_by.damping * square + law.damping * (product(v, v_by, v) + integrals_.product(v, v_by));
  }
  if (law.internal >= 0) {
    const Eigen::Index place = 2 * flow_.equations().masses() + law.internal;
    const double value = integrals_.gram()(place, place) / law.internal_damping;
    loss.value += value;
    loss.by += (gram_by_(place, place) - value * law_by.internal_damping) / law.internal_damping;
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
    const auto& p = sensitivity_.passage().polynomials(i);
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
    if (k + 1 < segments.size()) stuck_by += sensitivity_.passage().shift(k);
    if (k > 0) stuck_by -= sensitivity_.passage().shift(k - 1);
  }
  return stuck_by / ((orbit_->half_period ? 0.5 : 1.0) * flow_.equations().period);
}

}  // namespace frahm::periodic
