#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "solvers/identification/identification.hpp"

// Common parts of the methods: numbers as text, sentences for failures, derived estimates.
namespace frahm::identification {

std::string number(double value);  // to six digits

// A result that has only its failure.
Identification no_result(std::string why);

// "" if all values are finite (and > 0), otherwise a sentence that names the fault. what: "response".
std::string unless_finite(const std::string& what, std::span<const double> values);
std::string unless_positive(const std::string& what, std::span<const double> values);
// "" if all sizes equal the first, otherwise a sentence.
std::string unless_equal(const std::string& what, std::initializer_list<std::size_t> sizes);
// The first that is not "".
std::string first_of(std::initializer_list<std::string> sentences);

// An estimate that depends on some of those there: the name of each, and the derivative by it.
struct Partial {
  const char* name;
  double slope;
};
void add_from(Identification& result, Estimate estimate, std::initializer_list<Partial> partials);

}  // namespace frahm::identification
