#include "results/map_writer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "results/format.hpp"
#include "results/storage.hpp"
#include "results/variable_io.hpp"

namespace frahm::results {
namespace {

// Names of the coordinates that are not dimensions, as CF's attribute `coordinates` lists them.
std::string auxiliary_coordinates(const MapLayout& layout) {
  std::string names;
  for (const Axis& axis : layout.axes) {
    for (const Coordinate& coordinate : axis.coordinates) {
      if (coordinate.name != axis.name) names += (names.empty() ? "" : " ") + coordinate.name;
    }
  }
  return names;
}

void describe_file(hdf5::Group& root, const MapLayout& layout, const std::string& auxiliary) {
  root.write_text("Conventions", "CF-1.10");
  root.write_text("title", layout.title);
  root.write_text("source", layout.source);
  root.write_text("history", layout.history);
  root.write_text(format_attribute, format_name);
  const double version = format_version;
  root.write_numbers(version_attribute, {.name = version_attribute, .type = Type::int32}, {&version, 1});
  if (!auxiliary.empty()) root.write_text("coordinates", auxiliary);
}

// A coordinate, or the index of an axis, along one axis.
hdf5::Dataset write_line(hdf5::Group& root, const Variable& variable, std::span<const double> values) {
  // For an axis of many values several chunks, as HDF5 keeps a chunk as a whole in memory.
  constexpr std::uint64_t most_in_chunk = 1 << 16;
  const Shape size{values.size()}, chunk{std::clamp<std::uint64_t>(values.size(), 1, most_in_chunk)};
  hdf5::Dataset dataset =
      root.create_dataset(variable.name, {.type = variable.type, .shape = size, .chunk = chunk});
  describe(dataset, variable, false);
  dataset.write(Shape{0}, size, to_storage(variable, values));
  return dataset;
}

Variable as_variable(const Coordinate& coordinate) {
  return {.name = coordinate.name, .unit = coordinate.unit, .long_name = coordinate.long_name};
}

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

void write_scale(hdf5::Group& root, const Axis& axis) {
  const auto own = std::find_if(axis.coordinates.begin(), axis.coordinates.end(),
                                [&](const Coordinate& coordinate) { return coordinate.name == axis.name; });
  if (own != axis.coordinates.end()) {
    hdf5::Dataset scale = write_line(root, as_variable(*own), own->values);
    if (!own->names.empty()) scale.write_text("names", joined_lines(own->names));
    scale.make_scale();
    return;
  }
  std::vector<double> index(axis.size);
  std::iota(index.begin(), index.end(), 0.0);
  write_line(root, index_variable(axis.name), index).make_scale();
}

void write_auxiliary_coordinates(hdf5::Group& root, const Axis& axis) {
  const hdf5::Dataset scale = root.dataset(axis.name);
  for (const Coordinate& coordinate : axis.coordinates) {
    if (coordinate.name == axis.name) continue;
    write_line(root, as_variable(coordinate), coordinate.values).attach_scale(0, scale);
  }
}

std::vector<hdf5::Dataset> create_variables(hdf5::Group& group, const MapLayout& layout,
                                            const std::string& auxiliary) {
  const Shape shape = shape_of(layout), chunk = chunk_shape(layout);
  std::vector<hdf5::Dataset> variables;
  for (const Variable& variable : layout.variables) {
    hdf5::Dataset dataset =
        group.create_dataset(variable.name, {.type = variable.type, .shape = shape, .chunk = chunk});
    describe(dataset, variable, true);
    if (!auxiliary.empty()) dataset.write_text("coordinates", auxiliary);
    for (unsigned k = 0; k < shape.size(); ++k) dataset.attach_scale(k, group.dataset(layout.axes[k].name));
    variables.push_back(std::move(dataset));
  }
  return variables;
}

// The axes of a map and its variables, which are returned.
std::vector<hdf5::Dataset> create_axes_and_variables(hdf5::Group& group, const MapLayout& layout,
                                                     const std::string& auxiliary) {
  // All scales before any other coordinate: netCDF orders its dimensions by the creation of their scales.
  for (const Axis& axis : layout.axes) write_scale(group, axis);
  for (const Axis& axis : layout.axes) write_auxiliary_coordinates(group, axis);
  return create_variables(group, layout, auxiliary);
}

}  // namespace

MapWriter::MapWriter(const std::filesystem::path& path, const MapLayout& layout)
    : part_(path), file_(hdf5::File::create((check(layout), part_.part()))) {
  hdf5::Group root = file_.root();
  const std::string auxiliary = auxiliary_coordinates(layout);
  describe_file(root, layout, auxiliary);
  maps_.push_back(create_axes_and_variables(root, layout, auxiliary));
}

std::size_t MapWriter::create_map(const std::string& name, const MapLayout& layout) {
  check(layout);
  hdf5::Group to = group(name);
  const std::string auxiliary = auxiliary_coordinates(layout);
  if (!auxiliary.empty()) to.write_text("coordinates", auxiliary);
  maps_.push_back(create_axes_and_variables(to, layout, auxiliary));
  return maps_.size() - 1;
}

void MapWriter::write_chunk(const EncodedChunk& chunk) {
  write_chunk(0, chunk);
}

void MapWriter::write_chunk(std::size_t map, const EncodedChunk& chunk) {
  if (map >= maps_.size()) {
    throw std::invalid_argument(fmt::format("map {}: must be below {}", map, maps_.size()));
  }
  std::vector<hdf5::Dataset>& variables = maps_[map];
  if (chunk.variables.size() != variables.size()) {
    throw std::invalid_argument(fmt::format("chunk of {} variables: must be {}, those of the map",
                                            chunk.variables.size(), variables.size()));
  }
  for (std::size_t v = 0; v < variables.size(); ++v)
    variables[v].write_chunk(chunk.start, chunk.variables[v]);
}

hdf5::Group MapWriter::group(const std::string& name) {
  hdf5::Group root = file_.root();
  return root.has(name) ? root.group(name) : root.create_group(name);
}

void MapWriter::write_texts(const std::string& name, const std::vector<Text>& texts) {
  hdf5::Group to = group(name);
  for (const auto& [text_name, text] : texts) to.write_text(text_name, text);
}

void MapWriter::write_columns(const std::string& name, const std::vector<Column>& columns) {
  check(columns);
  hdf5::Group to = group(name);
  results::write_columns(to, columns);
}

void MapWriter::write_group(const GroupContent& content) {
  hdf5::Group to = file_.root().create_group(content.path);
  write_content(to, content);
}

std::size_t MapWriter::create_ragged(const RaggedLayout& layout) {
  check(layout);
  tables_.emplace_back(group(layout.group), layout);
  return tables_.size() - 1;
}

void MapWriter::append_ragged(std::size_t table, std::span<const double> row,
                              std::span<const std::vector<double>> samples) {
  if (table >= tables_.size()) {
    throw std::invalid_argument(fmt::format("table {}: must be below {}", table, tables_.size()));
  }
  tables_[table].append(row, samples);
}

void MapWriter::finish() {
  for (RaggedTable& table : tables_) table.flush();
  // HDF5 closes the file with its last object.
  maps_.clear();
  tables_.clear();
  file_.close();
  part_.publish();
}

}  // namespace frahm::results
