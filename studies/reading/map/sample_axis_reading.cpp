#include "studies/reading/map/sample_axis_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/samples/correlated.hpp"
#include "solvers/samples/sequence.hpp"
#include "studies/reading/map/axis_reading.hpp"
#include "studies/reading/map/distribution_reading.hpp"
#include "studies/reading/map/joint_estimates.hpp"
#include "studies/reading/map/sample_table.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/text/decimal_digits.hpp"

namespace frahm::studies {
namespace {

// The distributions of the tables [[axis.of]], each with an axis.
std::vector<samples::Distribution> read_distributions(const TomlValue& table, SampleReading& reading) {
  std::vector<samples::Distribution> distributions;
  for (const TomlValue* each : read_tables(reading.context.source, table, "of")) {
    const std::string where = label(*each, "axis.of", "parameter", "axis.of", distributions.size() + 1);
    const TomlSection section(reading.context.source, *each, where, "axis.of");
    const std::size_t parameter = read_axis_parameter(section, reading.study);
    const ReadDistribution read = read_distribution(section);
    ParameterAxis& added = add_axis(reading, parameter);
    added.position = section.position();
    read_axis_unit(reading.context, section, reading.study.parameters.list[parameter], added);
    reading.choice.texts.back() = with_unit_of(added, read.text);
    distributions.push_back(read.distribution);
  }
  return distributions;
}

// Twelve digits: what libraries differ in beyond them does not reach the record.
double to_twelve_digits(double value) {
  return std::isfinite(value) ? to_digits(value, 12) : value;
}

void set_values(SampleReading& reading, std::size_t i, const Eigen::VectorXd& drawn) {
  ParameterAxis& axis = reading.study.map()->axes[reading.choice.axes[i]];
  for (Eigen::Index k = 0; k < drawn.size(); ++k) {
    axis.values.push_back(to_twelve_digits(drawn(k)));
    if (!std::isfinite(axis.values.back()))
      reading.section.fail_here(rules::not_finite, "sample {} of \"{}\" is {}", k,
                                reading.study.parameters.list[axis.parameter].name, drawn(k));
  }
}

// `samples = 1000` of stated distributions.
void draw(SampleReading& reading, const TomlValue& table, const std::filesystem::path& folder,
          DataFiles data) {
  const TomlSection& section = reading.section;
  const auto count = static_cast<std::size_t>(section.integer("samples"));
  const std::string sequence = section.choice("sequence");
  const auto seed = static_cast<std::uint64_t>(section.integer("seed"));
  const std::vector<samples::Distribution> distributions = read_distributions(table, reading);
  const JointEstimates joint = read_joint_estimates(reading, folder, data);
  const auto own = static_cast<Eigen::Index>(distributions.size());
  const auto which = section.choice_as<samples::Sequence>("sequence");
  const Eigen::MatrixXd points = samples::unit_points(which, count, reading.choice.axes.size(), seed);
  for (Eigen::Index d = 0; d < own; ++d) {
    const samples::Distribution& distribution = distributions[static_cast<std::size_t>(d)];
    set_values(reading, static_cast<std::size_t>(d),
               points.col(d).unaryExpr([&](double share) { return samples::quantile(distribution, share); }));
  }
  reading.choice.drawn = fmt::format("{} points of {}, seed {}", count, sequence, seed);
  if (joint.mean.size() == 0) return;
  const auto normals =
      samples::correlated_normals(joint.mean, joint.covariance, points.rightCols(joint.mean.size()));
  if (!normals)
    section.fail(rules::wrong_file, "fixed_from", "the covariance in {} is not positive semidefinite",
                 section.text("fixed_from"));
  for (Eigen::Index d = 0; d < normals->cols(); ++d)
    set_values(reading, static_cast<std::size_t>(own + d), normals->col(d));
}

// `from = "samples.csv"`.
void take_table(SampleReading& reading, const std::filesystem::path& folder) {
  const TomlSection& section = reading.section;
  const std::string file = section.text("from");
  try {
    for (SampleColumn& column : read_sample_table(reading.context, reading.study, folder / file, file)) {
      ParameterAxis& added = add_axis(reading, column.axis.parameter);
      added.unit = column.axis.unit;
      added.si_factor = column.axis.si_factor;
      added.values = std::move(column.axis.values);
      reading.study.parameters.list[added.parameter].unit_of_range = column.unit;
      reading.choice.texts.back() = with_unit_of(added, "as listed");
    }
  } catch (const StudyError& error) {
    section.fail(error.rule(), "from", "{}", error.what());
  }
  reading.choice.drawn =
      fmt::format("{} of {}", reading.study.map()->axes[reading.choice.axes.front()].values.size(), file);
}

bool is_of_file(const TomlValue& table) {
  const TomlEntry* from = find_entry(table, "from");
  return from && from->value.as<std::string>();
}

void check_alone(const SampleReading& reading) {
  if (reading.study.map()->samples)
    reading.section.fail_here(rules::given_twice,
                              "a map has one axis of samples; list all uncertain parameters there");
  for (const ParameterAxis& axis : reading.study.map()->axes) {
    if (axis.zip == reading.zip)
      reading.section.fail_here(
          rules::name_taken,
          "its dimension is called \"{}\", like an earlier zip; give it another name by zip", reading.zip);
  }
}

}  // namespace

ParameterAxis& add_axis(SampleReading& reading, std::size_t parameter) {
  ParameterAxis axis;
  axis.parameter = parameter;
  axis.position = reading.section.position();
  axis.zip = reading.zip;
  axis.zip_position = reading.zip_position;
  std::vector<ParameterAxis>& axes = reading.study.map()->axes;
  axes.push_back(std::move(axis));
  reading.choice.axes.push_back(axes.size() - 1);
  reading.choice.texts.emplace_back();
  return axes.back();
}

std::string with_unit_of(const ParameterAxis& axis, const std::string& text) {
  return is_pure_number(axis.unit) ? text : fmt::format("{} ({})", text, axis.unit);
}

// from = "300 rpm" is the start of a range, not a file of samples.
static void refuse_text_for_number(const StudyContext& context, const TomlValue& table) {
  if (!is_of_file(table) || !find_entry(table, "parameter")) return;
  const TomlEntry* from = find_entry(table, "from");
  if (!from) return;
  throw context.source.error_at(rules::wrong_type, from->value.position,
                                "[[axis]]: from: {} is not a number; for a parameter it must be a number in "
                                "the unit of `unit`, for samples a CSV file without `parameter`",
                                described(from->value));
}

bool is_axis_of_samples(const TomlValue& table) {
  return is_of_file(table) || find_entry(table, "samples") || find_entry(table, "of") ||
         find_entry(table, "fixed_from");
}

void read_axis_of_samples(const StudyContext& context, const TomlValue& table, std::size_t number,
                          const std::filesystem::path& folder, DataFiles data, Study& study) {
  const bool of_file = is_of_file(table);
  refuse_text_for_number(context, table);
  const TomlSection section(context.source, table, label(table, "axis", "parameter", "axis", number), "axis",
                            of_file ? "file" : "samples");
  SampleReading reading{
      .context = context,
      .section = section,
      .study = study,
      .zip = section.find("zip") ? section.identifier("zip") : sample_dimension,
      .zip_position = section.find("zip") ? section.require("zip").position : section.position(),
      .choice = {}};
  check_alone(reading);
  if (of_file)
    take_table(reading, folder);
  else
    draw(reading, table, folder, data);
  for (const std::size_t axis : reading.choice.axes) {
    convert_axis(section, study.map()->axes[axis]);
    add_to_grid(section, axis, study);
  }
  reading.choice.dimension = study.map()->dimensions.size() - 1;
  study.map()->samples = std::move(reading.choice);
}

}  // namespace frahm::studies
