#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <complex>
#include <string_view>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/map/way_of_slow_sweep.hpp"
#include "studies/provenance/assembly_stage.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t samples_in_period = 512;

// One listed point: its parameters, and the history of its orbit, empty if it has none.
struct KeptOrbit {
  std::vector<double> parameters;  // SI
  periodic::History history;
  std::vector<std::vector<double>> sliding;  // of each element with a contact in turn: displacement, velocity
};

// Displacement and velocity of the prescribed nodes at a time: y_0 + V t + Re sum_k Y_k e^{i order_k omega
// t}.
struct SupportMotion {
  Eigen::VectorXd displacement, velocity;  // [m], [m/s]

  SupportMotion(const mechanics::LinearSystem& system, double time)
      : displacement(system.constant_motion + time * system.belt_velocity), velocity(system.belt_velocity) {
    for (std::size_t k = 0; k < system.orders.size(); ++k) {
      const std::complex<double> i_rate(0.0, system.orders[k] * system.omega);
      const Eigen::VectorXcd motion =
          system.motion.col(static_cast<Eigen::Index>(k)) * std::exp(i_rate * time);
      displacement += motion.real();
      velocity += (i_rate * motion).real();
    }
  }
};

// Whether the motion across the element is recorded; the parts of one move as the first.
bool tells_sliding(const mechanics::Element& element) {
  return mechanics::has_contact(element) && element.parts > 0;
}

// Relative displacement u = w^T q + p^T y of each element with a contact and its velocity, at the instants of
// a history, whose first columns are q and q' of one mass after the other.
std::vector<std::vector<double>> sliding_motions(const mechanics::Network& network,
                                                 const mechanics::NetworkValues& values,
                                                 const periodic::History& history) {
  const mechanics::Assembly assembly(network, mechanics::FreeMasses::allowed);
  mechanics::LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  const auto contacts = std::ranges::count_if(network.elements, tells_sliding);
  std::vector<std::vector<double>> motions(2 * static_cast<std::size_t>(contacts));
  Eigen::VectorXd q(system.masses()), v(system.masses());
  for (std::size_t i = 0; i < history.time.size(); ++i) {
    for (Eigen::Index mass = 0; mass < q.size(); ++mass) {
      q[mass] = history.columns[static_cast<std::size_t>(2 * mass)][i];
      v[mass] = history.columns[static_cast<std::size_t>(2 * mass + 1)][i];
    }
    const SupportMotion support(system, history.time[i]);
    auto column = motions.begin();
    for (std::size_t e = 0; e < network.elements.size(); ++e) {
      if (!tells_sliding(network.elements[e])) continue;
      const mechanics::Incidence& incidence = assembly.incidences()[e];
      (column++)->push_back(incidence.w.dot(q) + incidence.p.dot(support.displacement));
      (column++)->push_back(incidence.w.dot(v) + incidence.p.dot(support.velocity));
    }
  }
  return motions;
}

KeptOrbit keep_orbit(const MapPlan& plan, const KeptPoint& point) {
  const Study& study = plan.study;
  KeptOrbit orbit{.parameters = study.parameters.nominal(), .history = {}, .sliding = {}};
  for (const Assignment& assignment : point.at) orbit.parameters[assignment.parameter] = assignment.value;
  mechanics::NetworkValues values;
  periodic::PeriodicResponse response(study.network, plan.quantities, periodic::Path::fastest,
                                      study.orbits_wanted());
  periodic::Status status = periodic::Status::not_computed;
  for (std::vector<double>& passed : way_of_slow_sweep(study, study.orbits_wanted(), orbit.parameters)) {
    evaluate(study.values, study.parameters, passed, values);
    try {
      response.set_values(values);
      status = response.solve().status;
    } catch (const mechanics::MechanicsError&) {
      status = periodic::Status::not_computed;  // the point fails as it would in the map
    }
  }
  if (periodic::has_response(status)) {
    orbit.history = response.history(periodic::phases_of_a_period(samples_in_period));
    orbit.sliding = sliding_motions(study.network, values, orbit.history);
  }
  return orbit;
}

