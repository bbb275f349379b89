#include "studies/reading/system/period_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "studies/reading/system/recorded_excitation.hpp"

namespace frahm::studies {
namespace {

using mechanics::Corner, mechanics::CornerSeries, mechanics::ExcitationKind;
using transient::RecordOf;

constexpr double few_digits = 1e-6;  // of the largest value: of numbers written with few digits

double largest_of(const std::vector<Corner>& corners) {
  double largest = 0.0;
  for (const Corner& corner : corners) largest = std::max(largest, std::abs(corner.value));
  return largest;
}

void check_closes(const TomlSection& section, const Period& period) {
  const double first = period.corners.front().value, last = period.corners.back().value;
  if (period.of != RecordOf::displacement ||
      std::abs(last - first) <= few_digits * largest_of(period.corners))
    return;
  section.fail(
      rules::wrong_order, period.key,
      "begins at {} and ends at {}, where the next period begins; a displacement cannot jump, so its "
      "last value must be the first again",
      first, last);
}

bool is_rate(const Period& period) {
  return period.of == RecordOf::velocity || period.of == RecordOf::acceleration;
}

bool has_mean(const Period& period, const CornerSeries& series) {
  return std::abs(series.mean) > few_digits * largest_of(period.corners);
}

void check_mean(const TomlSection& section, const Period& period, const CornerSeries& series) {
  if (!period.file.empty() || !is_rate(period) || !has_mean(period, series)) return;
  const bool is_velocity = period.of == RecordOf::velocity;
  section.fail(rules::wrong_order, period.key,
               "its mean over the period is {:.6g}, but a support that comes back has a mean {} of 0; {}",
               series.mean, is_velocity ? "velocity" : "acceleration",
               is_velocity ? "a belt is another [[excitation.motion]] of this node, of order 0"
                           : "take the mean off the values");
}

// What a measurement has and a support that comes back does not.
std::string note_on_mean(const NetworkReading& reading, const Period& period, const CornerSeries& series) {
  if (!is_rate(period) || !has_mean(period, series)) return "";
  const Quantity quantity = quantity_of_course(reading.result.network, period.of, period.node.index);
  const std::string unit = reading.context.dimensionless ? "" : fmt::format(" {}", written_si_unit(quantity));
  return fmt::format(", and its mean, {:.3g}{}", series.mean, unit);
}

// The displacement of a velocity c e^(i n w t) is c/(n w) e^(i n w t - i pi/2), that of an acceleration
// c/(n w)^2 e^(i n w t + i pi).
void add_order(NetworkReading& reading, const Period& period, int order, std::complex<double> c,
               const StudyValue& scale, const StudyValue& phase) {
  auto& [network, values, driving] = reading.result;
  StudyValue amplitude = scale, shifted = phase;
  const bool is_force = period.of == RecordOf::force;
  amplitude.quantity =
      quantity_of_course(network, is_force ? RecordOf::force : RecordOf::displacement, period.node.index);
  amplitude.unit = {};
  amplitude.expression = Expression(order > 0 ? std::abs(c) : c.real()) * scale.expression;
  const Expression rate = Expression(order) * values.omega.expression;
  double turned = order > 0 ? std::arg(c) : 0.0;
  if (is_rate(period)) {
    amplitude.expression = amplitude.expression / rate;
    turned -= 0.5 * std::numbers::pi;
  }
  if (period.of == RecordOf::acceleration) {
    amplitude.expression = amplitude.expression / rate;
    turned -= 0.5 * std::numbers::pi;
  }
  shifted.expression = Expression(turned) + Expression(order) * phase.expression;
  network.excitations.push_back(
      {is_force ? ExcitationKind::force : ExcitationKind::motion, period.node.index, order});
  values.amplitude.push_back(std::move(amplitude));
  values.phase.push_back(std::move(shifted));
  values.rod.push_back({});
}

}  // namespace

void add_period(NetworkReading& reading, const TomlSection& section, const Period& period) {
  check_closes(section, period);
  const int orders = static_cast<int>(section.integer("orders"));
  const CornerSeries series = mechanics::corner_series(period.corners, orders);
  check_mean(section, period, series);
  auto& [network, values, driving] = reading.result;
  StudyValue scale = read_value(reading, section, "scale", Quantity::number, 1.0);
  const StudyValue phase = read_value(reading, section, "phase", Quantity::angle, 0.0);
  if (!section.find("scale")) {
    scale.where = fmt::format("{}: {}", section.where(), period.key);
    scale.position = section.require(period.key).position;
  }
  PeriodSeries noted{.what = section.where(),
                     .first = network.excitations.size(),
                     .orders = orders,
                     .left_out = series.left_out,
                     .note = note_on_mean(reading, period, series),
                     .file = period.file};
  if (!period.file.empty()) {
    for (const Corner& corner : period.corners) {
      noted.time.push_back(corner.at);
      noted.samples.push_back(corner.value);
    }
  }
  if (series.mean != 0.0 && !is_rate(period)) add_order(reading, period, 0, series.mean, scale, phase);
  for (int n = 1; n <= orders; ++n) {
    const std::complex<double> c = series.harmonics[static_cast<std::size_t>(n) - 1];
    if (c == 0.0) continue;
    add_order(reading, period, n, c, scale, phase);
    ++noted.harmonics;
  }
  noted.count = network.excitations.size() - noted.first;
  values.series.push_back(std::move(noted));
}

}  // namespace frahm::studies
