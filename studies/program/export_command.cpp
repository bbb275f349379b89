#include "studies/program/export_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <ostream>

#include "results/map_reader.hpp"
#include "studies/identification/identification_columns.hpp"
#include "studies/identification/identified_study.hpp"
#include "studies/map/beside_samples.hpp"
#include "studies/map/grid.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/tuning/optimum_columns.hpp"
#include "studies/tuning/schedule_table.hpp"
#include "studies/tuning/sweep_study.hpp"

namespace frahm::studies {
namespace {

constexpr std::uint64_t points_at_once = 1 << 15;  // some megabytes of values

std::string header(const results::MapLayout& layout) {
  std::string text;
  const auto add = [&](const std::string& name, const std::string& unit) {
    text += text.empty() ? "" : ",";
    text += in_brackets(name, unit);
  };
  for (const results::Axis& axis : layout.axes) {
    for (const results::Coordinate& coordinate : axis.coordinates) add(coordinate.name, coordinate.unit);
  }
  for (const results::Variable& variable : layout.variables) add(variable.name, variable.unit);
  return text + '\n';
}

bool is_missing(const results::Variable& variable, double value) {
  return std::isnan(value) || (variable.type == results::Type::int32 && value == -1.0);
}

// Writes the points of one box, which lie together in the map's order.
void write_box(const results::MapReader& map, const MapBox& box, std::ostream& out) {
  const results::MapLayout& layout = map.layout();
  std::vector<std::vector<double>> values;
  for (std::size_t v = 0; v < layout.variables.size(); ++v)
    values.push_back(map.read(v, box.start, box.count));
  std::vector<std::size_t> dimensions(layout.axes.size());
  for (std::size_t d = 0; d < dimensions.size(); ++d) dimensions[d] = d;

  std::vector<std::uint64_t> index = box.start;
  std::string text;
  for (std::uint64_t point = 0; point < box.points(); ++point) {
    for (std::size_t d = 0; d < dimensions.size(); ++d) {
      for (const results::Coordinate& coordinate : layout.axes[d].coordinates) {
        fmt::format_to(std::back_inserter(text), "{:.17g},", coordinate.values[index[d]]);
      }
    }
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (!is_missing(layout.variables[v], values[v][point])) {
        fmt::format_to(std::back_inserter(text), "{:.17g}", values[v][point]);
      }
      text += v + 1 < values.size() ? ',' : '\n';
    }
    next_point(box, dimensions, index);
  }
  out << text;
}

// Writes the map in boxes of consecutive points: a box covers whole inner axes, part of the next axis and one
// index of all axes before that.
void write_map(const results::MapReader& map, std::ostream& out) {
  const results::MapLayout& layout = map.layout();
  out << header(layout);
  const std::size_t rank = layout.axes.size();
  MapBox box{std::vector<std::uint64_t>(rank, 0), std::vector<std::uint64_t>(rank, 1)};
  std::uint64_t inner = 1;  // points of one step along axis `cut`
  std::size_t cut = rank;
  while (cut > 0 && inner * layout.axes[cut - 1].size <= points_at_once) inner *= layout.axes[--cut].size;
  for (std::size_t d = cut; d < rank; ++d) box.count[d] = layout.axes[d].size;
  const std::uint64_t step = std::max<std::uint64_t>(1, points_at_once / inner);
  for (bool more = true; more && out;) {
    if (cut > 0) box.count[cut - 1] = std::min(step, layout.axes[cut - 1].size - box.start[cut - 1]);
    write_box(map, box, out);
    more = false;
    for (std::size_t d = cut; d-- > 0 && !more;) {
      box.start[d] += box.count[d];
      more = box.start[d] < layout.axes[d].size;
      if (!more) box.start[d] = 0;
    }
  }
}

// For a ragged group, what a row says next to each of its samples: one table of samples. Others are
// unchanged.
std::vector<results::Column> beside_samples(std::vector<results::Column> columns) {
  const auto is_start = [](const results::Column& each) { return each.variable.name == "row_start"; };
  const auto found = std::ranges::find_if(columns, is_start);
  if (found == columns.end()) return columns;
  const results::Column starts = *found;
  columns.erase(found);
  const auto is_of_samples = [&](const results::Column& each) { return each.dimension != starts.dimension; };
  const auto sample = std::ranges::find_if(columns, is_of_samples);
  const std::size_t samples = sample == columns.end() ? 0 : sample->values.size();
  for (results::Column& column : columns) {
    if (is_of_samples(column)) continue;
    std::vector<double> repeated;
    for (std::size_t row = 0; row < starts.values.size(); ++row) {
      const auto end =
          row + 1 < starts.values.size() ? static_cast<std::size_t>(starts.values[row + 1]) : samples;
      repeated.resize(end, column.values[row]);
    }
    column.values = std::move(repeated);
  }
  return columns;
}

// A flag is a word where it stands in a group.
std::string cell(const results::Variable& variable, double value) {
  if (is_missing(variable, value)) return "";
  const auto flag = std::ranges::find(variable.flags, static_cast<int>(value), &results::Flag::value);
  return flag == variable.flags.end() ? fmt::format("{:.17g}", value) : flag->meaning;
}

// The columns of a group side by side, single numbers in the first row, missing cells empty.
void write_columns(const std::vector<results::Column>& columns, std::ostream& out) {
  std::size_t rows = 0;
  std::string text;
  for (const results::Column& column : columns) {
    rows = std::max(rows, column.values.size());
    text += (text.empty() ? "" : ",") + in_brackets(column.variable.name, column.variable.unit);
  }
  out << text << '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    text.clear();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto& [variable, dimension, values] = columns[c];
      if (c > 0) text += ',';
      if (row < values.size()) text += cell(variable, values[row]);
    }
    out << text << '\n';
  }
}

