#pragma once

#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/orbits/continuation.hpp"
#include "solvers/orbits/rest_position.hpp"
#include "solvers/quantities/gradient.hpp"
#include "solvers/quantities/observables.hpp"
#include "solvers/quantities/orbit_observation.hpp"
#include "solvers/response/response.hpp"

namespace frahm::periodic {

// N masses and H harmonics, or any number of either (Eigen::Dynamic).
template <int N, int H>
class SizedSolver final : public ResponseSolver {
 public:
  SizedSolver(const mechanics::Network& network, const std::vector<Quantity>& quantities)
      : assembly_(network),
        continuation_(flow_),
        observables_(assembly_, flow_, quantities),
        gradient_(assembly_, flow_, quantities),
        steps_(flow_) {}

  void set_values(const mechanics::NetworkValues& values) override {
    values_ = values;
    assembly_.set_values(values, system_);
    assembly_.set_forcing(values, system_);
    flow_.set_system(system_);
    flow_.set_forcing(system_);
    undamped_modes_ = undamped_modes(system_);
    observables_.set_system(system_);
  }

  void set_forcing(const mechanics::NetworkValues& values) override {
    if (assembly_.matrices_depend_on_frequency()) return set_values(values);
    values_ = values;
    assembly_.set_forcing(values, system_);
    flow_.set_forcing(system_);
  }

  void forget() override { continuation_.forget(); }
  void begin_row() override { continuation_.begin_row(); }
  const ResponseSummary& solve() override;

  void quantities(std::span<double> out) override {
    if (has_response())
      observables_.evaluate(orbit_, system_, out);
    else
      observables_.fill_missing(orbit_.status, out);
  }

  const char* gradient(std::span<const mechanics::NetworkValues> directions, std::span<double> out) override {
    return gradient_.evaluate(orbit_, system_, values_, directions, out);
  }
  const char* why_no_derivative(std::size_t quantity) const override { return gradient_.why_none(quantity); }

  const char* observe(std::span<const double> times, std::span<const Observed> observed,
                      std::span<const mechanics::NetworkValues> directions, ObservedMotion& out) override {
    OrbitObservation<N, H> observation(flow_, observed);
    return observation.observe(orbit_, assembly_, system_, values_, directions, times, out);
  }

  History history(std::span<const double> phases) override;
  std::vector<Stretch> stretches() const override;

 private:
  bool has_response() const { return orbit_.status == Status::ok || orbit_.status == Status::grazing; }

  void settle();
  ContactMask barely_sliding() const;

