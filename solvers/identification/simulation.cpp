#include "solvers/identification/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "solvers/mechanics/system_derivative.hpp"
#include "solvers/response/periodic_response.hpp"
#include "solvers/transient/motion_sensitivity.hpp"
#include "solvers/transient/record_course.hpp"

namespace frahm::identification {
namespace {

using mechanics::LinearSystem;
using mechanics::Network;
using mechanics::NetworkValues;
using transient::InitialState;
using transient::MotionSensitivity;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kUnlimited = kInfinity;

// Passages of a free motion are short, so that the limit of rest shrinks with the motion. Their length is no
// fraction of its half period, so that stops do not fall between two passages.
constexpr double kPassagePeriods = 0.37;

std::vector<periodic::Observed> observed_of(const TimeRecord& record) {
  std::vector<periodic::Observed> observed;
  for (const Channel& channel : record.channels)
    observed.push_back({static_cast<Eigen::Index>(channel.mass), static_cast<int>(channel.signal)});
  return observed;
}

// A free motion is one without harmonics: constant loads and belts act on.
bool is_constant(const mechanics::Excitation& excitation) {
  return excitation.order == 0 && !mechanics::is_recorded(excitation.kind);
}

Network without_harmonics(Network network) {
  std::erase_if(network.excitations, [](const auto& each) { return !is_constant(each); });
  network.reference_order = 1;
  return network;
}

NetworkValues without_harmonics(const std::vector<mechanics::Excitation>& excitations, NetworkValues values) {
  std::size_t constants = 0;
  for (std::size_t i = 0; i < excitations.size(); ++i) {
    if (is_constant(excitations[i])) values.excitation[constants++] = values.excitation[i];
  }
  values.excitation.resize(constants);
  return values;
}

double longest_period(const LinearSystem& system) {
  std::vector<double> frequency, damping;
  periodic::modes_of(system, frequency, damping);
  return kTurn / frequency.front();
}

}  // namespace

struct Simulation::Kind {
  Kind(const Network& network, const TimeRecord& of, transient::Watch watch_it)
      : excitations(network.excitations),
        free_assembly(without_harmonics(network)),
        record(of),
        observed(observed_of(of)),
        watch(std::move(watch_it)) {}
  virtual ~Kind() = default;
  virtual std::string run(const Model& model, std::span<const Model> by, std::span<const double> times,
                          periodic::ObservedMotion& out) = 0;

  // Hysteretic elements have no frequency of their own where nothing is harmonic.
  void need_hysteretic_omega(const Model& model) const {
    if (model.values.hysteretic_omega > 0.0 || !free_assembly.matrices_depend_on_frequency()) return;
    throw mechanics::MechanicsError("record '" + record.name +
                                    "': a hysteretic element needs its reference frequency: none is given");
  }

  // Without harmonics, at a frequency of no meaning.
  NetworkValues free_system(const Model& model, LinearSystem& system) const {
    NetworkValues values = without_harmonics(excitations, model.values);
    if (!(values.hysteretic_omega > 0.0)) values.hysteretic_omega = 1.0;
    values.omega = 1.0;
    free_assembly.set_values(values, system);
    values.omega = periodic::fastest_rate(system);
    free_assembly.set_forcing(values, system);
    return values;
  }

  std::vector<mechanics::Excitation> excitations;  // of the study
  mechanics::Assembly free_assembly;
  const TimeRecord& record;
  std::vector<periodic::Observed> observed;
  transient::Watch watch;
};

namespace {

std::vector<LinearSystem> derivatives(const mechanics::Assembly& assembly, const NetworkValues& values,
                                      std::span<const NetworkValues> directions, const LinearSystem& system) {
  std::vector<LinearSystem> by(directions.size());
  for (std::size_t d = 0; d < by.size(); ++d)
    mechanics::differentiate(assembly, values, directions[d], system, by[d]);
  return by;
}

std::vector<InitialState> initial_of(std::span<const Model> models) {
  std::vector<InitialState> initial;
  for (const Model& model : models) initial.push_back(model.initial);
  return initial;
}

// Takes over the state and samples of the motion.
std::string hand_over(const MotionSensitivity& motion, bool derivatives_wanted,
                      periodic::ObservedMotion& out) {
  if (motion.failure() != nullptr) return motion.failure();
  out = motion.motion();
  return derivatives_wanted ? motion.why_no_derivative() : "";
}

struct FreeMotion final : Simulation::Kind {
  using Kind::Kind;

