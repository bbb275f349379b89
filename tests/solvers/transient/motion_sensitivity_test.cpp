#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "solvers/identification/simulation.hpp"
#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Exact derivatives of motions from initial values against differences of motions simulated anew.
namespace frahm::identification::motion_sensitivity_test {
namespace {

using namespace mechanics;

// Of exact derivatives and differences, relative to the largest of the trace.
constexpr double kDifference = 1e-6;
// A difference that knows itself no better than this, likewise, decides nothing: another sequence of events
// lies within all but the smallest steps. Such differences are counted, and so are samples so near an event
// that it lies on their other side within all but two steps, where accelerations jump.
constexpr double kUndecided = 2e-7;

// What values are off, relative to the largest: a motion by rounding, a periodic orbit by what Newton's last
// step leaves of the residual it stops at, 1e-13: less than half.
constexpr double kMotionNoise = 1e-15, kOrbitNoise = 5e-14;
// A trace below this [SI], where motions are of 1e-2 and more, is the rounding of zero.
constexpr double kRoundingOfZero = 1e-12;

// Steps of differences, relative to the parameter.
constexpr std::array<double, 7> kSteps = {2e-3, 5e-4, 1.25e-4, 3e-5, 8e-6, 2e-6, 5e-7};

struct Case {
  Network network;
  Model model;
  TimeRecord record;
};

struct MotionParameter {
  std::string name;
  double size;      // of its steps
  Model direction;  // derivative of the model
  std::function<Model(double)> shifted;
};

struct Tally {
  int compared = 0, at_event = 0, undecided = 0, without_derivative = 0;
  int stops = 0, reversals = 0, ended_at_rest = 0;  // as the samples show them
  double worst = 0.0;
};

Model zero_like(const Model& model) {
  const std::vector<double> none(model.values.mass.size(), 0.0);
  return {periodic::zero_direction(model.values), {none, none}};
}

std::vector<MotionParameter> parameters_of(const Case& of) {
  std::vector<MotionParameter> list;
  for (const auto& named : periodic::all_parameters(of.network, of.model.values)) {
    const bool excites = named.name == "omega" || named.name.rfind("excitation", 0) == 0;
    if (excites && of.record.motion == MotionKind::free) continue;
    Model direction = zero_like(of.model);
    direction.values = named.parameter.direction;
    const auto shifted = [model = of.model, parameter = named.parameter](double by) {
      return Model{parameter.values_at(parameter.value + by), model.initial};
    };
    list.push_back({named.name, std::abs(named.parameter.value), direction, shifted});
  }
  if (of.record.motion == MotionKind::periodic) return list;
  for (std::size_t i = 0; i < of.network.masses.size(); ++i) {
    for (const bool velocity : {false, true}) {
      const auto place = [i, velocity](Model& m) -> double& {
        return velocity ? m.initial.velocity[i] : m.initial.displacement[i];
      };
      Model direction = zero_like(of.model);
      place(direction) = 1.0;
      const auto shifted = [model = of.model, place](double by) {
        Model moved = model;
        place(moved) += by;
        return moved;
      };
      list.push_back({velocity ? "initial velocity" : "initial displacement", 1.0, direction, shifted});
    }
  }
  return list;
}

// Of each friction element at each time: slides forward (1), back (-1), sticks (0).
Eigen::MatrixXi contact_states(const Case& of, const Model& model, const Eigen::MatrixXd& values) {
  std::vector<Eigen::Index> velocity;
  for (std::size_t c = 0; c < of.record.channels.size(); ++c) {
    if (of.record.channels[c].signal == Signal::velocity) velocity.push_back(static_cast<Eigen::Index>(c));
  }
  Eigen::MatrixXi states(values.rows(), static_cast<Eigen::Index>(of.network.elements.size()));
  states.setZero();
  for (Eigen::Index k = 0; k < values.rows(); ++k) {
    double support = 0.0;
    for (std::size_t e = 0; e < of.network.excitations.size(); ++e) {
      const auto& excitation = of.network.excitations[e];
      if (excitation.kind != mechanics::ExcitationKind::motion || of.record.motion == MotionKind::free)
        continue;
      const double rate = excitation.order * model.values.omega;
      support -=
          rate * model.values.excitation[e].amplitude *
          std::sin(rate * of.record.time[static_cast<std::size_t>(k)] + model.values.excitation[e].phase);
    }
    const auto velocity_of = [&](const mechanics::Node& node) {
      if (node.kind == mechanics::NodeKind::mass) return values(k, velocity[node.index]);
      return node.kind == mechanics::NodeKind::prescribed ? support : 0.0;
    };
    for (std::size_t e = 0; e < of.network.elements.size(); ++e) {
      const auto& element = of.network.elements[e];
      if (element.type != ElementType::coulomb) continue;
      double v = 0.0;
      for (const auto& [node, factor] : element.along) v += factor * velocity_of(node);
      constexpr double kSticks = 1e-12;  // [m/s], of motions of 1
      states(k, static_cast<Eigen::Index>(e)) = v > kSticks ? 1 : v < -kSticks ? -1 : 0;
    }
  }
  return states;
}

void count_events(const Eigen::MatrixXi& states, Tally& tally) {
  for (Eigen::Index e = 0; e < states.cols(); ++e) {
    for (Eigen::Index k = 1; k < states.rows(); ++k) {
      if (states(k, e) == 0 && states(k - 1, e) != 0) ++tally.stops;
      if (states(k, e) * states(k - 1, e) < 0) ++tally.reversals;
    }
  }
}

struct Difference {
  double step;
  Eigen::MatrixXd quotient;
  Eigen::Array<bool, Eigen::Dynamic, 1> same_states;  // at each time, as without a step
};

std::vector<Difference> differences(const Case& of, Simulation& simulation, const MotionParameter& parameter,
                                    const Eigen::MatrixXi& states) {
  std::vector<Difference> list;
  for (const double relative : kSteps) {
    const double step = relative * parameter.size;
    std::array<periodic::ObservedMotion, 2> sides;
    std::array<Eigen::MatrixXi, 2> side_states;
    bool both = true;
    for (const int side : {0, 1}) {
      const auto i = static_cast<std::size_t>(side);
      const Model model = parameter.shifted(side == 0 ? -step : step);
      both = both && simulation.run(model, {}, of.record.time.size(), sides[i]).empty();
      if (both) side_states[i] = contact_states(of, model, sides[i].values);
    }
    if (!both) continue;
    Difference difference{step, (sides[1].values - sides[0].values) / (2.0 * step), {}};
    difference.same_states.resize(states.rows());
    for (Eigen::Index k = 0; k < states.rows(); ++k)
      difference.same_states[k] =
          side_states[0].row(k) == states.row(k) && side_states[1].row(k) == states.row(k);
    list.push_back(std::move(difference));
  }
  return list;
}

struct Extrapolated {
  double value = 0.0, uncertainty = std::numeric_limits<double>::infinity();
  int steps = 0;
};

// To no step at all (C. Ridders, Adv. Eng. Software 4 (1982) 75). noise: of a value.
Extrapolated extrapolate(const std::vector<Difference>& list, Eigen::Index row, Eigen::Index column,
                         double noise) {
  Extrapolated best;
  std::vector<double> before, steps;
  for (const Difference& difference : list) {
    if (!difference.same_states[row]) continue;
    std::vector<double> now = {difference.quotient(row, column)};
    steps.push_back(difference.step);
    for (std::size_t i = 1; i <= before.size(); ++i) {
      const double ratio = steps[steps.size() - 1 - i] / difference.step, factor = ratio * ratio;
      now.push_back((factor * now[i - 1] - before[i - 1]) / (factor - 1.0));
      const double apart =
          noise / difference.step + std::max(std::abs(now[i] - now[i - 1]), std::abs(now[i] - before[i - 1]));
      if (apart < best.uncertainty) best = {now[i], apart, 0};
    }
    before = std::move(now);
  }
  best.steps = static_cast<int>(steps.size());
  return best;
}

void compare(const Case& of, Tally& tally) {
  Simulation simulation(of.network, of.record, {});
  const std::vector<MotionParameter> parameters = parameters_of(of);
  std::vector<Model> directions;
  for (const MotionParameter& parameter : parameters) directions.push_back(parameter.direction);
  periodic::ObservedMotion exact;
  const std::string reason = simulation.run(of.model, directions, of.record.time.size(), exact);
  if (!reason.empty()) {
    ++tally.without_derivative;
    return;
  }
  const Eigen::MatrixXi states = contact_states(of, of.model, exact.values);
  count_events(states, tally);
  if (exact.values.bottomRows(1).cwiseAbs().rightCols(2).isZero(0.0)) ++tally.ended_at_rest;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const std::vector<Difference> list = differences(of, simulation, parameters[p], states);
    for (Eigen::Index c = 0; c < exact.values.cols(); ++c) {
      const double largest = exact.values.col(c).cwiseAbs().maxCoeff();
      if (largest < kRoundingOfZero) continue;
      const double size =
          std::max(exact.by[p].col(c).cwiseAbs().maxCoeff(), 1e-3 * largest / parameters[p].size);
      const double noise = largest * (of.record.motion == MotionKind::periodic ? kOrbitNoise : kMotionNoise);
      for (Eigen::Index k = 0; k < exact.values.rows(); ++k) {
        const Extrapolated by = extrapolate(list, k, c, noise);
        if (by.steps < 3) {
          ++tally.at_event;
          continue;
        }
        const bool decides = by.uncertainty <= kUndecided * size;
        ++(decides ? tally.compared : tally.undecided);
        const double apart = std::abs(exact.by[p](k, c) - by.value);
        if (decides) tally.worst = std::max(tally.worst, apart / size);
        const double allowed = decides ? kDifference * size : 10.0 * by.uncertainty;
        if (!(apart > allowed)) continue;
        INFO(parameters[p].name << ", channel " << c << ", time "
                                << of.record.time[static_cast<std::size_t>(k)]);
        INFO("exact " << exact.by[p](k, c) << ", difference " << by.value << " +- " << by.uncertainty
                      << ", largest " << size);
        CHECK(apart <= allowed);
      }
    }
  }
}

// Displacement, velocity and acceleration of each mass.
std::vector<Channel> all_channels(const Network& network) {
  std::vector<Channel> channels;
  for (std::size_t mass = 0; mass < network.masses.size(); ++mass) {
    for (const Signal signal : {Signal::displacement, Signal::velocity, Signal::acceleration})
      channels.push_back({network.masses[mass], mass, signal, {}});
  }
  return channels;
}

Case random_case(int number, std::mt19937& random) {
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  const bool forced = number % 2 == 1;
  periodic::RandomNetworkOptions options;
  options.masses = 1 + number % 3;
  options.contacts = 1 + number / 3 % 2;
  options.maxwell_elements = number % 5 == 0 ? 1 : 0;
  options.hysteretic = number % 7 == 0;
  options.shaken = number % 4 > 1;
  options.largest_friction = 0.6;
  if (number % 8 == 1) options.orders = {0, 1, 3};
  auto [network, values] = periodic::random_network(options, random);
  if (!forced || number % 3 == 0) values.hysteretic_omega = 1.3;
  Case result{network, {values, {}}, {}};
  for (int i = 0; i < options.masses; ++i) {
    result.model.initial.displacement.push_back(uniform(-2.0, 2.0));
    result.model.initial.velocity.push_back(uniform(-1.0, 1.0));
  }
  result.record.motion = forced ? MotionKind::forced : MotionKind::free;
  // At irregular times, forced motions not from the phase 0 on.
  double t = forced ? uniform(0.0, 3.0) : 0.0;
  const double longest = uniform(0.1, 0.5);
  for (int k = 0; k < 80; ++k) {
    result.record.time.push_back(t);
    t += uniform(0.2, 1.0) * longest;
  }
  result.record.channels = all_channels(network);
  return result;
}

TEST_CASE("Derivatives of 120 random motions are those of differences, through every event and up to rest",
          "[slow]") {
  std::mt19937 random(20261122);
  Tally tally;
  for (int number = 0; number < 120; ++number) {
    INFO("case " << number);
    compare(random_case(number, random), tally);
  }
  INFO(tally.compared << " compared, worst " << tally.worst << ", " << tally.at_event << " at events, "
                      << tally.undecided << " undecided");
  CHECK(tally.stops > 100);
  CHECK(tally.reversals > 500);
  CHECK(tally.ended_at_rest > 20);
  CHECK(tally.without_derivative == 0);
  CHECK(tally.at_event < tally.compared / 1000);
  CHECK(tally.undecided < tally.compared / 1000);
}

// Damped stops on both sides of the first mass, a damper with a table, and friction that sticks harder than
// it slides.
void bend(Case& of) {
  Network& network = of.network;
  NetworkValues& values = of.model.values;
  const mechanics::Node ground{}, first{mechanics::NodeKind::mass, 0};
  network.elements.emplace_back("stops", ElementType::gap, ground, first);
  network.elements.back().bends = {{+1.0, &laws::elastic_stop}, {-1.0, &laws::elastic_stop}};
  network.elements.emplace_back("valve", ElementType::damper, ground, first);
  network.elements.back().bends = {{+1.0, &laws::damper_bend}};
  values.element.insert(values.element.end(), {5.0, 0.02});
  values.second.resize(values.element.size());
  values.bends.assign(values.element.size(), {});
  values.bends[values.bends.size() - 2] = {{0.3, 5.0, 0.2}, {0.4, 3.0, 0.0}};
  values.bends.back() = {{0.2, 0.0, 0.1}};
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (network.elements[e].type != ElementType::coulomb) continue;
    network.elements[e].has_static_force = true;
    values.second[e] = 1.4 * values.element[e];
  }
}

