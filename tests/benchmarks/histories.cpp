// Motions under earthquakes: the time of a history over a map of 20 records x 400 slip forces, beside what is
// used instead today, Boost.odeint's dopri5 at 1e-6 on the friction law smoothed to F (2/pi) arctan(1e5 v),
// on an even subset of the same pairs in the same run.
//
//   benchmark_histories [--smoke]
//
// The frame of ten storeys of studies/earthquakes/braced_frame_records.toml (1 Hz, friction dampers in four
// storeys, slip forces from 0 to 400 kN), at rest until 20 s of a synthetic earthquake with 50 samples a
// second. Its damping, 2 % of critical in the first mode, is by dampers in the storeys: the peer's right-hand
// side stays that of a chain.
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
constexpr double kMass = 2e4, kStiffness = 3.56e7,
                 kDuration = 20.0;         // of a floor [kg], of a storey [N/m]; [s]
constexpr double kMostSlipForce = 4e5;     // [N]
constexpr int kDesigns = 400, kBands = 8;  // slip forces; peers run amid each band
constexpr std::uint32_t kRecords = 20, kPeerRecords = 5;
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

namespace {

struct Cost {
  double own = 0.0, peer = 0.0;  // CPU seconds
  int histories = 0, peers = 0;
  double difference = 0.0;  // largest relative one of the sway

  double own_mean() const { return own / histories; }
  double peer_mean() const { return peer / peers; }
  void print(const std::string& slip_force) const {
    fmt::print("| {} | {:.2f} | {} | {:.0f} | {} | {:.0f} | {:.1e} |\n", slip_force, 1e3 * own_mean(),
               histories, 1e3 * peer_mean(), peers, peer_mean() / own_mean(), difference);
    std::fflush(stdout);
  }
};

double slip_force_of(int design) {
  return kMostSlipForce * design / (kDesigns - 1);
}

// One design in all records; the peer runs in every (kRecords/kPeerRecords)-th of them, where it runs.
void shake(int design, const std::vector<transient::Record>& records, bool beside_peer, Cost& cost) {
  const Frame frame = frame_of(slip_force_of(design));
  for (std::size_t number = 0; number < records.size(); ++number) {
    const double start = cpu_seconds();
    const double exact = exact_sway(frame, records[number]);
    const double solved = cpu_seconds();
    cost.own += solved - start;
    ++cost.histories;
    if (!beside_peer || number % (kRecords / kPeerRecords) != 0) continue;
    const double smoothed = smoothed_sway(frame, records[number]);
    cost.peer += cpu_seconds() - solved;
    ++cost.peers;
    cost.difference = std::max(cost.difference, std::abs(smoothed / exact - 1.0));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  constexpr int kInBand = kDesigns / kBands;
  std::vector<transient::Record> records;
  for (std::uint32_t number = 0; number < (smoke ? 1 : kRecords); ++number)
    records.push_back(record_of(number));
  fmt::print("{:%F}, g++ {}\n\n", fmt::gmtime(std::time(nullptr)), __VERSION__);
  fmt::print(
      "| slip force, kN | ms per history | histories | peer, ms | peer histories | speed-up of Frahm | "
      "largest difference of "
      "the sway |\n|---|---|---|---|---|---|---|\n");
  Cost all;
  for (int band = 0; band < (smoke ? 1 : kBands); ++band) {
    const int first = band * kInBand, middle = first + kInBand / 2, last = first + kInBand - 1;
    Cost cost;
    for (int design = smoke ? middle : first; design <= (smoke ? middle : last); ++design)
      shake(design, records, design == middle, cost);
    cost.print(fmt::format("{:.0f} to {:.0f}, peer {:.0f}", slip_force_of(first) / 1e3,
                           slip_force_of(last) / 1e3, slip_force_of(middle) / 1e3));
    all.own += cost.own;
    all.peer += cost.peer;
    all.histories += cost.histories;
    all.peers += cost.peers;
    all.difference = std::max(all.difference, cost.difference);
  }
  all.print("all");
}