  std::string run(const Model& model, std::span<const Model> by, std::span<const double> times,
                  periodic::ObservedMotion& out) override {
    need_hysteretic_omega(model);
    LinearSystem system;
    const NetworkValues values = free_system(model, system);
    std::vector<NetworkValues> directions;
    for (const Model& each : by) {
      directions.push_back(without_harmonics(excitations, each.values));
      directions.back().omega = 0.0;
    }
    MotionSensitivity motion(observed, {times.begin(), times.end()}, watch);
    motion.set_system(system, derivatives(free_assembly, values, directions, system));
    motion.start(model.initial, initial_of(by));
    const double passage = kPassagePeriods * longest_period(system);
    while (motion.time() < times.back() && !motion.is_at_rest()) {
      if (!motion.advance(std::min(motion.time() + passage, times.back()), 0.0, passage)) break;
    }
    if (motion.failure() == nullptr) motion.finish();
    return hand_over(motion, !by.empty(), out);
  }
};

struct ForcedMotion final : Simulation::Kind {
  ForcedMotion(const Network& network, const TimeRecord& of, transient::Watch watch_it)
      : Kind(network, of, std::move(watch_it)), assembly(network) {}

  std::string run(const Model& model, std::span<const Model> by, std::span<const double> times,
                  periodic::ObservedMotion& out) override {
    LinearSystem system;
    assembly.set_values(model.values, system);
    assembly.set_forcing(model.values, system);
    std::vector<NetworkValues> directions;
    for (const Model& each : by) directions.push_back(each.values);
    MotionSensitivity motion(observed, {times.begin(), times.end()}, watch);
    motion.set_system(system, derivatives(assembly, model.values, directions, system));
    motion.start(model.initial, initial_of(by));
    follow(model.values.omega, times.back(), motion);
    if (motion.failure() == nullptr) motion.finish();
    return hand_over(motion, !by.empty(), out);
  }

  // Passages of one period each, so that the phase stays exact in a long motion.
  static void follow(double omega, double end, MotionSensitivity& motion) {
    const double period = kTurn / omega;
    double next = std::floor(motion.time() / period) + 1.0, phase = omega * motion.time();
    while (motion.time() < end) {
      const double to = std::min(next * period, end);
      // A rounding error of a period is not a passage of its own.
      if (to - motion.time() > 1e-12 * period && !motion.advance(to, phase, kUnlimited)) return;
      if (to == end) return;
      next += 1.0;
      phase = 0.0;
    }
  }

  mechanics::Assembly assembly;
};

// The measured excitation of a record takes the place of the network's own.
struct Measured {
  explicit Measured(const mechanics::Network& of, const TimeRecord& record) : network(of) {
    network.excitations.clear();
    network.reference_order = 1;
    for (const MeasuredExcitation& measured : record.excitation) {
      const bool is_force = measured.kind == mechanics::ExcitationKind::force;
      courses.push_back({.name = record.name,
                         .of = is_force ? transient::RecordOf::force : transient::RecordOf::displacement,
                         .time = record.time,
                         .values = measured.values,
                         .interpolation = record.interpolation});
      network.excitations.push_back({.kind = is_force ? mechanics::ExcitationKind::recorded_force
                                                      : mechanics::ExcitationKind::recorded_motion,
                                     .node = measured.node,
                                     .order = 0});
    }
  }
  transient::RecordCourse course() const {
    std::vector<transient::RecordedExcitation> records;
    for (std::size_t i = 0; i < courses.size(); ++i) records.push_back({i, &courses[i]});
    return {network, records};
  }
  // Values of the model in the layout of that network; of a derivative, scale 0.
  NetworkValues values_of(const NetworkValues& model, double scale) const {
    NetworkValues values = model;
    values.excitation.assign(courses.size(), {scale, 0.0});
    return values;
  }