TEST_CASE("So are those of motions against stops, with a damper's table and a static limit", "[slow]") {
  std::mt19937 random(20261123);
  Tally tally;
  for (int number = 0; number < 24; ++number) {
    INFO("case " << number);
    Case of = random_case(number, random);
    bend(of);
    compare(of, tally);
  }
  INFO(tally.compared << " compared, worst " << tally.worst << ", " << tally.at_event << " at events, "
                      << tally.undecided << " undecided, " << tally.without_derivative << " without");
  CHECK(tally.compared > 10000);
  CHECK(tally.stops > 10);
  CHECK(tally.without_derivative == 0);
  CHECK(tally.at_event < tally.compared / 200);
  CHECK(tally.undecided < tally.compared / 100);
}

TEST_CASE("Derivatives of steady responses at any time are those of differences, by the frequency too") {
  std::mt19937 random(20261125);
  Tally tally;
  for (int number = 0; number < 40; ++number) {
    INFO("case " << number);
    Case of = random_case(2 * number + 1, random);
    of.record.motion = MotionKind::periodic;
    compare(of, tally);
  }
  INFO(tally.compared << " compared, worst " << tally.worst << ", " << tally.at_event << " at events, "
                      << tally.undecided << " undecided, " << tally.without_derivative << " without");
  CHECK(tally.without_derivative <= 2);
  CHECK(tally.at_event < tally.compared / 1000);
  CHECK(tally.undecided < tally.compared / 100);
}

