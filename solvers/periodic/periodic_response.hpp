#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/periodic/quantity.hpp"

namespace frahm::periodic {

enum class Status;
class ResponseSolver;

// What is told of every response, whatever quantities were asked for.
struct ResponseSummary {
  Status status;
  std::string reason;     // why it failed; empty otherwise
  double residual = 0.0;  // 1
  int newton_iterations = 0;
  int passages = 0;  // periods (or half periods) of the flow that the search took
};

// One stretch of the response in one mode, for telling an orbit in full.
struct Stretch {
  double start = 0.0, length = 0.0;   // omega t [rad], from 0 to 2 pi
  std::vector<std::string> contacts;  // per Coulomb element: "sticks", "slides +", "slides -"
};

// Sampled time history over one period, omega t from 0 to 2 pi inclusive. Rows are samples.
struct History {
  std::vector<double> time;        // [s]
  std::vector<std::string> names;  // "main_displacement", "main_velocity", ..., "guide_force"
  std::vector<std::string> units;
  std::vector<std::vector<double>> columns;
};

// Periodic responses of one network, one point of a map after the other. Not for use by two threads at once;
// each thread has its own.
//
//   PeriodicResponse response(network, quantities);
//   response.set_values(values);                  // matrices and forcing, e.g. at the first frequency of a
//   row response.solve();  response.quantities(out); response.set_forcing(values);                 // another
//   frequency, the element values unchanged response.solve();  response.quantities(out);  // starts from the
//   orbits before it
class PeriodicResponse {
 public:
  // Throws mechanics::MechanicsError for a network that cannot move.
  PeriodicResponse(const mechanics::Network& network, std::vector<Quantity> quantities);
  ~PeriodicResponse();
  PeriodicResponse(PeriodicResponse&&) noexcept;
  PeriodicResponse& operator=(PeriodicResponse&&) noexcept;

  // New element values: matrices, limits and forcing. Throws mechanics::MechanicsError, naming element, value
  // and rule, and leaves the response unset.
  void set_values(const mechanics::NetworkValues& values);
  // New frequency and excitation; masses and elements as in the last set_values.
  void set_forcing(const mechanics::NetworkValues& values);

  // Forgets all earlier orbits: the next search starts from the linear response.
  void forget();
  // Starts a new row of frequencies: the next search starts from the orbit that began the row before.
  void begin_row();

  // The periodic response at the values set. Never throws: every point ends in a status.
  const ResponseSummary& solve();

  // The quantities given to the constructor, in their order; NaN (counts -1, flags 0) where the response is
  // unbounded or failed. `out` has their number of places.
  void quantities(std::span<double> out);

  // Of a response that is ok or grazing.
  History history(std::size_t samples);
  std::vector<Stretch> stretches() const;

 private:
  std::unique_ptr<ResponseSolver> solver_;  // of the network's size
};

// Modes of a network with all friction sliding, or with every contact stuck.
struct LinearModes {
  std::vector<double> frequency;           // undamped, ascending [rad/s]
  std::vector<double> damping;             // ratio of each
  std::vector<std::vector<double>> shape;  // displacement of each mass, largest 1
};
LinearModes linear_modes(const mechanics::Network& network, const mechanics::NetworkValues& values,
                         bool all_stuck);

}  // namespace frahm::periodic
