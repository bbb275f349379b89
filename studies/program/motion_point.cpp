#include "studies/program/motion_point.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <charconv>
#include <iterator>
#include <sstream>

#include "solvers/mechanics/linear_system.hpp"
#include "studies/motion/motion_columns.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/settings.hpp"

namespace frahm::studies {
namespace {

// What --at says, `record=3` apart from the parameters.
struct Place {
  std::vector<std::string> parameters;
  std::size_t record = 0;
};

Place place_of(const Study& study, const std::vector<std::string>& at) {
  Place place;
  for (const std::string& text : at) {
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
      constexpr std::string_view name = "record=";
      if (!study.map()->records || !part.starts_with(name)) {
        place.parameters.push_back(part);
        continue;
      }
      const std::string_view number = std::string_view(part).substr(name.size());
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), place.record);
      const std::size_t records = study.map()->records->names.size();
      if (error != std::errc{} || end != number.data() + number.size() || place.record >= records)
        throw StudyError(rules::wrong_option, "--at \"{}\": must be a whole number from 0 to {}", part,
                         records - 1);
    }
  }
  return place;
}

std::string csv(const Study& study, const transient::ForcedMotion& motion) {
  MotionColumns made(study);
  made.add_samples(motion.history);
  const std::vector<results::Column> columns = made.take();
  std::string text;
  for (const results::Column& column : columns) {
    const results::Variable& variable = column.variable;
    text += fmt::format("{}{}", text.empty() ? "" : ",", variable.name);
    if (!study.dimensionless) text += fmt::format(" [{}]", variable.unit);
  }
  for (std::size_t row = 0; row < motion.history.time.size(); ++row) {
    const char* before = "\n";
    for (const results::Column& column : columns) {
      fmt::format_to(std::back_inserter(text), "{}{:.17g}", before, column.values[row]);
      before = ",";
    }
  }
  return text + "\n";
}

void refuse_options_of_orbits(const PointOptions& options) {
  const auto refuse = [](const char* option) {
    throw StudyError(rules::wrong_option, "{}: it needs a periodic response, but the point is a motion",
                     option);
  };
  if (options.gradient) refuse("--gradient");
  if (options.responses) refuse("--responses");
  if (options.json) refuse("--json");
}

}  // namespace

int motion_point(const PointOptions& options, Study study, std::ostream& out) {
  refuse_options_of_orbits(options);
  const Place place = place_of(study, options.at);
  std::vector<double> parameters = parameters_at(study, place.parameters);
  set_crank_orders_at(study, parameters);
  if (options.history) check_output_is_not_input(*options.history, options.study);
  std::string failure;
  transient::ForcedMotion motion;
  try {
    motion = motion_at(study, parameters, place.record, forced_options(study, parameters));
    failure = motion.failure;
  } catch (const mechanics::MechanicsError& error) {
    failure = error.what();
  }
  if (!failure.empty()) {
    fmt::print(out, "{:<22} failed: {}\n", "status", failure);
    return exit_code::some_failed;
  }
  print_transient(study, motion, out);
  if (options.history) write_whole_file(*options.history, csv(study, motion), Replaces::own_table);
  return exit_code::done;
}

}  // namespace frahm::studies
