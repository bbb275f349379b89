#include "studies/reading/map/distribution_reading.hpp"

#include <fmt/format.h>

#include <cmath>

namespace frahm::studies {
namespace {

using samples::Distribution;

constexpr double least_share = 1e-9;  // that cuts leave: less has no digits left

// The one of two keys that is given.
std::string one_of(const TomlSection& section, const char* first, const char* second) {
  return section.find(first) ? first : second;
}

void read_ends(const TomlSection& section, Distribution& distribution) {
  if (section.find("lower")) distribution.lower = section.number("lower");
  if (section.find("upper")) distribution.upper = section.number("upper");
  if (distribution.lower < distribution.upper) return;
  section.fail(rules::wrong_order, "upper", "is {}; must be above lower, {}", distribution.upper,
               distribution.lower);
}

void check_cuts(const TomlSection& section, const Distribution& distribution) {
  if (samples::kept_share(distribution) >= least_share) return;
  section.fail(rules::beyond_schema(rules::out_of_range), section.find("lower") ? "lower" : "upper",
               "less than {} of the distribution lies between lower and upper", least_share);
}

void read_normal(const TomlSection& section, Distribution& distribution) {
  distribution.centre = section.number("mean");
  const std::string spread = one_of(section, "deviation", "variation");
  distribution.spread = section.number(spread);
  if (spread == "deviation") return;
  distribution.spread *= std::abs(distribution.centre);
  if (!(distribution.spread > 0.0))
    section.fail(rules::beyond_schema(rules::out_of_range), "variation",
                 "belongs to a mean of 0; give the deviation instead");
}

// Mean = median exp(s^2 / 2), s the deviation of the logarithm.
void read_lognormal(const TomlSection& section, Distribution& distribution) {
  const std::string centre = one_of(section, "median", "mean");
  distribution.centre = section.number(centre);
  if (!(distribution.centre > 0.0))
    section.fail(rules::out_of_range, centre, "is {}; must be > 0", distribution.centre);
  const std::string spread = one_of(section, "deviation", "variation");
  const double given = section.number(spread);
  if (spread == "variation") {
    distribution.spread = samples::log_deviation(given);
  } else if (centre == "mean") {
    distribution.spread = samples::log_deviation(given / distribution.centre);
  } else {
    distribution.spread = samples::log_deviation_by_median(given / distribution.centre);
  }
  if (centre == "mean") distribution.centre *= std::exp(-0.5 * distribution.spread * distribution.spread);
}

void read_bounded(const TomlSection& section, Distribution& distribution) {
  read_ends(section, distribution);
  if (distribution.kind == Distribution::Kind::uniform) return;
  distribution.centre = section.number("mode");
  if (distribution.centre < distribution.lower || distribution.centre > distribution.upper)
    section.fail(rules::beyond_schema(rules::out_of_range), "mode", "is {}; must be from {} to {}",
                 distribution.centre, distribution.lower, distribution.upper);
}

// "normal, mean 5, deviation 0.5": what the study says.
std::string text_of(const TomlSection& section, const std::string& name) {
  std::string text = name;
  for (const char* key : {"mean", "median", "mode", "deviation", "variation", "lower", "upper"}) {
    if (section.find(key)) text += fmt::format(", {} {:.6g}", key, section.number(key));
  }
  return text;
}

}  // namespace

ReadDistribution read_distribution(const TomlSection& section) {
  const std::string name = section.choice("distribution");
  section.keep_to(name);
  Distribution distribution;
  distribution.kind = section.choice_as<Distribution::Kind>("distribution");
  if (name == "uniform" || name == "triangular") {
    read_bounded(section, distribution);
  } else {
    name == "normal" ? read_normal(section, distribution) : read_lognormal(section, distribution);
    if (section.find("lower") || section.find("upper")) read_ends(section, distribution);
    check_cuts(section, distribution);
  }
  return {distribution, text_of(section, name)};
}

}  // namespace frahm::studies
