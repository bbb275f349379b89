#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "solvers/quantities/quantity_table.hpp"
#include "studies/program/point_report.hpp"
#include "studies/reading/quantities/unit_words.hpp"

namespace frahm::studies {
namespace {

std::string value_text(const PointReport::QuantityValue& quantity) {
  if (!has_value(quantity)) return "-";
  if (quantity.description.kind == periodic::QuantityKind::flag) {
    return flag_meaning(quantity.description, quantity.value);
  }
  return fmt::format("{:.10g}", quantity.value);
}

void print_heading(const Study& study, const PointReport& report, std::ostream& out) {
  fmt::print(out, "{}{}{}\n", study.title, study.title.empty() ? "" : "  ", study.source.name);
  for (const auto& [name, value] : report.parameters) {
    fmt::print(out, "  {} = {:.12g}{}{}\n", name, value.value, value.unit.empty() ? "" : " ", value.unit);
  }
  fmt::print(out, "\nstatus {}", report.status);
  if (!report.reason.empty()) fmt::print(out, ": {}", report.reason);
  fmt::print(out, "\n");
  if (std::isnan(report.residual)) {
    fmt::print(out, "\n");
    return;
  }
  fmt::print(out, "residual {:.2g} after {} Newton steps", report.residual, report.newton_iterations);
  if (report.way == periodic::Way::event_phases)
    fmt::print(out, " on the phases of its events; it is proved that there are no others\n");
  else
    fmt::print(out, ", {} passages of the flow\n", report.passages);
  if (!report.continuum.empty())
    fmt::print(out, "one of a continuum: {}; the error bound refers to this one\n", report.continuum);
  if (!report.why_no_bound.empty())
    fmt::print(out, "no error bound: {}; it is not known how many digits are right\n", report.why_no_bound);
  fmt::print(out, "\n");
}

// Whether an excerpt has a quantity.
class Excerpt {
 public:
  explicit Excerpt(const mechanics::Network& network)
      : masses_(listed_indices(network.masses.size(), most_owners, Listing::excerpt)),
        elements_(listed_indices(network.elements.size(), most_owners, Listing::excerpt)) {}

  bool has(const periodic::Quantity& quantity) const {
    switch (periodic::row_of(quantity.measure).owner) {
      case periodic::Owner::mass:
        return std::ranges::find(masses_, quantity.index) != masses_.end();
      case periodic::Owner::element:
      case periodic::Owner::contact:
      case periodic::Owner::sliders:
        return std::ranges::find(elements_, quantity.index) != elements_.end();
      case periodic::Owner::mode:
        return quantity.index < most_owners;
      default:
        return true;
    }
  }

 private:
  static constexpr std::size_t most_owners = 4;
  std::vector<std::size_t> masses_, elements_;
};

void print_quantities(const Study& study, const PointReport& report, Listing listing, std::ostream& out) {
  constexpr std::size_t most_rows = 250;
  const bool is_whole = listing == Listing::whole || report.quantities.size() <= most_rows;
  const std::vector<periodic::Quantity> of_network = periodic::all_quantities(study.network);
  const Excerpt excerpt(study.network);
  std::size_t shown = 0;
  for (std::size_t i = 0; i < report.quantities.size(); ++i) {
    if (!is_whole && i < of_network.size() && !excerpt.has(of_network[i])) continue;
    const auto& [description, value] = report.quantities[i];
    const std::string unit = is_pure_number(description.unit) ? "" : description.unit;
    fmt::print(out, "{:<28}{:>18} {:<7} {}\n", description.name, value_text(report.quantities[i]), unit,
               description.long_name);
    ++shown;
  }
  if (shown < report.quantities.size())
    fmt::print(out, "{} of {} quantities; --all shows all\n", shown, report.quantities.size());
}

void print_stretches(const PointReport& report, std::ostream& out) {
  if (report.stretches.empty() || report.friction_elements.empty()) return;
  constexpr double degree = std::numbers::pi / 180.0;
  fmt::print(out, "\nModes over the period, omega t in degrees\n{:>12}{:>12}", "from", "length");
  for (const std::string& element : report.friction_elements) fmt::print(out, "  {:<14}", element);
  for (const periodic::Stretch& stretch : report.stretches) {
    fmt::print(out, "\n{:>12.4f}{:>12.4f}", stretch.start / degree, stretch.length / degree);
    for (const std::string& contact : stretch.contacts) fmt::print(out, "  {:<14}", contact);
  }
  fmt::print(out, "\n");
}

// A number, or "-" where there is none.
std::string number_text(double value, int digits) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}g}", value, digits);
}

void print_gradient(const PointGradient& gradient, std::ostream& out) {
  fmt::print(out, "\nDerivatives with respect to parameters in SI units\n");
  if (!gradient.reason.empty()) {
    fmt::print(out, "  none: {}\n", gradient.reason);
    return;
  }
  for (const PointGradient::By& by : gradient.by) {
    fmt::print(out, "\n{:<28}{:>20}{:>20}{:>14}\n", "by " + in_brackets(by.parameter, by.unit), "exact",
               "by differences", "relative");
    for (std::size_t i = 0; i < by.derivatives.size(); ++i) {
      const periodic::DerivativeCheck& check = by.derivatives[i];
      fmt::print(out, "{:<28}{:>20}{:>20}{:>14}{}{}\n", gradient.quantities[i].name,
                 number_text(check.exact, 12), number_text(check.difference, 12),
                 number_text(check.relative_difference(), 2), check.why_none.empty() ? "" : "  ",
                 check.why_none);
    }
  }
}

std::string multiplier_text(const std::complex<double>& value) {
  const double size = std::abs(value);
  if (std::abs(value.imag()) <= 1e-12 * size) return fmt::format("{:.10g}", value.real());
  return fmt::format("{:.10g}{:+.10g}i", value.real(), value.imag());
}

void print_numbers(const std::vector<FoundResponse::Number>& numbers, std::ostream& out) {
  for (const FoundResponse::Number& each : numbers)
    fmt::print(out, "   {:<28}{:>18} {}\n", each.name, fmt::format("{:.10g}", each.value),
               is_pure_number(each.unit) ? "" : each.unit);
}

void print_responses(const std::vector<FoundResponse>& responses, std::ostream& out) {
  fmt::print(out, "\nStable responses that were found: {}\n", responses.size());
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const FoundResponse& each = responses[i];
    fmt::print(out, "\n{}  of {} period{} of the excitation", i + 1, each.period_multiple,
               each.period_multiple > 1 ? "s" : "");
    if (each.mirror_of)
      fmt::print(out, ", the mirror image of {}: x(t) = -x_{}(t + T/2)", *each.mirror_of + 1,
                 *each.mirror_of + 1);
    fmt::print(out, "{}\n", each.is_shown ? ", shown above" : "");
    print_numbers(each.peaks, out);
    fmt::print(out, "   multipliers");
    for (const std::complex<double>& value : each.multipliers)
      fmt::print(out, "  {}", multiplier_text(value));
    fmt::print(out, "{}\n   state at omega t = 0\n",
               each.multipliers.empty() ? "  none: an event only just happens" : "");
    print_numbers(each.state, out);
  }
}

}  // namespace

void print_point(const Study& study, const PointReport& report, Listing listing, std::ostream& out) {
  print_heading(study, report, out);
  print_quantities(study, report, listing, out);
  print_stretches(report, out);
  if (report.modes) {
    fmt::print(out, "\n");
    print_modes(study, *report.modes, listing, out);
  }
  if (report.responses) print_responses(*report.responses, out);
  if (report.gradient) print_gradient(*report.gradient, out);
}

}  // namespace frahm::studies
