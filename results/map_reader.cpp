#include "results/map_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "results/columns.hpp"
#include "results/format.hpp"
#include "results/store_error.hpp"
#include "results/variable_io.hpp"

namespace frahm::results {
namespace {

void check_format(const hdf5::Group& root) {
  if (root.text(format_attribute) != format_name) {
    throw StoreError(root.where(), "must be a Frahm result", "the attribute format = \"frahm\" is not there");
  }
  const auto version = root.numbers(version_attribute);
  if (!version || version->size() != 1 || version->front() > format_version || version->front() < 1) {
    const std::string found = version && version->size() == 1 ? fmt::format("{}", version->front()) : "none";
    throw StoreError(root.where(), "format_version " + found, fmt::format("must be 1 to {}", format_version));
  }
}

std::string required_text(const hdf5::Group& root, const std::string& name) {
  const auto text = root.text(name);
  if (!text) throw StoreError(root.where(), "must have the attribute " + name, "");
  return *text;
}

Coordinate read_coordinate(const hdf5::Dataset& dataset) {
  const Variable variable = described(dataset);
  Coordinate coordinate{variable.name, variable.unit, variable.long_name,
                        dataset.read(Shape{0}, dataset.shape())};
  std::istringstream lines(dataset.text("names").value_or(""));
  for (std::string line; std::getline(lines, line);) coordinate.names.push_back(line);
  return coordinate;
}

Axis read_axis(const hdf5::Dataset& scale) {
  Axis axis{.name = scale.name(), .size = scale.shape().at(0)};
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

MapLayout read_layout(const hdf5::Group& root) {
  MapLayout layout{.title = required_text(root, "title"),
                   .source = required_text(root, "source"),
                   .history = required_text(root, "history")};
  const std::vector<std::string> auxiliary = auxiliary_names(root);
  for (const std::string& name : root.dataset_names()) {
    const hdf5::Dataset dataset = root.dataset(name);
    if (dataset.is_scale()) {
      layout.axes.push_back(read_axis(dataset));
    } else if (std::find(auxiliary.begin(), auxiliary.end(), name) != auxiliary.end()) {
      const std::string axis_name = dataset.scale_name(0);
      const auto axis = std::find_if(layout.axes.begin(), layout.axes.end(),
                                     [&](const Axis& candidate) { return candidate.name == axis_name; });
      if (axis == layout.axes.end()) throw StoreError(dataset.where(), "must lie along an axis", "");
      axis->coordinates.push_back(read_coordinate(dataset));
    } else {
      layout.variables.push_back(described(dataset));
      layout.chunk = dataset.chunk();
    }
  }
  return layout;
}

// Appends the paths of all groups within `group`, whose path is `path` (ends in a slash; root: empty).
void add_groups(const hdf5::Group& group, const std::string& path, std::vector<std::string>& paths) {
  for (const std::string& name : group.group_names()) {
    paths.push_back(path + name);
    add_groups(group.group(name), path + name + '/', paths);
  }
}

}  // namespace

MapReader::MapReader(const std::filesystem::path& path) : file_(hdf5::File::open(path)) {
  const hdf5::Group root = file_.root();
  check_format(root);
  layout_ = read_layout(root);
  Shape shape;
  for (const Axis& axis : layout_.axes) shape.push_back(axis.size);
  for (const Variable& variable : layout_.variables) {
    datasets_.push_back(root.dataset(variable.name));
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

}  // namespace frahm::results
