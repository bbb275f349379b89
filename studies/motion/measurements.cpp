#include "studies/motion/measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <numbers>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSamplesAPeriod = 100.0;  // by default: smooth to the eye, usual for loggers
constexpr double kPeriods = 10.0;          // of a periodic response, by default
constexpr double kMostSamples = 1e7;

bool is_periodic(const Study& study) {
  return study.kind() == StudyKind::sweep || (study.tune() && !study.tune()->peaks);
}

mechanics::NetworkValues values_of(const Study& study, std::span<const double> at) {
  if (!is_periodic(study)) return motion_values(study);
  std::vector<double> parameters(at.begin(), at.end());
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

// Where no mode oscillates the excitation does, or the user decides.
double usual_rate(const Study& study, const mechanics::NetworkValues& values) {
  const double lowest =
      periodic::lowest_frequency(study.network, values, free_masses(study.kind(), study.network));
  const double excited =
      study.kind() == StudyKind::decay ? 0.0 : study.network.reference_order * values.omega;
  const bool oscillates = std::ranges::any_of(study.network.excitations,
                                              [](const auto& component) { return component.order > 0; });
  if (!(lowest > 0.0) && (study.kind() == StudyKind::decay || !oscillates))
    throw StudyError(rules::wrong_option,
                     "{}: nothing oscillates, so no rate of samples is usual; give --rate",
                     study.source.name);
  return kSamplesAPeriod * (lowest > excited ? lowest : excited) / kTurn;
}

std::vector<double> sample_times_of(const Study& study, double duration, double rate) {
  constexpr double kRounding = 1e-12;
  const double steps = std::floor(duration * rate * (1.0 + kRounding));
  if (!(steps >= 1.0 && steps < kMostSamples)) {
    throw StudyError(rules::out_of_range,
                     "{}: {:.6g} s at {:.6g} samples a second make {:.6g} samples; must be from 2 "
                     "to ten million",
                     study.source.name, duration, rate, steps + 1.0);
  }
  std::vector<double> times;
  for (double i = 0.0; i <= steps; i += 1.0) times.push_back(i / rate);
  return times;
}

// All columns that a motion has.
std::vector<MeasuredColumn> columns_of(const Study& study, const transient::Samples& samples) {
  std::vector<MeasuredColumn> columns;
  for (std::size_t i = 0; i < mechanics::coordinate_count(study.network); ++i) {
    const std::string& name = mechanics::coordinate_name(study.network, i);
    const auto unit = [&](const char* linear) {
      return std::string(mechanics::coordinate_unit(study.network, i, linear));
    };
    columns.push_back({name + "_displacement", unit("m"), samples.displacement[i]});
    columns.push_back({name + "_velocity", unit("m s-1"), samples.velocity[i]});
    columns.push_back({name + "_acceleration", unit("m s-2"), samples.acceleration[i]});
  }
  return columns;
}

std::vector<MeasuredColumn> columns_of(periodic::History history) {
  std::vector<MeasuredColumn> columns;
  for (std::size_t i = 0; i < history.names.size(); ++i)
    columns.push_back({history.names[i], history.units[i], std::move(history.columns[i])});
  return columns;
}

StudyValue constant(double value) {
  StudyValue result;
  result.expression = Expression(value);
  return result;
}

double duration_of_motion(const Study& study) {
  if (study.kind() == StudyKind::transient) return forced_options(study).duration;
  return study.motion()->duration ? stated(study, *study.motion()->duration) : solve_decay(study).duration;
}

std::vector<MeasuredColumn> motion_columns(Study study, const std::vector<double>& times) {
  study.motion()->duration = constant(times.back());
  study.motion()->samples = static_cast<int>(times.size());
  if (study.kind() == StudyKind::decay) return columns_of(study, solve_decay(study).history);
  return columns_of(study, solve_transient(study).history);
}

std::vector<MeasuredColumn> periodic_columns(const Study& study, const mechanics::NetworkValues& values,
                                             const std::vector<double>& times) {
  periodic::PeriodicResponse response(study.network, {}, periodic::Path::fastest, study.orbits_wanted());
  response.set_values(values);
  const periodic::ResponseSummary& summary = response.solve();
  if (!periodic::has_response(summary.status))
    throw StudyError(rules::not_computed, "{}: there is no periodic response: {}", study.source.name,
                     summary.reason);
  std::vector<double> phases;
  for (const double time : times) phases.push_back(values.omega * time);
  return columns_of(response.history(phases));
}

// The requested columns, in that order.
std::vector<MeasuredColumn> chosen(const Study& study, std::vector<MeasuredColumn> all,
                                   std::vector<std::string> names) {
  if (names.empty()) {
    for (const std::string& mass : study.network.masses) names.push_back(mass + "_displacement");
  }
  std::vector<std::string> known;
  for (const MeasuredColumn& column : all) known.push_back(column.name);
  std::vector<MeasuredColumn> columns;
  for (const std::string& name : names) {
    const auto place = place_among(known, name);
    if (!place) {
      throw StudyError(rules::unknown_name, "--columns: nothing is called \"{}\"{}", name,
                       suggestion(name, known));
    }
    if (std::count(names.begin(), names.end(), name) > 1)
      throw StudyError(rules::given_twice, "--columns: \"{}\" is given twice", name);
    columns.push_back(all[*place]);
  }
  return columns;
}

double standard_deviation(const std::vector<double>& values) {
  double mean = 0.0, square = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) square += (value - mean) * (value - mean);
  return std::sqrt(square / static_cast<double>(values.size()));
}

void add_noise(const SensorNoise& noise, std::vector<MeasuredColumn>& columns) {
  boost::random::mt19937_64 generator(noise.seed);
  for (MeasuredColumn& column : columns) {
    const double size = noise.share > 0.0 ? noise.share * standard_deviation(column.values) : noise.absolute;
    if (size == 0.0) continue;
    boost::random::normal_distribution<double> normal(0.0, size);
    for (double& value : column.values) value += normal(generator);
  }
}

}  // namespace

Measurements measure(const Study& study, std::span<const double> parameters,
                     const MeasurementOptions& options) {
  try {
    const mechanics::NetworkValues values = values_of(study, parameters);
    const double rate = options.rate > 0.0 ? options.rate : usual_rate(study, values);
    const double duration = options.duration     ? *options.duration
                            : is_periodic(study) ? kPeriods * kTurn / values.omega
                                                 : duration_of_motion(study);
    Measurements result{.time = sample_times_of(study, duration, rate), .columns = {}, .rate = rate};
    std::vector<MeasuredColumn> all = is_periodic(study) ? periodic_columns(study, values, result.time)
                                                         : motion_columns(study, result.time);
    result.columns = chosen(study, std::move(all), options.columns);
    add_noise(options.noise, result.columns);
    return result;
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

}  // namespace frahm::studies
