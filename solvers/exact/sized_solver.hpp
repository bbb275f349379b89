#pragma once

#include <algorithm>
#include <complex>
#include <memory>
#include <numbers>

#include "solvers/algebra/eigenvalues.hpp"
#include "solvers/exact/coexistence.hpp"
#include "solvers/exact/nonstop_row.hpp"
#include "solvers/exact/orbit_search.hpp"
#include "solvers/exact/response.hpp"
#include "solvers/exact/slow_sweep.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/quantities/gradient.hpp"
#include "solvers/quantities/observables.hpp"
#include "solvers/quantities/orbit_observation.hpp"

namespace frahm::periodic {

// N masses and H harmonics, or any number of either (Eigen::Dynamic).
template <int N, int H>
class SizedSolver final : public ResponseSolver {
 public:
  SizedSolver(const mechanics::Network& network, const std::vector<Quantity>& quantities, Path path,
              const OrbitsWanted& wanted)
      : assembly_(network, mechanics::FreeMasses::allowed),
        wanted_(wanted),
        search_(assembly_, flow_),
        coexistence_(assembly_, flow_, wanted),
        slow_sweep_(assembly_, flow_, wanted.most_multiple),
        observables_(assembly_, flow_, quantities),
        gradient_(assembly_, flow_, quantities) {
    if (path == Path::fastest && nonstop::NonstopSolver::serves(assembly_))
      nonstop_ = std::make_unique<nonstop::NonstopSolver>(assembly_, quantities);
  }

  void solve_row(std::span<const mechanics::NetworkValues> points, std::span<ResponseSummary> found,
                 std::span<double> out) override {
    if (wanted_.is_slow_sweep()) return slow_sweep_row(points, found, out);
    if (nonstop_) nonstop::solve_row(*nonstop_, points, found, out);
    if (mechanics::may_have_several_responses(assembly_.network())) return search_row(points, found, out);
    solve_rest(points, found, out);
  }

  void set_values(const mechanics::NetworkValues& values) override {
    is_set_ = false;
    values_ = values;
    assembly_.set_values(values, system_);
    assembly_.set_forcing(values, system_);
    flow_.set_system(system_);
    flow_.set_forcing(system_);
    undamped_modes_ = undamped_modes(system_);
    observables_.set_system(system_);
    is_set_ = true;
  }

  void set_forcing(const mechanics::NetworkValues& values) override {
    if (assembly_.matrices_depend_on_frequency()) return set_values(values);
    values_ = values;
    assembly_.set_forcing(values, system_);
    flow_.set_forcing(system_);
  }

  void forget() override {
    search_.forget();
    begin_row();
  }
  void begin_row() override {
    search_.begin_row();
    slow_sweep_.begin();
    before_ = {};
  }
  const ResponseSummary& solve() override;
  void start_from(std::span<const KnownOrbit> known) override { before_ = stable_orbits<N, H>(known); }
  std::vector<KnownOrbit> known() const override { return known_orbits(before_); }
  void tell(int which) override;
  int multiple() const override { return orbit_.multiple; }
  std::vector<std::complex<double>> multipliers() override;

  void quantities(std::span<double> out) override {
    if (has_response() || tells_motion_)
      observables_.evaluate(orbit_, reported_system(), out);
    else
      observables_.fill_missing(orbit_.status, orbit_.unsettled, out);
  }

  const char* gradient(std::span<const mechanics::NetworkValues> directions, std::span<double> out) override {
    follow_tangent(flow_, orbit_);
    return gradient_.evaluate(orbit_, reported_system(), values_, directions, out);
  }
  const char* why_no_derivative(std::size_t quantity) const override { return gradient_.why_none(quantity); }

  const char* observe(std::span<const double> times, std::span<const Observed> observed,
                      std::span<const mechanics::NetworkValues> directions, ObservedMotion& out) override {
    follow_tangent(flow_, orbit_);
    OrbitObservation<N, H> observation(flow_, observed);
    return observation.observe(orbit_, assembly_, reported_system(), values_, directions, times, out);
  }

  History history(std::span<const double> phases, SliderForces sliders) override;
  std::vector<Stretch> stretches() const override;

 private:
  bool has_response() const { return orbit_.is_found(); }
  const mechanics::LinearSystem& reported_system() const { return orbit_.multiple > 1 ? longer_ : system_; }
  void weigh();
  void keep_balanced(StableOrbits<N, H>& found);
  const ResponseSummary& conclude();