TEST_CASE("So are those of a response of two periods against a damped stop") {
  const mechanics::Node ground{}, first{mechanics::NodeKind::mass, 0};
  Case of;
  of.network.masses = {"mass"};
  of.network.elements = {{"spring", ElementType::spring, ground, first},
                         {"damper", ElementType::damper, ground, first},
                         {"stop", ElementType::gap, ground, first}};
  of.network.elements[2].bends = {{+1.0, &laws::elastic_stop}};
  of.network.excitations = {{mechanics::ExcitationKind::force, 0, 1},
                            {mechanics::ExcitationKind::force, 0, 0}};
  of.model.values = {.omega = 2.6,
                     .mass = {1.0},
                     .element = {1.0, 0.06, 3.0},
                     .excitation = {{1.0, 0.0}, {0.3, 0.0}},
                     .second = {0.0, 0.0, 0.1},
                     .bends = {{}, {}, {{0.2, 3.0, 0.1}}}};
  of.record.motion = MotionKind::periodic;
  for (int k = 0; k < 40; ++k) of.record.time.push_back(0.2 * k);
  of.record.channels = all_channels(of.network);
  Tally tally;
  compare(of, tally);
  INFO(tally.compared << " compared, worst " << tally.worst << ", " << tally.undecided << " undecided");
  CHECK(tally.without_derivative == 0);
  CHECK(tally.compared > 1000);
  CHECK(tally.undecided < tally.compared / 50);
}

}  // namespace
}  // namespace frahm::identification::motion_sensitivity_test
