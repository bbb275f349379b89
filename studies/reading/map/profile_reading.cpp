#include "studies/reading/map/profile_reading.hpp"

#include <fmt/format.h>

#include <numeric>

#include "studies/reading/study/profile.hpp"
#include "studies/reading/text/name_pattern.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t few_masses = 8;  // so many can be distinguished in tables and lists

std::vector<std::size_t> all_masses(const mechanics::Network& network) {
  std::vector<std::size_t> masses(network.masses.size());
  std::iota(masses.begin(), masses.end(), std::size_t{0});
  return masses;
}

// Those whose names match a pattern such as floor*, as the study lists them.
std::vector<std::size_t> matching_masses(const TomlSection& section, const mechanics::Network& network) {
  const std::string pattern = section.text("profile");
  if (pattern == "all") return all_masses(network);
  std::vector<std::size_t> masses;
  for (std::size_t i = 0; i < network.masses.size(); ++i)
    if (matches(pattern, network.masses[i])) masses.push_back(i);
  if (masses.empty())
    section.fail(rules::unknown_name, "profile",
                 "no mass is called \"{}\"{}; \"all\" selects all of them, \"floor*\" those whose names "
                 "begin with floor",
                 pattern, hint_of_unmatched(pattern, network.masses));
  return masses;
}

std::vector<std::size_t> read_masses(const TomlSection& section, const mechanics::Network& network) {
  const TomlValue& value = section.require("profile");
  const auto* names = value.as<TomlArray>();
  if (!names && !value.as<std::string>())
    section.fail(rules::wrong_type, "profile",
                 "expected an array of masses, the lowest first, \"all\" or a pattern such as \"floor*\", "
                 "found {}",
                 described(value));
  std::vector<std::size_t> masses = names ? read_places(section, "profile", *names, "mass", network.masses)
                                          : matching_masses(section, network);
  if (masses.size() < 2)
    section.fail(rules::wrong_length, "profile", "a profile needs at least two masses, found {}",
                 masses.size());
  return masses;
}

// One height of all storeys, n for mass n of the profile.
std::vector<double> even_heights(const TomlSection& section, std::size_t masses) {
  const double storey = section.number("height");
  if (!(storey > 0.0))
    section.fail(rules::beyond_schema(rules::out_of_range), "height",
                 "the height of a storey must be positive, found {}", storey);
  std::vector<double> heights;
  for (std::size_t n = 1; n <= masses; ++n) heights.push_back(storey * static_cast<double>(n));
  return heights;
}

std::vector<double> read_heights(const TomlSection& section, std::size_t masses) {
  const TomlValue* value = section.find("height");
  if (!value) return {};
  const auto* items = value->as<TomlArray>();
  if (!items) return even_heights(section, masses);
  const std::string where = section.where() + ": height";
  if (items->size() != masses)
    section.fail(rules::beyond_schema(rules::wrong_length), "height",
                 "{} heights for the {} masses of the profile", items->size(), masses);
  std::vector<double> heights;
  for (const TomlValue& item : *items) {
    const double height = read_number(section.source(), where, item);
    if (!heights.empty() && !(height > heights.back()))
      throw section.source().error_at(rules::wrong_order, item.position,
                                      "{}: {} does not lie above {}, the height of the mass before", where,
                                      height, heights.back());
    heights.push_back(height);
  }
  return heights;
}

}  // namespace

std::optional<Profile> read_profile(const TomlSection* report, const mechanics::Network& network) {
  if (report && report->find("profile")) {
    Profile profile{.masses = read_masses(*report, network), .position = report->require("profile").position};
    profile.height = read_heights(*report, profile.masses.size());
    return profile;
  }
  if (network.masses.size() <= few_masses) return std::nullopt;
  return Profile{.masses = all_masses(network)};
}

}  // namespace frahm::studies
