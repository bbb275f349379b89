#include "studies/program/scatter_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "results/map_reader.hpp"
#include "solvers/algebra/no_value.hpp"
#include "solvers/samples/scatter.hpp"
#include "studies/map/beside_samples.hpp"
#include "studies/map/map_chunks.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/text/decimal_digits.hpp"

namespace frahm::studies {
namespace {

using Index = std::vector<std::uint64_t>;

std::optional<std::size_t> variable_called(const results::MapReader& map, const std::string& name) {
  const auto& variables = map.layout().variables;
  const auto found = std::ranges::find(variables, name, &results::Variable::name);
  if (found == variables.end()) return std::nullopt;
  return static_cast<std::size_t>(found - variables.begin());
}

// The value of a variable at a point; NaN where the group has none of this name.
double value_at(const results::MapReader& map, const std::string& name, const Index& index) {
  const auto variable = variable_called(map, name);
  return variable ? map.read(*variable, index, Index(index.size(), 1)).front() : kNone;
}

// The point at which a variable is largest; nothing where it has no value.
std::optional<Index> largest(const results::MapReader& map, std::size_t variable) {
  std::optional<Index> found;
  double most = -kInfinity;
  Index dimensions;
  for (std::size_t d = 0; d < map.layout().axes.size(); ++d) dimensions.push_back(d);
  for_each_chunk(map.layout(), [&](const MapBox& box) {
    Index index = box.start;
    for (const double value : map.read(variable, box.start, box.count)) {
      if (value > most || (!found && !std::isnan(value))) {
        most = value;
        found = index;
      }
      next_point(box, dimensions, index);
    }
  });
  return found;
}

// " at r=0.9, f=0.1"; of axes that advance together the index.
std::string place_text(const results::MapReader& map, const Index& index) {
  std::string text;
  for (std::size_t d = 0; d < index.size(); ++d) {
    const results::Axis& axis = map.layout().axes[d];
    const auto own = std::ranges::find(axis.coordinates, axis.name, &results::Coordinate::name);
    const bool named = own != axis.coordinates.end();
    text += fmt::format(
        "{}{}={}", d == 0 ? " at " : ", ", axis.name,
        named ? with_unit(to_digits(own->values[index[d]], 6), own->unit) : fmt::format("{}", index[d]));
  }
  return text;
}

void print_estimate(const results::MapReader& map, const std::string& of, const std::string& name,
                    const Index& index, std::ostream& out) {
  fmt::print(out, "  {:<20} {:<14.6g} {:.6g} to {:.6g}\n", name, value_at(map, of, index),
             value_at(map, of + "_low", index), value_at(map, of + "_high", index));
}

// Sorted by their size.
void print_shares(const MapPlan& plan, const results::MapReader& tornado, const std::string& of,
                  const Index& index, std::ostream& out) {
  struct Bar {
    std::string name;
    double by, share;
  };
  const MapChoice& map = *plan.study.map();
  std::vector<Bar> bars;
  for (const std::size_t axis : map.samples->axes) {
    const std::string& name = plan.study.parameters.list[map.axes[axis].parameter].name;
    bars.push_back({name, value_at(tornado, of + "_by_" + name, index),
                    value_at(tornado, of + "_share_" + name, index)});
    if (std::isnan(bars.back().by)) return;  // no derivative there
  }
  std::ranges::sort(bars, std::greater{}, [](const Bar& bar) { return std::abs(bar.by); });
  fmt::print(out, "  to first order       deviation {:.6g}\n",
             value_at(tornado, of + "_first_order_deviation", index));
  for (const Bar& bar : bars)
    fmt::print(out, "    {:<18} {:<+14.6g} {:.3g} % of the variance\n", bar.name, bar.by, 100.0 * bar.share);
}

}  // namespace

void print_samples(const Study& study, std::ostream& out) {
  const MapChoice* map = study.map();
  if (!map || !map->samples) return;
  fmt::print(out, "samples {}\n", map->samples->drawn);
  for (std::size_t p = 0; p < map->samples->axes.size(); ++p) {
    const ParameterAxis& axis = map->axes[map->samples->axes[p]];
    const Eigen::Map<const Eigen::VectorXd> values(axis.values.data(),
                                                   static_cast<Eigen::Index>(axis.values.size()));
    fmt::print(out, "  {:<16} {}; sampled mean {:.6g}, deviation {:.6g}\n",
               study.parameters.list[axis.parameter].name, map->samples->texts[p], samples::means(values)(0),
               std::sqrt(samples::covariance(values)(0, 0)));
  }
}

void print_scatter(const MapPlan& plan, const std::filesystem::path& file, std::ostream& out) {
  const auto& samples = plan.study.map()->samples;
  if (!samples) return;
  const results::MapReader map(file);
  if (!map.has_group(statistics_group)) return;
  const results::MapReader statistics(file, statistics_group);
  const std::string of = headline_of(plan.study);
  const auto worst = variable_called(statistics, of + "_" + quantile_name(samples->quantiles.back()));
  if (!worst) return;
  const auto index = largest(statistics, *worst);
  if (!index) return;
  fmt::print(out, "scatter of {}{}, {} samples (95 % intervals)\n",
             in_brackets(of, statistics.layout().variables[*worst].unit), place_text(statistics, *index),
             value_at(statistics, of + "_samples", *index));
  print_estimate(statistics, of + "_mean", "mean", *index, out);
  fmt::print(out, "  {:<20} {:<14.6g}\n", "deviation", value_at(statistics, of + "_deviation", *index));
  for (const double share : samples->quantiles)
    print_estimate(statistics, of + "_" + quantile_name(share),
                   fmt::format("{:.6g} % quantile", 100.0 * share), *index, out);
  if (map.has_group(tornado_group))
    print_shares(plan, results::MapReader(file, tornado_group), of, *index, out);
}

}  // namespace frahm::studies