// A cell that commas, quotes and line feeds stay in.
std::string quoted(const std::string& text) {
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

void write_texts(const std::vector<results::Text>& texts, std::ostream& out) {
  out << "name,text\n";
  for (const auto& [name, text] : texts) out << quoted(name) << ',' << quoted(text) << '\n';
}

void write_group(const results::MapReader& map, const std::string& group, std::ostream& out) {
  std::vector<results::Column> columns = map.columns(group);
  if (columns.empty()) return write_texts(map.texts(group), out);
  write_columns(beside_samples(std::move(columns)), out);
}

// Writes the requested group, otherwise the map, or in a file without a map the motion, optimum or branch.
void write_table(const results::MapReader& map, const std::string& asked, std::ostream& out) {
  if (!asked.empty()) return write_group(map, asked, out);
  const std::string own = own_group(map);
  own.empty() ? write_map(map, out) : write_group(map, own, out);
}

void check_group(const results::MapReader& map, const ExportOptions& options) {
  const std::vector<std::string> groups = map.groups();
  if (options.group.empty() || std::ranges::find(groups, options.group) != groups.end()) return;
  throw StudyError(rules::wrong_option, "--group: {} has no group \"{}\"{}", options.file.string(),
                   options.group, suggestion(options.group, groups));
}

void write_export(const ExportOptions& options, const results::MapReader& map, std::ostream& out) {
  check_group(map, options);
  if (options.group == statistics_group || options.group == tornado_group) {
    const results::MapReader of_group(options.file, options.group);
    if (!of_group.layout().axes.empty()) return write_map(of_group, out);
  }
  if (!options.schedule) return write_table(map, options.group, out);
  out << schedule_table(read_stored_tuning(options.file), options.step);
}

void check_name_of_study(const char* option, const std::filesystem::path& place) {
  if (place.extension() != ".toml")
    throw StudyError(rules::wrong_file, "{} {}: the name of a study must end in .toml", option,
                     place.string());
}

// A study at the optimum of a tuning, with its tables next to it. Whoever has changed one of them since keeps
// them all; some of them alone are of an export that failed.
int write_at_optimum(const ExportOptions& options, std::ostream& out) {
  const bool runs_up = !options.run_up.empty();
  const std::filesystem::path& place = runs_up ? options.run_up : options.sweep;
  check_name_of_study(runs_up ? "--run-up" : "--sweep", place);
  undamaged_result(options.file);
  const auto study_of = runs_up ? run_up_study : sweep_study;
  const SweepStudy sweep = study_of(read_stored_tuning(options.file), place.stem().string());
  refuse_other_text(place, sweep.text);
  for (const auto& [name, csv] : sweep.tables) refuse_other_text(place.parent_path() / name, csv);
  for (const auto& [name, csv] : sweep.tables)
    write_whole_file(place.parent_path() / name, csv, Replaces::own_text);
  write_whole_file(place, sweep.text, Replaces::own_text);
  fmt::print(out, "{}\n", place.string());
  return 0;
}

int write_study(const ExportOptions& options, std::ostream& out) {
  check_name_of_study("--study", options.study);
  undamaged_result(options.file);
  write_whole_file(options.study, identified_study(options.file), Replaces::own_text);
  fmt::print(out, "{}\n", options.study.string());
  return 0;
}

void check_options(const ExportOptions& options) {
  const DataOptions& data = options.data;
  const int asked = int{!options.group.empty()} + int{options.schedule} + int{!options.sweep.empty()} +
                    int{!options.run_up.empty()} + int{!options.study.empty()} + int{!data.output.empty()};
  if (asked > 1)
    throw StudyError(
        rules::wrong_option,
        "--group, --schedule, --sweep, --run-up, --study and --data: only one of them can be given");
  const bool of_data = !data.set.empty() || !data.at.empty() || !data.rate.empty() ||
                       !data.duration.empty() || !data.noise.empty() || !data.columns.empty() ||
                       !data.seed.empty();
  if (of_data && data.output.empty())
    throw StudyError(rules::wrong_option,
                     "--set, --at, --rate, --duration, --noise, --seed and --columns: these need --data");
  if (options.step && !options.schedule) throw StudyError(rules::wrong_option, "--step: it needs --schedule");
  for (const auto& [option, file] :
       {std::pair("--sweep", options.sweep), std::pair("--run-up", options.run_up),
        std::pair("--study", options.study), std::pair("--data", data.output)}) {
    if (!file.empty() && !options.output.empty())
      throw StudyError(rules::wrong_option, "--output: {} already names its file", option);
  }
}

}  // namespace

int export_command(const ExportOptions& options, std::ostream& out) {
  check_options(options);
  if (!options.sweep.empty() || !options.run_up.empty()) return write_at_optimum(options, out);
  if (!options.study.empty()) return write_study(options, out);
  if (!options.data.output.empty()) return export_data(options.file, options.data, out);
  if (options.file.extension() == ".toml" && std::filesystem::exists(options.file))
    throw StudyError(rules::wrong_file,
                     "{0}: is a study; name its result, such as {1}, which frahm run {0} makes, or add "
                     "--data FILE.csv for what sensors would measure",
                     options.file.string(), options.file.stem().string() + ".h5");
  const results::MapReader map = undamaged_result(options.file);
  if (options.output == "-") {
    write_export(options, map, out);
    return 0;
  }
  const std::filesystem::path output =
      options.output.empty() ? std::filesystem::path(options.file).replace_extension(".csv") : options.output;
  check_output_is_not_input(output, options.file);
  write_whole_file(
      output, [&](std::ostream& file) { write_export(options, map, file); }, Replaces::own_table);
  fmt::print(out, "{}\n", output.string());
  return 0;
}

}  // namespace frahm::studies
