#include "solvers/tuning/exchange/resonance_places.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "solvers/algebra/eigenvalues.hpp"
#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/exact/response.hpp"
#include "solvers/mechanics/linear_system.hpp"

namespace frahm::tuning {
namespace {

struct Pole {
  double omega_d = 0.0, decay = 0.0;  // [rad/s]
};

// Which contacts stick, as the columns of W.
std::vector<std::vector<Eigen::Index>> configurations(Eigen::Index contacts) {
  std::vector<Eigen::Index> all;
  for (Eigen::Index j = 0; j < contacts; ++j) all.push_back(j);
  std::vector<std::vector<Eigen::Index>> sets{{}};
  if (contacts == 0) return sets;
  sets.push_back(all);
  if (contacts == 1) return sets;
  for (Eigen::Index j = 0; j < contacts; ++j) {
    sets.push_back({j});
    if (contacts == 2) continue;
    std::vector<Eigen::Index> others = all;
    others.erase(others.begin() + j);
    sets.push_back(others);
  }
  return sets;
}

// Stiffness and damping with the bends of one side (+1, -1) passed.
struct Held {
  Eigen::MatrixXd K, C;
};
Held beyond(const mechanics::LinearSystem& system, double side) {
  Held held{system.K, system.C};
  for (Eigen::Index b = 0; b < system.bends.count(); ++b) {
    if (system.bends.side[static_cast<std::size_t>(b)] != side) continue;
    const Eigen::VectorXd w = system.bends.W.col(b);
    held.K += system.bends.stiffness[b] * w * w.transpose();
    held.C += system.bends.damping[b] * w * w.transpose();
  }
  return held;
}

// Poles of z' = A z, z = (eta, eta', s), q = B eta: the motions that the held contacts leave free. A slider
// in series with a spring has s' = k u' while it sticks, and s' = 0 while it slides.
void add_poles(const mechanics::LinearSystem& system, const Held& held_by,
               const std::vector<Eigen::Index>& stuck, std::vector<Pole>& poles) {
  const Eigen::Index m = system.internal_forces();
  std::vector<Eigen::Index> held;
  Eigen::VectorXd spring = system.internal_stiffness;
  for (Eigen::Index j = 0; j < system.contacts(); ++j) {
    const auto contact = static_cast<std::size_t>(j);
    const bool sticks = std::ranges::find(stuck, j) != stuck.end();
    if (!system.law[contact]->holds_velocity) {
      if (!sticks) spring[system.contact_internal[contact]] = 0.0;
    } else if (sticks) {
      held.push_back(j);
    }
  }
  const Eigen::MatrixXd B = algebra::null_space(system.W(Eigen::all, held).transpose());
  if (B.cols() == 0) return;
  const Eigen::Index k = B.cols();
  const Eigen::MatrixXd mass_inverse = algebra::inverse(B.transpose() * system.M * B);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * k + m, 2 * k + m);
  A.block(0, k, k, k).setIdentity();
  A.block(k, 0, k, k) = -mass_inverse * (B.transpose() * held_by.K * B);
  A.block(k, k, k, k) = -mass_inverse * (B.transpose() * held_by.C * B);
  A.block(k, 2 * k, k, m) = -mass_inverse * (B.transpose() * system.D);
  A.block(2 * k, k, m, k) = spring.asDiagonal() * (system.D.transpose() * B);
  A.block(2 * k, 2 * k, m, m).diagonal() = -system.internal_rate;
  const Eigen::VectorXcd eigenvalues = algebra::eigenvalues(A);
  for (const std::complex<double>& value : eigenvalues) {
    if (value.imag() > 0.0) poles.push_back({value.imag(), std::max(0.0, -value.real())});
  }
}

// In an order that is the same along the band: by configuration, then frequency.
std::vector<Pole> poles_of(const mechanics::LinearSystem& system) {
  std::vector<Pole> poles;
  std::vector<Held> springs{{system.K, system.C}};
  if (!system.monotone && system.bends.count() > 0)
    springs.insert(springs.end(), {beyond(system, 1.0), beyond(system, -1.0)});
  for (const Held& held_by : springs) {
    for (const auto& stuck : configurations(system.contacts())) {
      const auto first = static_cast<std::ptrdiff_t>(poles.size());
      add_poles(system, held_by, stuck, poles);
      std::sort(poles.begin() + first, poles.end(),
                [](const Pole& a, const Pole& b) { return a.omega_d < b.omega_d; });
    }
  }
  return poles;
}

// The poles and the frequency at a point of the band.
struct Station {
  double at = 0.0, omega = 0.0;
  std::vector<Pole> poles;
};

}  // namespace

std::vector<double> resonance_places(const mechanics::Network& network, const ValuesAt& values_at,
                                     const Band& band, const std::vector<double>& kinks,
                                     const PlacesFineness& fineness) {
  if (band.from == band.to) return {band.from};
  std::vector<double> places{band.from, band.to};
  for (const double kink : kinks) {
    if (kink > band.from && kink < band.to) places.push_back(kink);
  }
  const double spacing = (band.to - band.from) / fineness.intervals;
  for (int i = 1; i < fineness.intervals; ++i) places.push_back(band.from + i * spacing);
  std::sort(places.begin(), places.end());

  const mechanics::Assembly assembly(network, mechanics::FreeMasses::allowed);
  mechanics::LinearSystem system;
  mechanics::NetworkValues last;
  Station station;  // the last one's poles hold wherever the matrices are the same
  const auto station_at = [&](double at) {
    const mechanics::NetworkValues& values = values_at(at);
    station.at = at;
    station.omega = values.omega;
    const bool as_before = !last.mass.empty() && !assembly.matrices_depend_on_frequency() &&
                           periodic::have_same_elements(values, last);
    if (as_before) return station;
    last = values;
    station.poles.clear();
    try {
      assembly.set_values(values, system);
      station.poles = poles_of(system);
    } catch (const mechanics::MechanicsError&) {
      station.poles.clear();  // the response will report the reason
    }
    return station;
  };

  std::vector<double> close;
  const auto crowd = [&](double centre, double width) {
    const double least = fineness.nearest * spacing;
    close.push_back(centre);
    for (double away = std::max(0.5 * width, least); away < spacing; away *= 2.0) {
      close.push_back(centre - away);
      close.push_back(centre + away);
    }
  };
  Station left = station_at(places.front());
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Station right = station_at(places[i]);
    if (left.poles.size() == right.poles.size()) {
      for (std::size_t k = 0; k < left.poles.size(); ++k) {
        for (const int order : assembly.orders()) {
          // order omega = omega_d, by a straight line between the two stations
          const double a = order * left.omega - left.poles[k].omega_d;
          const double b = order * right.omega - right.poles[k].omega_d;
          const double h = right.at - left.at, gradient = (b - a) / h;
          const double width = std::max(left.poles[k].decay, right.poles[k].decay) / std::abs(gradient);
          const bool inside = (a <= 0.0) != (b <= 0.0);
          if (inside && gradient != 0.0) crowd(left.at - a / gradient, width);
        }
      }
    }
    left = right;
  }
  for (const double place : close) {
    if (place > band.from && place < band.to) places.push_back(place);
  }
  std::sort(places.begin(), places.end());
  const double least = 1e-10 * std::max(std::abs(band.from), std::abs(band.to));
  places.erase(std::unique(places.begin(), places.end(), [&](double a, double b) { return b - a <= least; }),
               places.end());
  places.back() = band.to;
  return places;
}

}  // namespace frahm::tuning
