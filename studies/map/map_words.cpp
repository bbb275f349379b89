#include "studies/map/map_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "studies/map/beside_samples.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {
namespace {

constexpr const char* failed_points_text = "failed_points";
constexpr const char* modes_group = "modes";

// A unit in which numbers were written, and the one in which they are to be.
struct OtherUnit {
  std::string unit;
  double factor = 1.0;  // of the numbers
};

std::optional<OtherUnit> other_unit(const UsualUnit& kept, const UsualUnit& now) {
  if (kept.text == now.text && kept.si_factor == now.si_factor) return std::nullopt;
  return OtherUnit{now.text.empty() ? "1" : now.text, kept.si_factor / now.si_factor};
}

// The words of variables, found by their names: a table names a parameter as the axes do.
class MapWords {
 public:
  MapWords(const MapPlan& plan, const Study& kept)
      : frequency_(other_unit(frequency_unit_in_file(kept), frequency_unit_in_file(plan.study))) {
    for (const results::Axis& axis : map_layout(plan, {}).axes)
      for (const results::Coordinate& each : axis.coordinates) coordinates_[each.name] = each;
    for (std::size_t p = 0; p < plan.study.parameters.list.size(); ++p) {
      const std::string& name = plan.study.parameters.list[p].name;
      const auto before = kept.parameters.find(name);
      if (!before) continue;
      if (const auto other = other_unit(usual_unit(kept, *before), usual_unit(plan.study, p)))
        parameters_[name] = *other;
    }
  }

  std::optional<results::Words> operator()(const std::string& group,
                                           const results::Variable& variable) const {
    if (group.empty() || group == statistics_group || group == tornado_group) return on_axes(variable);
    if (const auto found = parameters_.find(variable.name); found != parameters_.end())
      return in(found->second, variable);
    return frequency_ && is_frequency(group, variable.name) ? std::optional(in(*frequency_, variable))
                                                            : std::nullopt;
  }

 private:
  std::optional<results::Words> on_axes(const results::Variable& variable) const {
    const auto found = coordinates_.find(variable.name);
    if (found == coordinates_.end() || variable.type != results::Type::float64) return std::nullopt;
    const results::Coordinate& as = found->second;
    return results::Words{.unit = as.unit, .long_name = as.long_name, .values = as.values};
  }

  static results::Words in(const OtherUnit& other, const results::Variable& variable) {
    return {.unit = other.unit, .long_name = variable.long_name, .factor = other.factor};
  }

  // In the unit of the excitation frequency (results/FORMAT.md).
  static bool is_frequency(const std::string& group, const std::string& name) {
    if (group == modes_group) return name == "mode_frequency";
    return group == "resonance" && (name.ends_with("_resonance_frequency") ||
                                    name.ends_with("_half_power_low") || name.ends_with("_half_power_high"));
  }

  std::map<std::string, results::Coordinate> coordinates_;
  std::map<std::string, OtherUnit> parameters_;
  std::optional<OtherUnit> frequency_;
};

// The lines "<point as --at takes it>: <reason>" with the points in the units of the study now.
std::string failed_points_now(const MapPlan& plan, const Study& kept, const std::string& lines) {
  std::vector<std::string> all;
  std::map<std::string, std::size_t> line_of;  // by the point
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    line_of.emplace(line.substr(0, line.find(": ")), all.size());
    all.push_back(line);
  }
  MapBox grid{.start = std::vector<std::uint64_t>(plan.study.map()->dimensions.size(), 0), .count = {}};
  for (const GridDimension& dimension : plan.study.map()->dimensions) grid.count.push_back(dimension.size);
  std::vector<std::size_t> dimensions(grid.count.size());
  std::iota(dimensions.begin(), dimensions.end(), std::size_t{0});
  std::vector<std::uint64_t> index = grid.start;
  do {
    const auto found = line_of.find(point_text(kept, index));
    if (found == line_of.end()) continue;
    std::string& line = all[found->second];
    line = point_text(plan.study, index) + line.substr(found->first.size());
  } while (next_point(grid, dimensions, index));
  return fmt::format("{}", fmt::join(all, "\n"));
}

}  // namespace

results::Rewording words_of_map(const MapPlan& plan, const Study& kept, const results::MapReader& file) {
  results::Rewording words{
      .title = map_layout(plan, {}).title, .texts = {}, .words_of = MapWords(plan, kept)};
  const std::vector<std::uint64_t> first(plan.study.map()->dimensions.size(), 0);
  if (point_text(plan.study, first) == point_text(kept, first)) return words;  // the axes have their units
  if (file.has_group(modes_group))
    words.texts.push_back({modes_group, {{"point", point_text(plan.study, first)}}});
  if (const std::string failed = provenance_text(file, failed_points_text); !failed.empty())
    words.texts.push_back({"provenance", {{failed_points_text, failed_points_now(plan, kept, failed)}}});
  return words;
}

}  // namespace frahm::studies
