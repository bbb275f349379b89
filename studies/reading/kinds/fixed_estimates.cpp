#include "studies/reading/kinds/fixed_estimates.hpp"

#include <fmt/format.h>

#include <cmath>

#include "studies/reading/data_files/earlier_estimates.hpp"
#include "studies/reading/kinds/identify_reading.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

void check_free_to_fix(const IdentifyReading& reading, const EarlierEstimates& earlier, std::size_t i,
                       std::size_t parameter) {
  const IdentifyChoice& choice = reading.choice;
  const auto fail = [&](Rule rule, const std::string& problem) {
    throw StudyError(rule, "{}: the estimate \"{}\" {}", earlier.file, earlier.names[i], problem);
  };
  if (of_parameter(choice.fixed, parameter))
    fail(rules::given_twice, "is also in an earlier file of fixed_from");
  for (const RecordChoice& record : choice.records) {
    if (of_parameter(record.set, parameter))
      fail(rules::given_twice, fmt::format("fixes a parameter that the record \"{}\" sets", record.name));
  }
  if (!std::isfinite(earlier.values[i]))
    fail(rules::wrong_file, "was not determined by its data, so it cannot fix a value");
}

// An estimate of a file for a parameter that is not fitted again: index of the estimate, of the parameter.
struct Taken {
  std::size_t estimate = 0, parameter = 0;
};

std::vector<Taken> taken_from(const IdentifyReading& reading, const EarlierEstimates& earlier) {
  std::vector<Taken> taken;
  const Parameters& parameters = reading.study.parameters;
  for (std::size_t i = 0; i < earlier.names.size(); ++i) {
    const auto index = parameters.find(earlier.names[i]);
    if (!index || !parameters.list[*index].is_number() || of_parameter(reading.choice.parameters, *index))
      continue;
    check_unit(reading.context, earlier, i, parameters.list[*index]);
    check_free_to_fix(reading, earlier, i, *index);
    taken.push_back({i, *index});
  }
  if (!taken.empty()) return taken;
  std::vector<std::string> open;
  for (std::size_t i = 0; i < parameters.list.size(); ++i) {
    if (parameters.list[i].is_number() && !of_parameter(reading.choice.parameters, i))
      open.push_back(parameters.list[i].name);
  }
  throw StudyError(rules::unknown_name,
                   "{}: none of its estimates is a parameter of this study that is a number and not fitted; "
                   "it has {}, the study has {}",
                   earlier.file, earlier.names.empty() ? "none" : listed(earlier.names, " and "),
                   open.empty() ? "none" : listed(open, " and "));
}

// Estimates of different files are independent of each other.
void fix(IdentifyReading& reading, const EarlierEstimates& earlier) {
  IdentifyChoice& choice = reading.choice;
  const std::vector<Taken> taken = taken_from(reading, earlier);
  const std::size_t before = choice.fixed.size();
  for (auto& row : choice.fixed_covariance) row.resize(before + taken.size(), 0.0);
  for (const Taken& each : taken) {
    const double value = earlier.values[each.estimate];
    choice.fixed.push_back({each.parameter, value, earlier.degrees_of_freedom[each.estimate]});
    reading.study.parameters.list[each.parameter].definition = value;
    std::vector<double> row(before, 0.0);
    for (const Taken& other : taken) row.push_back(earlier.covariance[each.estimate][other.estimate]);
    choice.fixed_covariance.push_back(std::move(row));
  }
}

}  // namespace

void read_fixed(IdentifyReading& reading, const TomlSection& identify) {
  const TomlValue& value = identify.require("fixed_from");
  std::vector<const TomlValue*> files{&value};
  if (const auto* list = value.as<TomlArray>()) {
    files.clear();
    for (const TomlValue& item : *list) files.push_back(&item);
    if (files.empty()) identify.fail(rules::empty, "fixed_from", "the list of files is empty");
  }
  for (const TomlValue* item : files) {
    const std::string file = read_text(identify.source(), "[identify]: fixed_from", *item);
    try {
      reading.choice.files.push_back(reading.folder / file);
      fix(reading, read_earlier(reading.folder / file, file));
    } catch (const StudyError& error) {
      throw identify.source().error_at(error.rule(), item->position, "[identify]: fixed_from: {}",
                                       error.what());
    }
  }
}

}  // namespace frahm::studies
