#include "solvers/identification/statement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace frahm::identification {
namespace {

template <class Rule>
std::string unless(const std::string& what, std::span<const double> values, Rule rule, const char* must) {
  const auto wrong = std::find_if_not(values.begin(), values.end(), rule);
  if (wrong == values.end()) return "";
  return what + " " + std::to_string(wrong - values.begin() + 1) + " of " + std::to_string(values.size()) +
         " is " + number(*wrong) + ": it must be " + must;
}

}  // namespace

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

Identification no_result(std::string why) {
  Identification result;
  result.failure = std::move(why);
  return result;
}

std::string unless_finite(const std::string& what, std::span<const double> values) {
  return unless(
      what, values, [](double value) { return std::isfinite(value); }, "finite");
}

std::string unless_positive(const std::string& what, std::span<const double> values) {
  return unless(
      what, values, [](double value) { return std::isfinite(value) && value > 0.0; }, "positive and finite");
}

std::string unless_equal(const std::string& what, std::initializer_list<std::size_t> sizes) {
  const std::size_t first = *sizes.begin();
  for (const std::size_t size : sizes) {
    if (size != first)
      return what + " have different lengths, " + std::to_string(first) + " and " + std::to_string(size);
  }
  return "";
}

std::string first_of(std::initializer_list<std::string> sentences) {
  const auto first = std::find_if(sentences.begin(), sentences.end(),
                                  [](const std::string& sentence) { return !sentence.empty(); });
  return first == sentences.end() ? "" : *first;
}

void add_from(Identification& result, Estimate estimate, std::initializer_list<Partial> partials) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(result.covariance.rows());
  for (const Partial& partial : partials) {
    for (std::size_t i = 0; i < result.estimates.size(); ++i) {
      if (result.estimates[i].name == partial.name) gradient[static_cast<Eigen::Index>(i)] = partial.slope;
    }
  }
  add_derived(result, std::move(estimate), gradient);
}

}  // namespace frahm::identification
