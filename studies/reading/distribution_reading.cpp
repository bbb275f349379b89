#include "studies/reading/distribution_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/reading/spelling.hpp"

namespace frahm::studies {
namespace {

using samples::Distribution;

constexpr double least_share = 1e-9;  // that cuts leave: less has no digits left

const std::vector<std::string> distribution_names{"normal", "lognormal", "uniform",
                                                  "triangular"};  // as Distribution::Kind

// Refuses keys of other distributions, which would have no effect.
void check_keys(const TomlSection& section, const std::string& name, const std::vector<std::string>& own) {
  for (const std::string& key : distribution_keys) {
    if (key == "distribution" || std::ranges::find(own, key) != own.end() || !section.find(key)) continue;
    section.fail(rules::key_without_use, key, "has no effect: a {} distribution has {}", name,
                 listed(own, " and "));
  }
}

// The one of two keys that is given.
std::string one_of(const TomlSection& section, const char* first, const char* second) {
  const bool has_first = section.find(first), has_second = section.find(second);
  if (has_first == has_second)
    section.fail_here(rules::one_of_two_keys, "needs \"{}\" or \"{}\"{}", first, second,
                      has_first ? ", not both" : "");
  return has_first ? first : second;
}

double positive(const TomlSection& section, const std::string& key) {
  const double value = section.number(key);
  if (!(value > 0.0)) section.fail(rules::out_of_range, key, "is {}; must be > 0", value);
  return value;
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
  section.fail(rules::out_of_range, section.find("lower") ? "lower" : "upper",
               "the distribution lies outside lower and upper but for less than {} of it", least_share);
}

void read_normal(const TomlSection& section, Distribution& distribution) {
  check_keys(section, "normal", {"mean", "deviation", "variation", "lower", "upper"});
  distribution.centre = section.number("mean");
  const std::string spread = one_of(section, "deviation", "variation");
  distribution.spread = positive(section, spread);
  if (spread == "deviation") return;
  distribution.spread *= std::abs(distribution.centre);
  if (!(distribution.spread > 0.0))
    section.fail(rules::out_of_range, "variation", "is that of a mean of 0; give the deviation");
}

// Mean = median exp(s^2 / 2), s the deviation of the logarithm.
void read_lognormal(const TomlSection& section, Distribution& distribution) {
  check_keys(section, "lognormal", {"mean", "median", "deviation", "variation", "lower", "upper"});
  const std::string centre = one_of(section, "median", "mean");
  distribution.centre = positive(section, centre);
  const std::string spread = one_of(section, "deviation", "variation");
  const double given = positive(section, spread);
  if (spread == "variation") {
    distribution.spread = samples::log_deviation(given);
  } else if (centre == "mean") {
    distribution.spread = samples::log_deviation(given / distribution.centre);
  } else {
    distribution.spread = samples::log_deviation_by_median(given / distribution.centre);
  }
  if (centre == "mean") distribution.centre *= std::exp(-0.5 * distribution.spread * distribution.spread);
}

void read_bounded(const TomlSection& section, const std::string& name, Distribution& distribution) {
  const bool triangular = name == "triangular";
  std::vector<std::string> own{"lower", "upper"};
  if (triangular) own.insert(own.begin() + 1, "mode");
  check_keys(section, name, own);
  for (const std::string& key : own) section.require(key);
  read_ends(section, distribution);
  if (!triangular) return;
  distribution.centre = section.number("mode");
  if (distribution.centre < distribution.lower || distribution.centre > distribution.upper)
    section.fail(rules::out_of_range, "mode", "is {}; must be from {} to {}", distribution.centre,
                 distribution.lower, distribution.upper);
}

// "normal, mean 5, deviation 0.5": what the study says.
std::string told(const TomlSection& section, const std::string& name) {
  std::string text = name;
  for (const std::string& key : distribution_keys) {
    if (key != "distribution" && section.find(key))
      text += fmt::format(", {} {:.6g}", key, section.number(key));
  }
  return text;
}

}  // namespace

ReadDistribution read_distribution(const TomlSection& section) {
  section.require("distribution");
  const std::string name = section.choice_or("distribution", distribution_names);
  Distribution distribution;
  distribution.kind = static_cast<Distribution::Kind>(std::ranges::find(distribution_names, name) -
                                                      distribution_names.begin());
  if (name == "uniform" || name == "triangular") {
    read_bounded(section, name, distribution);
  } else {
    name == "normal" ? read_normal(section, distribution) : read_lognormal(section, distribution);
    if (section.find("lower") || section.find("upper")) read_ends(section, distribution);
    check_cuts(section, distribution);
  }
  return {distribution, told(section, name)};
}

}  // namespace frahm::studies
