// Any text as an expression of three parameters. What is read has one value, whatever it is evaluated on, and
// the dimension of its value can be asked for.
#include "studies/reading/quantities/expression.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "studies/reading/quantities/dual.hpp"
#include "studies/reading/quantities/expression_dimension.hpp"
#include "tests/fuzz/outcome.hpp"

namespace {

using namespace frahm::studies;
using frahm::fuzz::Outcome;

const std::vector<std::string> names{"speed", "I", "F_P"};

void check_same(double a, double b) {
  if (a != b && !(std::isnan(a) && std::isnan(b))) std::abort();
}

// exp(log(b) a) of duals and pow(b, a) of doubles are not one operation, so only what both define is
// compared.
void evaluate(const Expression& expression) {
  constexpr std::array<double, 3> values{2.5, -1.5, 1e-3};
  std::array<Dual, 3> duals;
  for (std::size_t i = 0; i < values.size(); ++i) duals[i] = {values[i], i == 0 ? 1.0 : 0.0};
  check_same(expression.evaluate<double>(values), expression.evaluate<Dual>(duals).value);
}

void ask_dimension(const Expression& expression) {
  const std::array<ExpressionDimension, 3> dimensions{Exponents{0.0, 0.0, -1.0}, Exponents{0.0, 1.0, 0.0},
                                                      std::nullopt};
  try {
    dimension_of(expression, dimensions);
    dimension_of(expression, dimensions, PlainFactor::pure_number);
  } catch (const ExpressionError&) {
  }
}

Outcome outcome_of(const std::string& text) {
  try {
    const Expression expression = Expression::parse(text, names);
    evaluate(expression);
    ask_dimension(expression);
    if (expression.canonical_text(names).empty()) std::abort();
    return Outcome::read;
  } catch (const ExpressionError& error) {
    if (error.column() < 1 || error.column() > text.size() + 1) std::abort();
    return Outcome::refused;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  frahm::fuzz::count(outcome_of(std::string(reinterpret_cast<const char*>(data), size)));
  return 0;
}
