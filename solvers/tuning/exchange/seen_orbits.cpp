#include "solvers/tuning/exchange/seen_orbits.hpp"

#include <algorithm>
#include <iterator>

namespace frahm::tuning {
namespace {

constexpr std::size_t kMostPlaces = 512;  // as dense as the points of a scan
constexpr int kNearest = 2;               // places on either side

}  // namespace

void SeenOrbits::keep(double band, std::vector<periodic::KnownOrbit> orbits) {
  if (orbits.empty()) return;
  places_[band] = {std::move(orbits), ++calls_};
  if (places_.size() <= kMostPlaces) return;
  places_.erase(std::ranges::min_element(places_, {}, [](const auto& place) { return place.second.age; }));
}

std::vector<periodic::KnownOrbit> SeenOrbits::near(double band) const {
  std::vector<periodic::KnownOrbit> orbits;
  const auto add = [&](const AtPlace& place) {
    orbits.insert(orbits.end(), place.orbits.begin(), place.orbits.end());
  };
  auto above = places_.lower_bound(band), below = above;
  for (int i = 0; i < kNearest && above != places_.end(); ++i) add((above++)->second);
  for (int i = 0; i < kNearest && below != places_.begin(); ++i) add((--below)->second);
  return orbits;
}

}  // namespace frahm::tuning