  mechanics::Assembly assembly_;
  mechanics::NetworkValues values_;  // of the system
  mechanics::LinearSystem system_;
  std::vector<UndampedMode> undamped_modes_;
  Flow<N, H> flow_;
  Continuation<N, H> continuation_;
  Observables<N, H> observables_;
  Gradient<N, H> gradient_;
  OrbitSteps<N, H> steps_;
  Integrals<N, H> integrals_;
  Orbit<N, H> orbit_;
  ResponseSummary summary_;
};

template <int N, int H>
const ResponseSummary& SizedSolver<N, H>::solve() {
  if (is_unbounded(system_, undamped_modes_)) {
    orbit_.status = Status::unbounded;
    orbit_.reason = "an undamped mode is driven at its resonance, and no friction holds it";
    orbit_.residual = std::numeric_limits<double>::quiet_NaN();
    orbit_.newton_iterations = orbit_.passages = 0;
    continuation_.forget();
  } else {
    continuation_.find(system_.omega, system_.odd_forcing, orbit_);
    if (!orbit_.half_period) settle();
    if (orbit_.half_period && has_response() && orbit_.stuck_throughout != 0)
      centre_rest_position(flow_, orbit_);
    if (has_response() && observables_.needs_stability()) judge_stability(flow_, orbit_);
  }
  summary_.status = orbit_.status;
  summary_.reason = orbit_.reason;
  summary_.residual = orbit_.residual;
  summary_.newton_iterations = orbit_.newton_iterations;
  summary_.passages = orbit_.passages;
  summary_.half_period = orbit_.half_period;
  return summary_;
}

// Contacts that slide for less than a hundredth of the passage, or of a search that failed, for less than
// half.
template <int N, int H>
ContactMask SizedSolver<N, H>::barely_sliding() const {
  const double share = has_response() ? 0.01 : 0.5;
  ContactMask result = 0;
  for (Eigen::Index j = 0; j < flow_.equations().contacts(); ++j) {
    double sliding = 0.0;
    for (const Segment<N, H>& segment : orbit_.passage.segments) {
      if (!contains(flow_.mode(segment.mode).stuck, j)) sliding += segment.length;
    }
    if (sliding < share * flow_.equations().period && flow_.equations().limit[j] > 0.0) result |= bit(j);
  }
  return result;
}

// Contacts that stick throughout rest where the energy is least. The search may end on the edge of the set of
// such orbits, where it takes ever smaller slips for the answer (the residual falls like slip^1.5): contacts
// that barely slide are held, and if their forces then keep within their limits that is the orbit, as there
// is only one.
template <int N, int H>
void SizedSolver<N, H>::settle() {
  const ContactMask held = barely_sliding();
  if (has_response() && held == orbit_.stuck_throughout) {
    if (held != 0) settle_rest_position(assembly_, flow_, steps_, integrals_, orbit_);
    return;
  }
  if (held == 0) return;
  Orbit<N, H> trial = orbit_;
  trial.z = flow_.brought_to_rest(trial.z, trial.section, held);
  flow_.hold_contacts(held);
  Shooting<N, H>(flow_).find(trial);
  flow_.hold_contacts(0);
  if (trial.status == Status::failed) return;
  if (settle_rest_position(assembly_, flow_, steps_, integrals_, trial)) orbit_ = trial;
}

template <int N, int H>
History SizedSolver<N, H>::history(std::span<const double> phases) {
  const auto& network = assembly_.network();
  History result = History::of(network);
  const Forms<N, H> forms(assembly_, flow_);
  const Eigen::Index n = flow_.equations().masses();
  const double step = flow_.equations().step, turn = 2.0 * std::numbers::pi;
  const double covered = orbit_.half_period ? 0.5 * turn : turn;
  for (const double phase : phases) {
    double from_section = std::fmod(phase, turn) - orbit_.section;
    double sign = 1.0;
    for (; from_section < 0.0; from_section += covered) sign *= orbit_.sign();
    for (; from_section >= covered; from_section -= covered) sign *= orbit_.sign();
    const double at = from_section / flow_.fundamental_rate();
    const auto& segments = orbit_.passage.segments;
    auto segment = segments.begin();
    while (segment + 1 != segments.end() && segment->start + segment->length <= at) ++segment;
    const Mode<N, H>& mode = flow_.mode(segment->mode);
    Instant<N, H> instant;
    flow_.instant_at(flow_.state_within(*segment, orbit_.section, at - segment->start),
                     orbit_.section + from_section, mode, instant);
    result.time.push_back(phase / system_.omega);
    std::size_t column = 0;
    for (Eigen::Index mass = 0; mass < n; ++mass) {
      result.columns[column++].push_back(sign * instant.z[mass]);
      result.columns[column++].push_back(sign * instant.z[n + mass] / step);
    }
    for (std::size_t e = 0; e < network.elements.size(); ++e) {
      result.columns[column++].push_back(
          sign * forms.element_force(e, system_.coefficients[e], mode).at(instant).value);
    }
    for (Eigen::Index mass = 0; mass < n; ++mass)
      result.columns[column++].push_back(sign * instant.a[mass] / (step * step));
  }
  return result;
}

template <int N, int H>
std::vector<Stretch> SizedSolver<N, H>::stretches() const {
  std::vector<Stretch> result;
  const double rate = flow_.fundamental_rate();
  for (int half = 0; half < (orbit_.half_period ? 2 : 1); ++half) {
    for (const Segment<N, H>& segment : orbit_.passage.segments) {
      const Mode<N, H>& mode = flow_.mode(segment.mode);
      Stretch stretch;
      stretch.start = whole_turns_removed(orbit_.section + segment.start * rate + half * std::numbers::pi);
      stretch.length = segment.length * rate;
      for (std::size_t e = 0; e < assembly_.network().elements.size(); ++e) {
        if (assembly_.network().elements[e].type != mechanics::ElementType::coulomb) continue;
        const mechanics::ContactShare& place = assembly_.shares()[e];
        const auto contact = static_cast<Eigen::Index>(place.contact);
        const double sign = (half == 0 ? 1.0 : -1.0) * place.orientation * mode.sign(contact);
        stretch.contacts.push_back(contains(mode.stuck, contact) ? "sticks"
                                   : sign > 0.0                  ? "slides +"
                                                                 : "slides -");
      }
      result.push_back(std::move(stretch));
    }
  }
  std::sort(result.begin(), result.end(),
            [](const Stretch& a, const Stretch& b) { return a.start < b.start; });
  return result;
}

extern template class SizedSolver<1, 1>;
extern template class SizedSolver<1, 2>;
extern template class SizedSolver<2, 1>;
extern template class SizedSolver<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
