#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "solvers/exact/response.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/quantities/quantity.hpp"

namespace frahm::periodic {

// Periodic responses of one network, one point of a map after the other. Not for use by two threads at once;
// each thread has its own. A network whose laws are linear piece by piece is solved exactly
// (exact/exact_solver.hpp), one with smooth laws by integration of its equation (smooth/); one with both is
// refused. Orders with a common divisor are divided by it first (response/common_divisor.hpp).
//
//   PeriodicResponse response(network, quantities);
//   response.solve_row(points, found, out);  // many points at once, and the fastest way
//
//   response.set_values(values);   response.solve();  response.quantities(out);  // one point by shooting
//   response.set_forcing(values);  response.solve();  response.quantities(out);  // next: from known orbits
class PeriodicResponse {
 public:
  // wanted: of a system that may have several responses.
  // Throws mechanics::MechanicsError for a network that cannot move, or that mixes friction laws.
  PeriodicResponse(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                   Path path = Path::fastest, const OrbitsWanted& wanted = {});
  ~PeriodicResponse();
  PeriodicResponse(PeriodicResponse&&) noexcept;
  PeriodicResponse& operator=(PeriodicResponse&&) noexcept;

  // Solves the points of a row, most often along the frequency. Where the masses and elements are the same at
  // all of them, but for friction limits, orbits on which nothing sticks (or one mass stops once in each half
  // of the period) are found from the phases of their events, with no use of other points; the others by
  // shooting, each from those before it. found: of each point; status not_computed, with the reason, where
  // its values cannot be set, and failed where the search failed.  out: points x quantities, as quantities()
  // gives them.  Never throws.
  void solve_row(std::span<const mechanics::NetworkValues> points, std::span<ResponseSummary> found,
                 std::span<double> out);
  // From now on a row whose points are solved one after the other ends once this is true, its other points
  // not computed. stop_asked: called before each point; must outlive the response.
  void end_rows_when(const std::function<bool()>& stop_asked);

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

  // For a system that may have several responses. start_from: where the next solve() looks first, next to its
  // own starts. known: the stable responses that the last one found, for a point near it.
  void start_from(std::span<const KnownOrbit> known);
  std::vector<KnownOrbit> known() const;
  // Makes another one that solve() found the response of quantities(), gradient() and history(): one of
  // summary.coexisting (0 <= which < their number), in no particular order. Where no stable one was found
  // (not_periodic), one of summary.motions that did not settle, over 64 periods of the excitation: it has
  // quantities, but no gradient.
  void tell(int which);

  // The Floquet multipliers of the response that is reported, over its own period, the largest first; those
  // of the rest positions of contacts that never slide are 0. None where it has none (grazing), or no
  // response.
  std::vector<std::complex<double>> multipliers();

  // The quantities given to the constructor, in their order; NaN (counts -1, flags 0) where the response is
  // unbounded or failed. `out` has one entry for each.
  void quantities(std::span<double> out);

  // The exact derivatives of the quantities along changes of the network's values, at the response last
  // solved; through every event of the orbit, not by differences.
  // directions[d]: the derivative of the values (layout of NetworkValues, .omega and .hysteretic_omega
  // included) by parameter d.  out: directions x quantities, row d from out[d * quantities]; in the unit of
  // the quantity per that of the parameter, NaN where a quantity has no derivative.
  // Returns "", or why the response has no derivatives, and then every entry of `out` is NaN: it is grazing
  // (an event only just happens, and the derivative differs on both sides), unbounded or failed, of a
  // smooth law, or several contacts come to rest, or let go of static limits or hit damped stops, at one
  // instant. Of several responses they are those of the one that is reported.
  std::string gradient(std::span<const mechanics::NetworkValues> directions, std::span<double> out);
  // Why a quantity of the last gradient() has none; "" where it has.
  std::string why_no_derivative(std::size_t quantity) const;

  // What sensors show of a response that is ok, several or grazing.
  // times: [s], at any of which the excitation's phase is omega t.  directions: as of gradient(); may be
  // none. Returns "", or why there are no derivatives (as gradient() says); `out` then has the values alone.
  // For a smooth law there are neither.
  std::string observe(std::span<const double> times, std::span<const Observed> observed,
                      std::span<const mechanics::NetworkValues> directions, ObservedMotion& out);

  // For a response that is ok, several or grazing, at these phases omega t [rad]; where something jumps, what
  // it jumps to.
  History history(std::span<const double> phases, SliderForces sliders = SliderForces::summed);
  std::vector<Stretch> stretches() const;

 private:
  std::unique_ptr<ResponseSolver> solver_;  // of the network's law and size
};

}  // namespace frahm::periodic
