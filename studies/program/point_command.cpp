#include "studies/program/point_command.hpp"

#include <fmt/format.h>

#include <iterator>

#include "studies/program/exit_code.hpp"
#include "studies/program/motion_point.hpp"
#include "studies/program/point_report.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/settings.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t intervals_a_period = 512;  // of a history; smooth to the eye with dozens of stops

// A line of names with their units, then a line for each sample with all its digits.
std::string csv(const periodic::History& history, bool dimensionless) {
  std::string text = dimensionless ? "time" : "time [s]";
  for (std::size_t i = 0; i < history.names.size(); ++i)
    text += dimensionless ? fmt::format(",{}", history.names[i])
                          : fmt::format(",{} [{}]", history.names[i], history.units[i]);
  for (std::size_t row = 0; row < history.time.size(); ++row) {
    fmt::format_to(std::back_inserter(text), "\n{:.17g}", history.time[row]);
    for (const auto& column : history.columns)
      fmt::format_to(std::back_inserter(text), ",{:.17g}", column[row]);
  }
  return text + "\n";
}

}  // namespace

void require_responses(const Study& study) {
  const bool over_records = study.tune() && study.tune()->peaks;
  if ((study.kind() != StudyKind::sweep && study.kind() != StudyKind::tune) || over_records) {
    throw StudyError(rules::other_kind, "{}: {} has no periodic response; use frahm run", study.source.name,
                     over_records ? "a tuning over records" : kind_noun(study.kind()));
  }
}

periodic::Path path_of(const Study& study, const std::string& asked) {
  const bool general = study.sweep() != nullptr && study.sweep()->general_path;
  return general || asked == "general" ? periodic::Path::general : periodic::Path::fastest;
}

int point_command(const PointOptions& options, std::ostream& out) {
  if (options.history == "-") {
    throw StudyError(rules::wrong_option,
                     "--history \"-\": the report goes to standard output; name a file for the history");
  }
  Study study = read_study_with(options.study, options.set);
  if (study.transient() && study.map()) return motion_point(options, std::move(study), out);
  require_responses(study);
  std::vector<double> parameters = parameters_at(study, options.at);
  set_crank_orders_at(study, parameters);
  if (options.history) check_output_is_not_input(*options.history, options.study);
  const PointReport report =
      tell_point(study, parameters, path_of(study, options.path),
                 options.history ? intervals_a_period + 1 : 0, options.gradient, options.responses);
  options.json ? print_point_json(study, report, out)
               : print_point(study, report, options.all ? Listing::whole : Listing::excerpt, out);
  if (report.status == "failed" || report.status == "not_periodic") return exit_code::some_failed;
  if (options.history && !report.history) {
    throw StudyError(rules::not_computed, "--history {}: the point is {} and has no time history: {}",
                     options.history->string(), report.status, report.reason);
  }
  if (options.history)
    write_whole_file(*options.history, csv(*report.history, study.dimensionless), Replaces::own_table);
  return exit_code::done;
}

}  // namespace frahm::studies