  // Rows of systems that may have several responses (several_rows.hpp).
  std::string set(const mechanics::NetworkValues& values);
  void search_row(std::span<const mechanics::NetworkValues> points, std::span<ResponseSummary> found,
                  std::span<double> out);
  void slow_sweep_row(std::span<const mechanics::NetworkValues> points, std::span<ResponseSummary> found,
                      std::span<double> out);
  std::vector<std::size_t> in_order_of_slow_sweep(std::span<const mechanics::NetworkValues> points) const;
  void slow_sweep_on();
  bool goes_on(const mechanics::NetworkValues& from, const mechanics::NetworkValues& to, int halvings);

  mechanics::Assembly assembly_;
  mechanics::NetworkValues values_;          // of the system
  bool is_set_ = false;                      // to them
  mechanics::LinearSystem system_, longer_;  // longer: over the multiple of the period that the orbit takes
  std::vector<UndampedMode> undamped_modes_;
  Flow<N, H> flow_;
  OrbitsWanted wanted_;
  OrbitSearch<N, H> search_;
  Coexistence<N, H> coexistence_;
  StableOrbits<N, H> before_;  // of the point before
  SlowSweep<N, H> slow_sweep_;
  mechanics::NetworkValues swept_;  // where the sweep is
  Observables<N, H> observables_;
  Gradient<N, H> gradient_;
  Orbit<N, H> orbit_;
  bool tells_motion_ = false;  // one that did not settle, in place of an orbit
  ResponseSummary summary_;
  std::unique_ptr<nonstop::NonstopSolver> nonstop_;  // none where it does not serve, or is not wanted
};

template <int N, int H>
const ResponseSummary& SizedSolver<N, H>::solve() {
  const LimitedSearch limit(flow_.work());
  if (wanted_.is_slow_sweep()) {
    slow_sweep_on();
  } else if (OrbitSearch<N, H>::serves(assembly_, system_, undamped_modes_)) {
    search_.find(system_, undamped_modes_, observables_.needs_stability(), orbit_);
  } else {
    before_ = coexistence_.find(system_, &before_);
    keep_balanced(before_);
    coexistence_.tell(system_, before_, orbit_);
  }
  return conclude();
}

// For the orbit that was found.
template <int N, int H>
const ResponseSummary& SizedSolver<N, H>::conclude() {
  observables_.forget();
  tells_motion_ = false;
  if (orbit_.multiple > 1) longer_ = over_multiple(system_, orbit_.multiple);
  if (orbit_.is_found()) weigh();
  summary_.status = orbit_.status;
  summary_.reason = orbit_.reason;
  summary_.residual = orbit_.residual;
  summary_.newton_iterations = orbit_.newton_iterations;
  summary_.passages = orbit_.passages;
  summary_.half_period = orbit_.half_period;
  summary_.multiple = orbit_.multiple;
  summary_.coexisting = orbit_.coexisting;
  summary_.motions = orbit_.status == Status::not_periodic ? static_cast<int>(before_.unsettled.size()) : 0;
  return summary_;
}

template <int N, int H>
void SizedSolver<N, H>::tell(int which) {
  observables_.forget();
  flow_.set_forcing(system_);
  coexistence_.tell(system_, before_, static_cast<std::size_t>(which), orbit_);
  if (orbit_.multiple > 1) longer_ = over_multiple(system_, orbit_.multiple);
  tells_motion_ = orbit_.status == Status::not_periodic && orbit_.passage.failure == nullptr;
  if (orbit_.is_found()) weigh();
}

// Where an event only just happens they do not exist.
template <int N, int H>
std::vector<std::complex<double>> SizedSolver<N, H>::multipliers() {
  if (!has_response()) return {};
  if (orbit_.passage.margin < kGrazing && orbit_.passage.events > 0) return {};
  follow_tangent(flow_, orbit_);
  Eigen::VectorXcd values = algebra::eigenvalues(
      moving_part(flow_, orbit_.passage.tangent, orbit_.stuck_throughout, orbit_.closing));
  if (orbit_.half_period) values = values.array().square();
  std::ranges::sort(values, [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return {values.begin(), values.end()};
}

// Work in = energy lost holds for every periodic orbit, whatever is asked of it. One that breaks it is
// searched again, or refused.
template <int N, int H>
void SizedSolver<N, H>::weigh() {
  bool is_balanced = observables_.is_balanced(orbit_, reported_system());
  for (int way = 0; system_.monotone && !is_balanced && way < OrbitSearch<N, H>::kOtherWays; ++way) {
    if (search_.find_otherwise(way, system_, observables_.needs_stability(), orbit_))
      is_balanced = observables_.is_balanced(orbit_, system_);
  }
  if (is_balanced) return;
  orbit_.status = Status::failed;
  orbit_.reason = unbalanced(observables_.energy_balance());
  search_.forget();
}

// Of several orbits, those whose energies balance: at a peak of 1e9 one orbit may be found twice, once with
// energies that are rounding. Where none balances, the one to be reported tells so.
template <int N, int H>
void SizedSolver<N, H>::keep_balanced(StableOrbits<N, H>& found) {
  if (found.stable.size() < 2) return;
  std::vector<StableOrbit<N, H>> balanced;
  for (std::size_t i = 0; i < found.stable.size(); ++i) {
    observables_.forget();
    flow_.set_forcing(system_);
    coexistence_.tell(system_, found, i, orbit_);
    if (orbit_.multiple > 1) longer_ = over_multiple(system_, orbit_.multiple);
    if (orbit_.is_found() && observables_.is_balanced(orbit_, reported_system()))
      balanced.push_back(found.stable[i]);
  }
  flow_.set_forcing(system_);
  if (!balanced.empty()) found.stable = std::move(balanced);
}

template <int N, int H>
History SizedSolver<N, H>::history(std::span<const double> phases, SliderForces sliders) {
  const auto& network = assembly_.network();
  History result = History::of(network, sliders);
  const Forms<N, H> forms(assembly_, flow_);
  const std::vector<mechanics::Incidence> signals = mechanics::incidences_beyond_masses(network);
  const Eigen::Index n = flow_.equations().masses();
  const double step = flow_.equations().step;
  OrbitSteps<N, H> steps(flow_);
  if (orbit_.closing.is_modulo()) steps.lay_out(orbit_);
  const RidingFrame& frame = steps.frame();
  for (const double phase : phases) {
    const auto [from_section, sign] = place_on_orbit(phase, orbit_.section, orbit_.half_period);
    const double at = from_section / flow_.fundamental_rate();
    const auto& segments = orbit_.passage.segments;
    auto segment = segments.begin();
    while (segment + 1 != segments.end() && segment->start + segment->length <= at) ++segment;
    const Mode<N, H>& mode = flow_.mode(segment->mode);
    Instant<N, H> instant;
    flow_.instant_at(flow_.state_within(*segment, orbit_.section, at - segment->start),
                     orbit_.section + from_section, mode, instant);
    if (frame.moves())
      instant.z.head(n) +=
          frame.moved_on(at, sign * (phase / (2.0 * std::numbers::pi) - 0.5) * flow_.equations().period);
    result.time.push_back(phase / reported_system().omega);
    std::size_t column = 0;
    for (Eigen::Index mass = 0; mass < n; ++mass) {
      result.columns[column++].push_back(sign * instant.z[mass]);
      result.columns[column++].push_back(sign * instant.z[n + mass] / step);
    }
    for (std::size_t e = 0; e < network.elements.size(); ++e) {
      if (const std::size_t parts = network.elements[e].parts; parts > 0)
        result.columns[column++].push_back(sign *
                                           force_form(forms, e, parts, system_, mode).at(instant).value);
    }
    for (Eigen::Index mass = 0; mass < n; ++mass)
      result.columns[column++].push_back(sign * instant.a[mass] / (step * step));
    for (const mechanics::Incidence& signal : signals) {
      for (const LinearForm<N, H>& form :
           {forms.displacement(signal), forms.velocity(signal), forms.acceleration(signal, mode)})
        result.columns[column++].push_back(sign * form.at(instant).value);
    }
    for (std::size_t e = 0; sliders == SliderForces::each && e < network.elements.size(); ++e) {
      for (std::size_t i = 0; network.elements[e].parts > 1 && i < network.elements[e].parts; ++i)
        result.columns[column++].push_back(sign *
                                           force_form(forms, e + i, 1, system_, mode).at(instant).value);
    }
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
        if (!mechanics::has_own_contact(assembly_.network().elements[e])) continue;
        const mechanics::ContactShare& place = assembly_.shares()[e];
        const auto contact = static_cast<Eigen::Index>(place.contact);
        const double sign = (half == 0 ? 1.0 : -1.0) * place.orientation * mode.sign(contact);
        stretch.contacts.push_back(flow_.rests(mode, contact) ? "sticks"
                                   : sign > 0.0               ? "slides +"
                                                              : "slides -");
      }
      result.push_back(std::move(stretch));
    }
  }
  std::sort(result.begin(), result.end(),
            [](const Stretch& a, const Stretch& b) { return a.start < b.start; });
  return result;
}

}  // namespace frahm::periodic

#include "solvers/exact/several_rows.hpp"

namespace frahm::periodic {

extern template class SizedSolver<1, 1>;
extern template class SizedSolver<2, 1>;
extern template class SizedSolver<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
