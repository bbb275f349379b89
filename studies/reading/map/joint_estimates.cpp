#include "studies/reading/map/joint_estimates.hpp"

#include <fmt/format.h>

#include <cmath>

#include "studies/reading/data_files/earlier_estimates.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/map/axis_reading.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

// The names in the array `parameters`, each with its place.
struct Wanted {
  std::string name;
  Position position;
};

std::vector<Wanted> read_parameters_wanted(const TomlSection& section) {
  const auto* items = section.require("parameters").as<TomlArray>();
  if (!items || items->empty())
    section.fail(rules::wrong_type, "parameters", "expected an array of names such as [\"k\"]");
  std::vector<Wanted> wanted;
  for (const TomlValue& item : *items)
    wanted.push_back({read_text(section.source(), section.where() + ": parameters", item), item.position});
  return wanted;
}

[[noreturn]] void fail_at(const SampleReading& reading, const Wanted& wanted, Rule rule,
                          const std::string& problem) {
  throw reading.context.source.error_at(rule, wanted.position, "{}: parameters: {}", reading.section.where(),
                                        problem);
}

ParameterAxis& add_axis_of(SampleReading& reading, const Wanted& wanted) {
  if (const auto refusal = why_no_axis(reading.study, wanted.name))
    fail_at(reading, wanted, refusal->rule, refusal->text);
  ParameterAxis& axis = add_axis(reading, *reading.study.parameters.find(wanted.name));
  axis.position = wanted.position;
  return axis;
}

// Gives an estimate its axis, in SI. Returns its index among the estimates.
std::size_t take_estimate(SampleReading& reading, const Wanted& wanted, const EarlierEstimates& earlier) {
  const auto place = place_among(earlier.names, wanted.name);
  if (!place)
    fail_at(reading, wanted, rules::unknown_name,
            fmt::format("{} has no estimate \"{}\"{}", earlier.file, wanted.name,
                        suggestion(wanted.name, earlier.names)));
  const std::size_t i = *place;
  const double deviation = std::sqrt(earlier.covariance[i][i]);
  if (!std::isfinite(earlier.values[i]) || !std::isfinite(deviation))
    fail_at(reading, wanted, rules::wrong_file,
            fmt::format("\"{}\" was not determined by the data of {}", wanted.name, earlier.file));
  ParameterAxis& axis = add_axis_of(reading, wanted);
  Parameter& parameter = reading.study.parameters.list[axis.parameter];
  try {
    check_unit(reading.context, earlier, i, parameter);
  } catch (const StudyError& error) {
    fail_at(reading, wanted, error.rule(), error.what());
  }
  const std::string& unit = earlier.units[i];
  if (is_pure_number(unit) || reading.context.dimensionless) {
    axis.unit = parameter.quantity && !reading.context.dimensionless ? si_unit(*parameter.quantity) : "1";
  } else {
    set_axis_unit(reading.context.units.parse(unit), parameter, axis);
  }
  reading.choice.texts.back() = with_unit_of(
      axis,
      fmt::format("normal, mean {:.6g}, deviation {:.6g}, as identified", earlier.values[i], deviation));
  return i;
}

JointEstimates take_estimates(SampleReading& reading, const std::vector<Wanted>& wanted,
                              const EarlierEstimates& earlier) {
  std::vector<std::size_t> taken;
  for (const Wanted& each : wanted) taken.push_back(take_estimate(reading, each, earlier));
  const auto n = static_cast<Eigen::Index>(taken.size());
  JointEstimates joint{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index a = 0; a < n; ++a) {
    const std::size_t i = taken[static_cast<std::size_t>(a)];
    joint.mean(a) = earlier.values[i];
    for (Eigen::Index b = 0; b < n; ++b)
      joint.covariance(a, b) = earlier.covariance[i][taken[static_cast<std::size_t>(b)]];
  }
  return joint;
}

// The values of the study, without scatter.
JointEstimates stated(SampleReading& reading, const std::vector<Wanted>& wanted) {
  const auto n = static_cast<Eigen::Index>(wanted.size());
  JointEstimates joint{Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index a = 0; a < n; ++a) {
    const ParameterAxis& axis = add_axis_of(reading, wanted[static_cast<std::size_t>(a)]);
    joint.mean(a) = std::get<double>(reading.study.parameters.list[axis.parameter].definition);
  }
  return joint;
}

}  // namespace

JointEstimates read_joint_estimates(SampleReading& reading, const std::filesystem::path& folder,
                                    DataFiles data) {
  const TomlSection& section = reading.section;
  if (!section.find("fixed_from")) return {};
  const std::string file = section.text("fixed_from");
  const std::vector<Wanted> wanted = read_parameters_wanted(section);
  if (data == DataFiles::leave) return stated(reading, wanted);
  EarlierEstimates earlier;
  try {
    earlier = read_earlier(folder / file, file);
  } catch (const StudyError& error) {
    section.fail(error.rule(), "fixed_from", "{}", error.what());
  }
  return take_estimates(reading, wanted, earlier);
}

}  // namespace frahm::studies