  Network network;
  std::vector<transient::Record> courses;
};

struct MeasuredMotion final : Simulation::Kind {
  MeasuredMotion(const Network& network, const TimeRecord& of, transient::Watch watch_it)
      : Kind(network, of, std::move(watch_it)),
        measured(network, of),
        course(measured.course()),
        assembly(measured.network) {}

  std::string run(const Model& model, std::span<const Model> by, std::span<const double> times,
                  periodic::ObservedMotion& out) override {
    need_hysteretic_omega(model);
    LinearSystem system;
    NetworkValues values = free_system(model, system);
    values = measured.values_of(values, 1.0);
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    course.tell(system);
    std::vector<NetworkValues> directions;
    for (const Model& each : by) {
      directions.push_back(measured.values_of(each.values, 0.0));
      directions.back().omega = 0.0;
    }
    MotionSensitivity motion(observed, {times.begin(), times.end()}, watch);
    motion.set_system(system, derivatives(assembly, values, directions, system));
    motion.start(model.initial, initial_of(by));
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      motion.set_recorded(course.numbers(i), 0.0, course.jumps_at(i));
      if (!motion.advance(times[i + 1], 0.0, kUnlimited)) break;
    }
    if (motion.failure() == nullptr) motion.finish();
    return hand_over(motion, !by.empty(), out);
  }

  Measured measured;
  transient::RecordCourse course;
  mechanics::Assembly assembly;
};

struct SteadyMotion final : Simulation::Kind {
  SteadyMotion(const Network& network, const TimeRecord& of, transient::Watch watch_it)
      : Kind(network, of, std::move(watch_it)), response(network, {}) {}

  std::string run(const Model& model, std::span<const Model> by, std::span<const double> times,
                  periodic::ObservedMotion& out) override {
    if (watch) watch();
    response.set_values(model.values);
    const periodic::ResponseSummary& summary = response.solve();
    if (!summary.reason.empty()) return summary.reason;
    std::vector<NetworkValues> directions;
    for (const Model& each : by) directions.push_back(each.values);
    return response.observe(times, observed, directions, out);
  }

  periodic::PeriodicResponse response;
};

std::unique_ptr<Simulation::Kind> make_kind(const Network& network, const TimeRecord& record,
                                            const transient::Watch& watch) {
  for (const mechanics::Element& element : network.elements) {
    if (mechanics::has_smooth_law(element))
      throw mechanics::MechanicsError("element '" + element.name +
                                      "' follows a smooth law: only exact laws can be fitted");
  }
  switch (record.motion) {
    case MotionKind::free:
      return std::make_unique<FreeMotion>(network, record, watch);
    case MotionKind::periodic:
      return std::make_unique<SteadyMotion>(network, record, watch);
    case MotionKind::forced:
      break;
  }
  if (!record.excitation.empty()) return std::make_unique<MeasuredMotion>(network, record, watch);
  return std::make_unique<ForcedMotion>(network, record, watch);
}

}  // namespace

Simulation::Simulation(const Network& network, const TimeRecord& record, const transient::Watch& watch)
    : kind_(make_kind(network, record, watch)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

std::string Simulation::run(const Model& model, std::span<const Model> by, std::size_t samples,
                            periodic::ObservedMotion& out) {
  return kind_->run(model, by, std::span(kind_->record.time).first(samples), out);
}

double Simulation::longest_period(const Model& model) const {
  LinearSystem system;
  kind_->free_system(model, system);
  return identification::longest_period(system);
}

}  // namespace frahm::identification
