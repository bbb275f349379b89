#include "results/map_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "results/checked_apart.hpp"
#include "results/columns.hpp"
#include "results/data_check.hpp"
#include "results/format.hpp"
#include "results/store_error.hpp"
#include "results/structure_check.hpp"
#include "results/variable_io.hpp"

namespace frahm::results {
namespace {

void check_format(const hdf5::Group& root) {
  if (root.text(format_attribute) != format_name) {
    throw StoreError(root.where(), "must be a Frahm result", "the attribute format = \"frahm\" is missing");
  }
  const auto version = root.numbers(version_attribute);
  if (!version || version->size() != 1 || version->front() > format_version || version->front() < 1) {
    const std::string found = version && version->size() == 1 ? fmt::format("{}", version->front()) : "none";
    throw StoreError(root.where(), "format_version " + found, fmt::format("must be 1 to {}", format_version));
  }
}

// A file that anybody may have made is walked through by a child before this process touches it.
hdf5::File open_checked(const std::filesystem::path& path) {
  check_apart(path, result_check(path));
  return hdf5::File::open(path);
}

std::string required_text(const hdf5::Group& root, const std::string& name) {
  const auto text = root.text(name);
  if (!text) throw StoreError(root.where(), "must have the attribute " + name, "");
  return *text;
}

Coordinate read_coordinate(const hdf5::Dataset& dataset) {
  const Variable variable = described(dataset);
  if (dataset.shape().size() != 1) throw StoreError(dataset.where(), "must have one dimension", "");
  Coordinate coordinate{variable.name, variable.unit, variable.long_name, dataset.read_all()};
  std::istringstream lines(dataset.text("names").value_or(""));
  for (std::string line; std::getline(lines, line);) coordinate.names.push_back(line);
  if (!coordinate.names.empty() && coordinate.names.size() != coordinate.values.size())
    throw StoreError(dataset.where(),
                     fmt::format("{} names of {} values: must be one for each", coordinate.names.size(),
                                 coordinate.values.size()),
                     "");
  return coordinate;
}

Axis read_axis(const hdf5::Dataset& scale) {
  const Shape shape = scale.shape();
  if (shape.size() != 1) throw StoreError(scale.where(), "is an axis and must have one dimension", "");
  Axis axis{.name = scale.name(), .size = shape.front()};
  if (!is_index(scale)) axis.coordinates.push_back(read_coordinate(scale));
  return axis;
}

// The auxiliary coordinates of the map, each along one axis.
std::vector<std::string> auxiliary_names(const hdf5::Group& root) {
  std::istringstream words(root.text("coordinates").value_or(""));
  std::vector<std::string> names;
  for (std::string name; words >> name;) names.push_back(name);
  return names;
}

// The axes, coordinates and variables of a group.
void read_contents(const hdf5::Group& root, MapLayout& layout) {
  const std::vector<std::string> auxiliary = auxiliary_names(root);
  const hdf5::Group::Scales scales = root.scales();
  for (const std::string& name : root.dataset_names()) {
    const hdf5::Dataset dataset = root.dataset(name);
    if (dataset.is_scale()) {
      layout.axes.push_back(read_axis(dataset));
    } else if (std::find(auxiliary.begin(), auxiliary.end(), name) != auxiliary.end()) {
      const auto scale = scales.find({dataset.address(), 0});
      const auto axis = std::find_if(layout.axes.begin(), layout.axes.end(), [&](const Axis& candidate) {
        return scale != scales.end() && candidate.name == scale->second;
      });
      if (axis == layout.axes.end()) throw StoreError(dataset.where(), "must lie along an axis", "");
      axis->coordinates.push_back(read_coordinate(dataset));
    } else {
      layout.variables.push_back(described(dataset));
      layout.chunk = dataset.chunk();
    }
  }
}

// A box of points for readers of a map that is not in chunks (h5repack -l CONTI): rows as they lie in the
// file.
Shape box_of_rows(const Shape& shape) {
  constexpr std::uint64_t most_points = 1 << 16;
  Shape box(shape.size(), 1);
  std::uint64_t points = 1;
  for (std::size_t d = shape.size(); d-- > 0 && points < most_points;) {
    box[d] = std::min(shape[d], std::max<std::uint64_t>(1, most_points / points));
    points *= shape[d];
  }
  return box;
}

// What was read must be what could have been written.
void check_read(const hdf5::Group& group, const MapLayout& layout) {
  try {
    check(layout);
  } catch (const std::invalid_argument& broken) {
    throw StoreError(group.where(), "is not a map of a result", broken.what());
  }
}

// Appends the paths of all groups within `group`, whose path is `path` (ends in a slash; root: empty).
void add_groups(const hdf5::Group& group, const std::string& path, std::vector<std::string>& paths) {
  for (const std::string& name : group.group_names()) {
    paths.push_back(path + name);
    add_groups(group.group(name), path + name + '/', paths);
  }
}

}  // namespace

void check_result(const std::filesystem::path& path) {
  check_structure(path);
  check_format(hdf5::File::open(path).root());
}

MapReader::MapReader(const std::filesystem::path& path) : path_(path), file_(open_checked(path)) {
  const hdf5::Group root = file_.root();
  layout_ = {.title = required_text(root, "title"),
             .source = required_text(root, "source"),
             .history = required_text(root, "history")};
  read_map(root);
}

MapReader::MapReader(const std::filesystem::path& path, const std::string& group)
    : path_(path), file_(open_checked(path)) {
  read_map(file_.root().group(group));
}

void MapReader::read_map(const hdf5::Group& group) {
  read_contents(group, layout_);
  const Shape shape = shape_of(layout_);
  if (layout_.chunk.empty()) layout_.chunk = box_of_rows(shape);
  if (!layout_.axes.empty()) check_read(group, layout_);
  for (const Variable& variable : layout_.variables) {
    datasets_.push_back(group.dataset(variable.name));
    if (datasets_.back().shape() != shape)
      throw StoreError(datasets_.back().where(), "must lie on all axes", "");
  }
}

std::vector<double> MapReader::read(std::size_t variable, std::span<const std::uint64_t> start,
                                    std::span<const std::uint64_t> count) const {
  if (variable >= datasets_.size()) {
    throw std::invalid_argument(fmt::format("variable {}: must be below {}", variable, datasets_.size()));
  }
  check_within(layout_.variables[variable].name, {{start.begin(), start.end()}, {count.begin(), count.end()}},
               datasets_[variable].shape());
  if (product(count) == 0) return {};
  return datasets_[variable].read(start, count);
}

bool MapReader::has_group(const std::string& name) const {
  const hdf5::Group root = file_.root();
  return root.has(name) && !root.has_dataset(name);
}

std::vector<std::string> MapReader::groups() const {
  std::vector<std::string> paths;
  add_groups(file_.root(), "", paths);
  return paths;
}

std::vector<Text> MapReader::texts(const std::string& group) const {
  return file_.root().group(group).texts();
}

std::vector<Column> MapReader::columns(const std::string& group) const {
  return read_columns(file_.root().group(group));
}

void MapReader::check_data(Completeness completeness) const {
  check_apart(path_, scales_check(path_));
  results::check_data(file_.root(), completeness);
}

}  // namespace frahm::results
