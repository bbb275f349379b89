#pragma once

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"

// Periodic responses of one network with their quantities by name, for tests.
namespace frahm::periodic {

class Responses {
 public:
  explicit Responses(const mechanics::Network& network, const OrbitsWanted& wanted = {})
      : network_(network),
        quantities_(all_quantities(network)),
        response_(network, quantities_, Path::fastest, wanted),
        values_(quantities_.size(), std::numeric_limits<double>::quiet_NaN()) {}

  // From nothing known, unless `warm`.
  const ResponseSummary& solve(const mechanics::NetworkValues& values, bool warm = false) {
    if (!warm) response_.forget();
    response_.set_values(values);
    const ResponseSummary& summary = response_.solve();
    response_.quantities(values_);
    return summary;
  }

  // Another one of those that were found.
  void tell(int which) {
    response_.tell(which);
    response_.quantities(values_);
  }

  // Only the frequency has changed.
  const ResponseSummary& follow(const mechanics::NetworkValues& values) {
    response_.set_forcing(values);
    const ResponseSummary& summary = response_.solve();
    response_.quantities(values_);
    return summary;
  }

  double operator[](const std::string& name) const {
    const auto quantity = find_quantity(name, network_);
    if (!quantity) throw std::invalid_argument("no quantity " + name);
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      if (quantities_[i] == *quantity) return values_[i];
    }
    throw std::invalid_argument("quantity " + name + " was not asked for");
  }

  PeriodicResponse& response() { return response_; }
  const mechanics::Network& network() const { return network_; }

 private:
  mechanics::Network network_;
  std::vector<Quantity> quantities_;
  PeriodicResponse response_;
  std::vector<double> values_;
};

}  // namespace frahm::periodic