// Names and units of the samples, which a point without an orbit does not provide.
std::vector<results::Variable> sample_variables(const Study& study) {
  std::vector<results::Variable> variables;
  const mechanics::Network& network = study.network;
  const auto add = [&](const Named& named, std::string_view unit) {
    variables.push_back(variable(named, study.dimensionless ? "1" : std::string(unit)));
  };
  add({"time", {}, {"omega t = 0, within the period"}}, "s");
  const auto add_of_coordinate = [&](const char* row, std::size_t i, const char* unit) {
    add({row, mechanics::coordinate_name(network, i)}, mechanics::coordinate_unit(network, i, unit));
  };
  for (std::size_t i = 0; i < network.masses.size(); ++i) {
    add_of_coordinate("*_displacement", i, "m");
    add_of_coordinate("*_velocity", i, "m s-1");
  }
  for (const auto& element : network.elements) {
    if (element.parts > 0) add({"*_force", element.name}, mechanics::unit_of_element(element, "N"));
  }
  for (std::size_t i = 0; i < network.masses.size(); ++i) add_of_coordinate("*_acceleration", i, "m s-2");
  for (std::size_t i = network.masses.size(); i < mechanics::coordinate_count(network); ++i) {
    add_of_coordinate("*_displacement", i, "m");
    add_of_coordinate("*_velocity", i, "m s-1");
    add_of_coordinate("*_acceleration", i, "m s-2");
  }
  for (const auto& element : network.elements) {
    if (!tells_sliding(element)) continue;
    add({"*_displacement", {element.name}, {"slider " + element.name}},
        mechanics::unit_of_element(element, "m"));
    add({"*_sliding_velocity", element.name}, mechanics::unit_of_element(element, "m s-1"));
  }
  return variables;
}

std::vector<std::vector<double>> samples_of(const KeptOrbit& orbit, std::size_t variables) {
  if (orbit.history.time.empty()) return std::vector<std::vector<double>>(variables);
  std::vector<std::vector<double>> samples{orbit.history.time};
  samples.insert(samples.end(), orbit.history.columns.begin(), orbit.history.columns.end());
  samples.insert(samples.end(), orbit.sliding.begin(), orbit.sliding.end());
  return samples;
}

}  // namespace

OrbitsCost cost_of_orbits(const MapPlan& plan) {
  using Clock = std::chrono::steady_clock;
  const auto& points = plan.study.map()->output.histories;
  if (points.empty()) return {};
  const Clock::time_point start = Clock::now();
  keep_orbit(plan, points[points.size() / 2]);
  const double number = static_cast<double>(points.size());
  const double values = static_cast<double>(samples_in_period * sample_variables(plan.study).size());
  return {.seconds = number * std::chrono::duration<double>(Clock::now() - start).count(),
          .bytes = number * values * sizeof(double)};
}

void write_orbits(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer) {
  const Study& study = plan.study;
  const auto& points = study.map()->output.histories;
  if (points.empty()) return;
  const results::RaggedLayout layout{.group = "orbits",
                                     .row = "orbit",
                                     .row_variables = row_variables(study),
                                     .sample = "sample",
                                     .sample_variables = sample_variables(study)};
  const std::size_t table = writer.create_ragged(layout);
  const auto append = [&](const KeptOrbit& orbit) {
    writer.append_ragged(table, row_values(study, orbit.parameters, 0),
                         samples_of(orbit, layout.sample_variables.size()));
  };
  const engine::PieceWork keep = [&](std::uint64_t number) {
    return [orbit = keep_orbit(plan, points[number]), &append] { append(orbit); };
  };
  carry_out({.name = "orbits",
             .pieces = points.size(),
             .points = points.size(),
             .points_of = [](std::uint64_t) { return 1; },
             .make_work = [&keep] { return keep; }},
            options);
}

}  // namespace frahm::studies
