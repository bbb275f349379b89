#include "studies/program/data_export.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <ostream>
#include <string_view>

#include "engine/io_error.hpp"
#include "results/map_reader.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/motion/measurements.hpp"
#include "studies/program/point_command.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/stored_study.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {
namespace {

constexpr std::string_view data_mark = "# simulated by frahm export";

// A number > 0 and the unit after it.
struct Amount {
  double value = 0.0;
  std::string unit;
};

Amount amount_of(const char* option, const std::string& text) {
  Amount amount;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, amount.value);
  if (error != std::errc{} || !(amount.value > 0.0) || !std::isfinite(amount.value))
    throw StudyError(rules::wrong_option, "{} \"{}\": must be a number > 0, with its unit or without", option,
                     text);
  amount.unit.assign(stop, end);
  amount.unit.erase(0, amount.unit.find_first_not_of(' '));
  return amount;
}

double si_amount(const Study& study, const char* option, const std::string& text, Quantity quantity) {
  const Amount amount = amount_of(option, text);
  if (amount.unit.empty()) return amount.value;
  if (study.dimensionless)
    throw StudyError(rules::wrong_option, "{} \"{}\": a dimensionless study has no units", option, text);
  try {
    return UnitSystem().to_si(amount.value, amount.unit, quantity);
  } catch (const UnitError& error) {
    throw StudyError(rules::wrong_option, "{} \"{}\": {}", option, text, error.what());
  }
}

// Samples a second: a frequency in cycles.
double rate_of(const Study& study, const std::string& text) {
  if (text.empty()) return 0.0;
  const double value = si_amount(study, "--rate", text, Quantity::angular_frequency);
  return amount_of("--rate", text).unit.empty() ? value : value / (2.0 * std::numbers::pi);
}

std::uint64_t seed_of(const std::string& text) {
  std::uint64_t seed = 1;
  if (text.empty()) return seed;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc{} && stop == end) return seed;
  throw StudyError(rules::wrong_option,
                   "--seed \"{}\": must be a whole number from 0 to 18446744073709551615", text);
}

bool is_of_rotation(const mechanics::Network& network, std::string_view owner) {
  const auto of_element = [&](const mechanics::Element& each) {
    return each.name == owner && each.rotational;
  };
  const auto mass = std::ranges::find(network.masses, owner) - network.masses.begin();
  return mechanics::rotates(network, static_cast<std::size_t>(mass)) ||
         std::ranges::any_of(network.elements, of_element);
}

Quantity quantity_of(const Study& study, std::string_view column) {
  const bool rotation = is_of_rotation(study.network, column.substr(0, column.rfind('_')));
  if (column.ends_with("_velocity")) return rotation ? Quantity::angular_frequency : Quantity::speed;
  if (column.ends_with("_acceleration"))
    return rotation ? Quantity::angular_acceleration : Quantity::acceleration;
  if (column.ends_with("_force")) return rotation ? Quantity::torque : Quantity::force;
  return rotation ? Quantity::angle : Quantity::length;
}

// A share of each column, or an amount in a unit that all columns can have.
SensorNoise noise_of(const Study& study, const DataOptions& options) {
  SensorNoise noise{.seed = seed_of(options.seed)};
  if (options.noise.empty()) return noise;
  const Amount amount = amount_of("--noise", options.noise);
  if (amount.unit == "%") {
    noise.share = 0.01 * amount.value;
    return noise;
  }
  if (amount.unit.empty() && !study.dimensionless) {
    throw StudyError(rules::wrong_option,
                     "--noise \"{}\": has no unit; write a share such as 1%, or an amount such as \"0.1 mm\"",
                     options.noise);
  }
  const Quantity first =
      quantity_of(study, options.columns.empty() ? study.network.masses.front() + "_displacement"
                                                 : options.columns.front());
  noise.absolute = si_amount(study, "--noise", options.noise, first);
  for (const std::string& column : options.columns)
    si_amount(study, "--noise", options.noise, quantity_of(study, column));
  return noise;
}

// A table replaces only an earlier table of its own kind.
void check_place(const std::filesystem::path& place) {
  std::ifstream there(place);
  std::string line;
  if (!there || !std::filesystem::is_regular_file(place)) return;
  if (std::getline(there, line) && line.starts_with(data_mark)) return;
  throw engine::IoError(place, "exists already and was not made by frahm export --data; name another file");
}

std::string csv(const Study& study, const std::filesystem::path& file, const DataOptions& options,
                const Measurements& measured) {
  std::string text =
      fmt::format("{} from {}, {} samples at {:.10g} {}, noise {}{}\n", data_mark, file.filename().string(),
                  measured.time.size(), measured.rate, study.dimensionless ? "in a unit of time" : "Hz",
                  options.noise.empty() ? "none" : options.noise,
                  options.noise.empty() ? "" : fmt::format(" with seed {}", seed_of(options.seed)));
  const auto name = [&](const std::string& column, const std::string& unit) {
    return study.dimensionless ? column : fmt::format("{} [{}]", column, unit);
  };
  text += name("time", "s");
  for (const MeasuredColumn& column : measured.columns) {
    text += ',';
    text += name(column.name, column.unit);
  }
  for (std::size_t row = 0; row < measured.time.size(); ++row) {
    fmt::format_to(std::back_inserter(text), "\n{:.17g}", measured.time[row]);
    for (const MeasuredColumn& column : measured.columns)
      fmt::format_to(std::back_inserter(text), ",{:.17g}", column.values[row]);
  }
  return text + "\n";
}

Study study_of(const std::filesystem::path& file, const std::vector<std::string>& set) {
  if (file.extension() == ".toml") return read_study_with(file, set);
  if (!set.empty())
    throw StudyError(rules::wrong_option, "--set: the parameters of a result are fixed; name its study");
  require_result(file);
  return read_stored_study(results::MapReader(file), file).study;
}

}  // namespace

int export_data(const std::filesystem::path& file, const DataOptions& options, std::ostream& out) {
  const Study study = study_of(file, options.set);
  if (study.identify())
    throw StudyError(rules::other_kind,
                     "{}: an identification reads measurements and has no motion of its own; frahm export "
                     "--study makes a study from its estimates",
                     file.string());
  if (!study.motion()) require_responses(study);
  const MeasurementOptions asked{
      .rate = rate_of(study, options.rate),
      .duration = options.duration.empty()
                      ? std::nullopt
                      : std::optional(si_amount(study, "--duration", options.duration, Quantity::time)),
      .noise = noise_of(study, options),
      .columns = options.columns};
  const bool motion = study.motion() != nullptr;
  if (motion && !options.at.empty())
    throw StudyError(rules::wrong_option, "--at: belongs to the periodic response of a sweep or tuning");
  const std::vector<double> parameters = parameters_at(study, options.at);
  const std::string table = csv(study, file, options, measure(study, parameters, asked));
  if (options.output == "-") {
    out << table;
    return 0;
  }
  check_output_is_not_input(options.output, file);
  check_place(options.output);
  write_whole_file(options.output, table);
  fmt::print(out, "{}\n", options.output.string());
  return 0;
}

}  // namespace frahm::studies
