#pragma once

#include <complex>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/orbits/known_orbit.hpp"
#include "solvers/quantities/observed_motion.hpp"

// A summary of a periodic response, and the interface of its solvers.
namespace frahm::periodic {

enum class Status;

// How a response was found: from the phases of its events, where nothing sticks, or one mass stops once in
// each half of the period or never moves (nonstop/); or by shooting on its flow.
enum class Way { shooting, event_phases };

// Which of them are tried. General: shooting alone.
enum class Path { fastest, general };

// Data of every response, independent of the quantities requested.
struct ResponseSummary {
  Status status{};
  Way way = Way::shooting;
  std::string reason;     // why it failed; empty otherwise
  double residual = 0.0;  // 1
  int newton_iterations = 0;
  int passages = 0;          // periods (or half periods) of the flow that the search took; 0 from phases
  int multiple = 1;          // of the excitation's period, that the response takes
  int coexisting = 1;        // stable responses that were found
  int motions = 0;           // of status not_periodic: those followed that did not settle
  bool half_period = false;  // the response repeats with the opposite sign: x(t + T/2) = -x(t), T the
                             // period of the orders divided by their common divisor
};

// One stretch of the response in one mode, for a full description of an orbit.
struct Stretch {
  double start = 0.0, length = 0.0;   // omega t [rad], from 0 to 2 pi
  std::vector<std::string> contacts;  // per element with a contact: "sticks", "slides +", "slides -"
};

// Of an iwan element, the sum of its sliders' forces alone, or each of them too: they are its state.
enum class SliderForces { summed, each };

// The response at chosen instants. Rows are samples.
struct History {
  std::vector<double> time;        // [s]
  std::vector<std::string> names;  // "main_displacement", "main_velocity", ..., "guide_force"
  std::vector<std::string> units;
  std::vector<std::vector<double>> columns;

  // Without samples: displacement and velocity of each mass, force of each element, acceleration of each
  // mass; displacement, velocity and acceleration of each signal; the force of each slider, if they are
  // wanted.
  static History of(const mechanics::Network& network, SliderForces sliders = SliderForces::summed) {
    History history;
    const auto add_column = [&](const std::string& name, std::string_view unit) {
      history.names.push_back(name);
      history.units.emplace_back(unit);
      history.columns.emplace_back();
    };
    const auto add_of_coordinate = [&](std::size_t i, const char* what, const char* unit) {
      add_column(mechanics::coordinate_name(network, i) + what, mechanics::coordinate_unit(network, i, unit));
    };
    for (std::size_t i = 0; i < network.masses.size(); ++i) {
      add_of_coordinate(i, "_displacement", "m");
      add_of_coordinate(i, "_velocity", "m s-1");
    }
    for (const auto& element : network.elements) {
      if (element.parts > 0) add_column(element.name + "_force", mechanics::unit_of_element(element, "N"));
    }
    for (std::size_t i = 0; i < network.masses.size(); ++i) add_of_coordinate(i, "_acceleration", "m s-2");
    for (std::size_t i = network.masses.size(); i < mechanics::coordinate_count(network); ++i) {
      add_of_coordinate(i, "_displacement", "m");
      add_of_coordinate(i, "_velocity", "m s-1");
      add_of_coordinate(i, "_acceleration", "m s-2");
    }
    for (const auto& element : network.elements) {
      for (std::size_t i = 1; sliders == SliderForces::each && element.parts > 1 && i <= element.parts; ++i)
        add_column(element.name + "_slider_" + std::to_string(i) + "_force",
                   mechanics::unit_of_element(element, "N"));
    }
    return history;
  }
};

// `samples` phases omega t at equal intervals over a period, both ends included [rad].
inline std::vector<double> phases_of_a_period(std::size_t samples) {
  std::vector<double> phases(samples, 0.0);
  for (std::size_t i = 1; i < samples; ++i)
    phases[i] = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(samples - 1);
  return phases;
}

// PeriodicResponse (solvers/response/) for one kind of network; its comments state the contract.
class ResponseSolver {
 public:
  virtual ~ResponseSolver() = default;
  virtual void set_values(const mechanics::NetworkValues& values) = 0;
  virtual void set_forcing(const mechanics::NetworkValues& values) = 0;
  virtual void forget() = 0;
  virtual void begin_row() = 0;
  virtual const ResponseSummary& solve() = 0;
  // For a system that may have several responses; another has nothing to report.
  virtual void start_from(std::span<const KnownOrbit>) {}
  virtual std::vector<KnownOrbit> known() const { return {}; }
  virtual void tell(int) {}
  virtual int multiple() const { return 1; }  // of the excitation's period, that what is reported takes
  virtual std::vector<std::complex<double>> multipliers() { return {}; }
  virtual void quantities(std::span<double> out) = 0;
  virtual const char* gradient(std::span<const mechanics::NetworkValues> directions,
                               std::span<double> out) = 0;
  virtual const char* why_no_derivative(std::size_t quantity) const = 0;
  virtual const char* observe(std::span<const double> times, std::span<const Observed> observed,
                              std::span<const mechanics::NetworkValues> directions, ObservedMotion& out) = 0;
  virtual History history(std::span<const double> phases, SliderForces sliders) = 0;
  virtual std::vector<Stretch> stretches() const = 0;

  virtual void solve_row(std::span<const mechanics::NetworkValues> points, std::span<ResponseSummary> found,
                         std::span<double> out) {
    solve_rest(points, found, out);
  }
  virtual void end_rows_when(const std::function<bool()>& stop_asked) { stop_asked_ = &stop_asked; }

 protected:
  // Those points of a row whose status is not_computed, one after the other.
  void solve_rest(std::span<const mechanics::NetworkValues> points, std::span<ResponseSummary> found,
                  std::span<double> out);

 private:
  void solve_along(std::span<const mechanics::NetworkValues> points, const std::vector<char>& reported,
                   const std::vector<char>& solved, std::span<ResponseSummary> found, std::span<double> out);
  const ResponseSummary& solve_next(const mechanics::NetworkValues& values);

  mechanics::NetworkValues last_;  // of solve_rest()
  bool has_last_ = false;
  ResponseSummary refused_;
  const std::function<bool()>* stop_asked_ = nullptr;
};

// Whether two points have the same masses and elements, and so the same matrices but for what depends on the
// frequency.
bool have_same_elements(const mechanics::NetworkValues& a, const mechanics::NetworkValues& b);

}  // namespace frahm::periodic
