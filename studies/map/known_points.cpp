#include "studies/map/known_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "engine/fingerprint.hpp"
#include "engine/io_error.hpp"
#include "results/store_error.hpp"
#include "solvers/orbits/orbit.hpp"
#include "studies/map/earlier_file.hpp"
#include "studies/map/entry_check.hpp"
#include "studies/provenance/fingerprint.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/stored_study.hpp"

namespace frahm::studies {
namespace {

using periodic::QuantityKind;

void refuse_another_physics(const MapPlan& plan, const results::MapReader& earlier,
                            const std::filesystem::path& file) {
  const engine::Fingerprint kept = fingerprint_of(earlier);
  if (kept.physics == plan.fingerprint.physics) return;
  throw engine::ResumeRefused(file, kept, plan.fingerprint,
                              "none of its points can be reused; leave out --from to compute them all");
}

// Samples of a file that is no longer next to the result leave nothing to compare with.
void refuse_other_axes_than_stored(const results::MapReader& earlier, const std::filesystem::path& file,
                                   const std::string& advice) {
  std::optional<StoredStudy> stored;
  try {
    stored = read_stored_study(earlier, file);
  } catch (const StudyError&) {
    return;
  } catch (const engine::IoError&) {
    return;
  }
  refuse_other_axes(stored->study, earlier.layout(), file.string(), advice);
}

std::size_t variable_named(const results::MapLayout& layout, const std::string& name,
                           const std::filesystem::path& file) {
  const auto found = std::ranges::find(layout.variables, name, &results::Variable::name);
  if (found == layout.variables.end())
    throw results::StoreError(file.string() + ":/" + name, "is not in the map, though its study records it",
                              "");
  return static_cast<std::size_t>(std::distance(layout.variables.begin(), found));
}

// The index of a point from its number, row-major.
std::vector<std::uint64_t> index_of(std::uint64_t offset, const results::MapLayout& layout) {
  std::vector<std::uint64_t> index(layout.axes.size());
  for (std::size_t d = index.size(); d-- > 0; offset /= layout.axes[d].size)
    index[d] = offset % layout.axes[d].size;
  return index;
}

}  // namespace

KnownPoints::KnownPoints(const MapPlan& plan, const std::filesystem::path& file)
    : plan_(plan), file_(file), reader_(open_earlier_map(file)) {
  refuse_another_physics(plan, reader_, file);
  source_ = {.file = file.string(), .identity = identity_of(reader_.texts("provenance"))};
  dimensions_ = match_axes(plan.study, reader_.layout(), file.string());
  for (const auto& variable : plan.variables)
    variables_.push_back(variable_named(reader_.layout(), variable.name, file));
  for (std::size_t q = 0; q < plan.variables.size(); ++q) {
    const std::string& name = plan.variables[q].name;
    if (name == "status" || name == "status_compared") statuses_.push_back(q);
    if (name == "status") {
      own_status_ = q;
    } else if (q < plan.own_variables()) {
      answers_.push_back(q);
    }
  }
}

void KnownPoints::take(const MapBox& box, std::span<double> values, std::vector<char>& known) {
  const std::uint64_t points = box.points();
  known.assign(points, 0);
  const std::vector<Found> found = find(box);
  for (auto begin = found.begin(); begin != found.end();) {
    const auto end =
        std::find_if(begin, found.end(), [&](const Found& f) { return f.chunk != begin->chunk; });
    read_chunk({begin, end}, points, values);
    begin = end;
  }
  std::uint64_t taken = 0;
  for (const Found& point : found) {
    if (!is_answer(values, points, point.in_tile)) continue;
    known[point.in_tile] = 1;
    ++taken;
  }
  taken_ += taken;
}

void KnownPoints::check(std::uint64_t first, std::uint64_t step) {
  constexpr const char* advice = "without --from all points are computed again";
  refuse_damage(reader_, advice);
  refuse_other_axes_than_stored(reader_, file_, advice);
  std::vector<double> values;
  std::vector<char> known;
  for (std::uint64_t tile = first; tile < plan_.grid.tiles(); tile += step) {
    const MapBox box = plan_.grid.box(tile);
    values.resize(box.points() * variables_.size());
    take(box, values, known);
  }
  taken_ = 0;
}

// The points of a tile that the earlier map has, in the order of its chunks.
std::vector<KnownPoints::Found> KnownPoints::find(const MapBox& box) const {
  const results::MapLayout& layout = reader_.layout();
  std::vector<std::size_t> dimensions(box.start.size());
  std::iota(dimensions.begin(), dimensions.end(), std::size_t{0});
  std::vector<Found> found;
  std::vector<std::uint64_t> index = box.start;
  std::uint64_t in_tile = 0;
  do {
    Found point{.in_tile = in_tile++};
    bool is_there = true;
    for (std::size_t d = 0; d < dimensions_.size() && is_there; ++d) {
      const std::uint64_t at = dimensions_[d].index[index[dimensions_[d].along]];
      const std::uint64_t size = layout.axes[d].size, chunk = layout.chunk[d];
      is_there = at != EarlierDimension::nowhere;
      point.offset = point.offset * size + at;
      point.chunk = point.chunk * ((size + chunk - 1) / chunk) + at / chunk;
    }
    if (is_there) found.push_back(point);
  } while (next_point(box, dimensions, index));
  std::ranges::stable_sort(found, {}, &Found::chunk);
  return found;
}

// The values of points that lie in one chunk of the earlier map.
void KnownPoints::read_chunk(std::span<const Found> points, std::uint64_t points_of_tile,
                             std::span<double> values) {
  const MapBox box = box_around(points);
  std::vector<std::uint64_t> from(points.size());  // of each point within the box
  for (std::size_t i = 0; i < points.size(); ++i)
    from[i] = box.offset_of(index_of(points[i].offset, reader_.layout()));
  const std::lock_guard turn(reading_);
  for (std::size_t q = 0; q < variables_.size(); ++q) {
    const std::vector<double> read = read_variable(variables_[q], box);
    for (std::size_t i = 0; i < points.size(); ++i) {
      check_possible(q, read[from[i]], points[i]);
      values[q * points_of_tile + points[i].in_tile] = read[from[i]];
    }
  }
}

void KnownPoints::check_possible(std::size_t variable, double value, const Found& point) const {
  const periodic::QuantityDescription& description = plan_.variables[variable];
  if (is_possible(value, description)) return;
  throw results::StoreError(
      fmt::format("{}:/{}[{}]", file_.string(), description.name,
                  fmt::join(index_of(point.offset, reader_.layout()), ",")),
      fmt::format("{} is {}, so its points cannot be reused", value,
                  description.kind == QuantityKind::flag ? "not one of its flags" : "no count"),
      "without --from all points are computed again");
}

std::vector<double> KnownPoints::read_variable(std::size_t variable, const MapBox& box) const {
  try {
    return reader_.read(variable, box.start, box.count);
  } catch (const results::StoreError& error) {
    throw results::StoreError(error.what(), "so its points cannot be reused",
                              "without --from all points are computed again");
  }
}

MapBox KnownPoints::box_around(std::span<const Found> points) const {
  std::vector<std::uint64_t> first = index_of(points.front().offset, reader_.layout()), last = first;
  for (const Found& point : points) {
    const std::vector<std::uint64_t> index = index_of(point.offset, reader_.layout());
    for (std::size_t d = 0; d < index.size(); ++d) {
      first[d] = std::min(first[d], index[d]);
      last[d] = std::max(last[d], index[d]);
    }
  }
  MapBox box{.start = first, .count = last};
  for (std::size_t d = 0; d < first.size(); ++d) box.count[d] = last[d] - first[d] + 1;
  return box;
}

// Whether a point of the earlier map was computed without failure.
bool KnownPoints::is_answer(std::span<const double> values, std::uint64_t points_of_tile,
                            std::uint64_t in_tile) const {
  const auto value = [&](std::size_t variable) { return values[variable * points_of_tile + in_tile]; };
  for (const std::size_t status : statuses_) {
    if (value(status) == static_cast<double>(periodic::Status::not_computed) ||
        value(status) == static_cast<double>(periodic::Status::failed) ||
        value(status) == static_cast<double>(periodic::Status::not_periodic))
      return false;
  }
  if (own_status_ &&
      (answers_.empty() || value(*own_status_) == static_cast<double>(periodic::Status::unbounded)))
    return true;
  return std::ranges::any_of(
      answers_, [&](std::size_t q) { return !periodic::is_missing(plan_.variables[q].kind, value(q)); });
}

}  // namespace frahm::studies
