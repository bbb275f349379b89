// Motions under earthquakes: the time of a history beside what is used instead today, Boost.odeint's dopri5
// at 1e-6 on the friction law smoothed to F (2/pi) arctan(1e5 v), on the same record in the same run.
//
//   benchmark_histories [--smoke]
//
// A frame of ten storeys (1 Hz, 2 % of critical in its first mode) with friction dampers in four of them, at
// rest until 20 s of a synthetic earthquake with 50 samples a second; slip forces as parts of the frame's
// weight.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/generated_records.hpp"

namespace {

using namespace frahm;
using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Node, mechanics::NodeKind;

constexpr int kStoreys = 10;
constexpr double kMass = 1e5, kStiffness = 42.0 * 42.0 * kMass, kDuration = 20.0;
constexpr double kDamping = 2.0 * 0.02 * kStiffness / (2.0 * std::numbers::pi);
bool has_damper(int storey) {
  return storey % 2 == 0 && storey < 8;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Frame {
  mechanics::Network network;
  mechanics::NetworkValues values;
  double slip_force = 0.0;  // [N]
};

Frame frame_of(double slip_force) {
  Frame frame{.network = {},
              .values = {.omega = 1.0, .mass = {}, .element = {}, .excitation = {{1.0, 0.0}}},
              .slip_force = slip_force};
  frame.network.prescribed = {"ground"};
  frame.network.excitations = {{ExcitationKind::recorded_motion, 0, 0}};
  const auto add = [&](ElementType type, int storey, double value) {
    const Node at{NodeKind::mass, static_cast<std::size_t>(storey)};
    const Node below = storey == 0 ? Node{NodeKind::prescribed, 0}
                                   : Node{NodeKind::mass, static_cast<std::size_t>(storey - 1)};
    frame.network.elements.push_back({fmt::format("e{}", frame.network.elements.size()), type, below, at});
    frame.values.element.push_back(value);
  };
  for (int storey = 0; storey < kStoreys; ++storey) {
    frame.network.masses.push_back(fmt::format("floor{}", storey + 1));
    frame.values.mass.push_back(kMass);
    add(ElementType::spring, storey, kStiffness);
    add(ElementType::damper, storey, kDamping);
    if (has_damper(storey)) add(ElementType::coulomb, storey, slip_force);
  }
  frame.network.signals = {
      {"sway", {{{NodeKind::mass, kStoreys - 1}, 1.0}, {{NodeKind::prescribed, 0}, -1.0}}}};
  return frame;
}

transient::Record record_of(std::uint32_t number) {
  const transient::RandomSampling sampling{.duration = kDuration, .rate = 50.0, .seed = 21, .stream = number};
  const transient::GroundNoise ground{.intensity = 0.01,
                                      .ground_frequency = 15.6,
                                      .ground_damping = 0.6,
                                      .corner_frequency = 1.5,
                                      .corner_damping = 0.6,
                                      .envelope = {transient::Envelope::Shape::jennings, 2.0, 12.0, 0.2}};
  return {.name = std::to_string(number),
          .of = transient::RecordOf::acceleration,
          .time = transient::sample_times(sampling),
          .values = transient::ground_acceleration(sampling, ground)};
}

double exact_sway(const Frame& frame, const transient::Record& record) {
  const std::vector<transient::MotionQuantity> sway{{transient::MotionMeasure::peak, kStoreys}};
  const transient::ForcedMotion motion = transient::forced_motion(
      frame.network, [&](double) { return frame.values; }, {},
      {.from = 1.0, .records = {{0, &record}}, .duration = kDuration, .quantities = sway});
  return motion.failure.empty() ? std::abs(motion.numbers[0]) : std::nan("");
}

// Displacements relative to the ground, then velocities.
double smoothed_sway(const Frame& frame, const transient::Record& record) {
  namespace odeint = boost::numeric::odeint;
  using State = std::array<double, 2 * kStoreys>;
  const double rate = 50.0, most = static_cast<double>(record.values.size()) - 1.0 - 1e-9;
  const auto motion = [&](const State& z, State& dz, double t) {
    const double at = std::min(t * rate, most);
    const auto i = static_cast<std::size_t>(at);
    const double ground = std::lerp(record.values[i], record.values[i + 1], at - static_cast<double>(i));
    std::array<double, kStoreys + 1> force{};  // of each storey on the floor below
    for (int s = 0; s < kStoreys; ++s) {
      const double u = z[s] - (s > 0 ? z[s - 1] : 0.0);
      const double v = z[kStoreys + s] - (s > 0 ? z[kStoreys + s - 1] : 0.0);
      force[s] = kStiffness * u + kDamping * v;
      if (has_damper(s)) force[s] += frame.slip_force * 2.0 / std::numbers::pi * std::atan(1e5 * v);
    }
    for (int s = 0; s < kStoreys; ++s) {
      dz[s] = z[kStoreys + s];
      dz[kStoreys + s] = (force[s + 1] - force[s]) / kMass - ground;
    }
  };
  State z{};
  double peak = 0.0;
  odeint::integrate_adaptive(
      odeint::make_controlled(1e-6 * 0.01, 1e-6, odeint::runge_kutta_dopri5<State>()), motion, z, 0.0,
      kDuration, 1e-3, [&](const State& now, double) { peak = std::max(peak, std::abs(now[kStoreys - 1])); });
  return peak;
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  const std::uint32_t records = smoke ? 1 : 20;
  const std::vector<double> parts = smoke ? std::vector{0.002} : std::vector{0.01, 0.02, 0.05, 0.1};
  constexpr double kWeight = kStoreys * kMass * 9.80665;
  fmt::print("{:%F}, g++ {}\n\n", fmt::gmtime(std::time(nullptr)), __VERSION__);
  fmt::print(
      "| slip force, of the weight | ms a history | peer, ms | Frahm is so many times as fast | largest "
      "difference of the sway |\n|---|---|---|---|---|\n");
  for (const double part : parts) {
    const Frame frame = frame_of(part * kWeight);
    double own = 0.0, peer = 0.0, difference = 0.0;
    for (std::uint32_t number = 0; number < records; ++number) {
      const transient::Record record = record_of(number);
      const double start = cpu_seconds();
      const double exact = exact_sway(frame, record);
      const double solved = cpu_seconds();
      const double smoothed = smoothed_sway(frame, record);
      own += solved - start;
      peer += cpu_seconds() - solved;
      difference = std::max(difference, std::abs(smoothed / exact - 1.0));
    }
    fmt::print("| {:g} % | {:.2f} | {:.0f} | {:.0f} | {:.1e} |\n", 100.0 * part, 1e3 * own / records,
               1e3 * peer / records, peer / own, difference);
  }
}
