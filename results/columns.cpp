#include "results/columns.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "results/store_error.hpp"
#include "results/variable_io.hpp"

namespace frahm::results {
namespace {

constexpr std::uint64_t column_chunk = 4096;  // [values], 32 KiB of doubles

hdf5::Dataset create_column(hdf5::Group& group, const Variable& variable, bool is_scale) {
  hdf5::Dataset dataset = group.create_dataset(
      variable.name, {.type = variable.type, .shape = {0}, .chunk = {column_chunk}, .growing = true});
  if (is_scale) dataset.make_scale();
  describe(dataset, variable, !is_scale);
  return dataset;
}

void write_number(hdf5::Group& group, const Column& column) {
  hdf5::Dataset dataset = group.create_dataset(column.variable.name, {.type = column.variable.type});
  describe(dataset, column.variable, true);
  dataset.write({}, {}, to_storage(column.variable, column.values));
}

std::string dimension_of(const hdf5::Dataset& dataset, const hdf5::Group::Scales& scales) {
  if (dataset.is_scale()) return dataset.name();
  const auto scale = scales.find({dataset.address(), 0});
  if (scale == scales.end()) throw StoreError(dataset.where(), "must lie along a dimension of its group", "");
  return scale->second;
}

// Row i has the samples from row_start[i] on: these must be in order, and within the samples.
void check_row_starts(const hdf5::Group& group, const std::vector<Column>& columns) {
  const auto starts =
      std::ranges::find(columns, "row_start", [](const Column& c) { return c.variable.name; });
  if (starts == columns.end()) return;
  const auto samples = std::ranges::find_if(columns, [&](const Column& column) {
    return !column.dimension.empty() && column.dimension != starts->dimension;
  });
  double least = 0.0;
  const double most = samples == columns.end() ? 0.0 : static_cast<double>(samples->values.size());
  for (const double start : starts->values) {
    if (!(start >= least && start <= most))
      throw StoreError(fmt::format("{}/row_start", group.where()),
                       fmt::format("{} must be from {} to {}", start, least, most), "");
    least = start;
  }
}

// What was read must be what could have been written.
void check_read(const hdf5::Group& group, const std::vector<Column>& columns) {
  try {
    check(columns);
  } catch (const std::invalid_argument& broken) {
    throw StoreError(group.where(), "is not a group of a result", broken.what());
  }
  check_row_starts(group, columns);
}

void write_along(hdf5::Group& group, const std::string& dimension, const std::vector<Column>& columns,
                 std::size_t size) {
  const auto own = std::find_if(columns.begin(), columns.end(),
                                [&](const Column& column) { return column.variable.name == dimension; });
  std::vector<double> index(size);
  std::iota(index.begin(), index.end(), 0.0);
  GrowingColumn scale(group, own == columns.end() ? index_variable(dimension) : own->variable);
  scale.append(own == columns.end() ? index : own->values);
  scale.flush();
  for (const Column& column : columns) {
    if (column.dimension != dimension || column.variable.name == dimension) continue;
    GrowingColumn along(group, column.variable, dimension);
    along.append(column.values);
    along.flush();
  }
}

}  // namespace

GrowingColumn::GrowingColumn(hdf5::Group& group, const Variable& variable)
    : dataset_(create_column(group, variable, true)), variable_(variable) {}

GrowingColumn::GrowingColumn(hdf5::Group& group, const Variable& variable, const std::string& scale)
    : dataset_(create_column(group, variable, false)), variable_(variable) {
  dataset_.attach_scale(0, group.dataset(scale));
}

void GrowingColumn::append(std::span<const double> values) {
  const Bytes stored = to_storage(variable_, values);
  waiting_.insert(waiting_.end(), stored.begin(), stored.end());
  const std::uint64_t waiting = waiting_.size() / element_size(variable_.type);
  if (waiting >= column_chunk) write(waiting / column_chunk * column_chunk);
}

void GrowingColumn::flush() {
  if (!waiting_.empty()) write(waiting_.size() / element_size(variable_.type));
}

void GrowingColumn::write(std::uint64_t count) {
  dataset_.grow(written_ + count);
  dataset_.write(Shape{written_}, Shape{count}, waiting_);
  written_ += count;
  waiting_.erase(waiting_.begin(),
                 waiting_.begin() + static_cast<std::ptrdiff_t>(count * element_size(variable_.type)));
}

void write_columns(hdf5::Group& group, const std::vector<Column>& columns) {
  std::vector<std::string> dimensions;  // in order of appearance
  for (const Column& column : columns) {
    if (column.dimension.empty()) {
      write_number(group, column);
    } else if (std::find(dimensions.begin(), dimensions.end(), column.dimension) == dimensions.end()) {
      dimensions.push_back(column.dimension);
      write_along(group, column.dimension, columns, column.values.size());
    }
  }
}

void write_content(hdf5::Group& group, const GroupContent& content) {
  check(content.columns);
  write_columns(group, content.columns);
  for (const auto& [name, text] : content.texts) group.write_text(name, text);
}

std::vector<Column> read_columns(const hdf5::Group& group) {
  std::vector<Column> columns;
  const hdf5::Group::Scales scales = group.scales();
  bool is_map = false;  // of several dimensions: then the values of each are reported row after row
  for (const std::string& name : group.dataset_names()) {
    const hdf5::Dataset dataset = group.dataset(name);
    if (is_index(dataset)) continue;
    Column column{.variable = described(dataset)};
    const std::size_t dimensions = dataset.shape().size();
    if (dimensions > 0) column.dimension = dimension_of(dataset, scales);
    is_map = is_map || dimensions > 1;
    column.values = dataset.read_all();
    columns.push_back(std::move(column));
  }
  if (!is_map) check_read(group, columns);
  return columns;
}

RaggedTable::RaggedTable(hdf5::Group group, const RaggedLayout& layout)
    : group_(std::move(group)), layout_(layout) {
  row_columns_.emplace_back(group_, index_variable(layout.row));
  for (const Variable& variable : layout.row_variables)
    row_columns_.emplace_back(group_, variable, layout.row);
  if (layout.sample.empty()) return;
  const Variable row_start{.name = "row_start",
                           .unit = "1",
                           .long_name = fmt::format("index along {} of the first of the row", layout.sample),
                           .type = Type::int64};
  row_columns_.emplace_back(group_, row_start, layout.row);
  sample_columns_.emplace_back(group_, index_variable(layout.sample));
  for (const Variable& variable : layout.sample_variables) {
    sample_columns_.emplace_back(group_, variable, layout.sample);
  }
}

void RaggedTable::append(std::span<const double> row, std::span<const std::vector<double>> samples) {
  if (row.size() != layout_.row_variables.size() || samples.size() != layout_.sample_variables.size()) {
    throw std::invalid_argument(fmt::format(
        "group '{}': {} numbers and {} stretches of samples: must be {} and {}", layout_.group, row.size(),
        samples.size(), layout_.row_variables.size(), layout_.sample_variables.size()));
  }
  const std::size_t count = samples.empty() ? 0 : samples.front().size();
  for (const std::vector<double>& stretch : samples) {
    if (stretch.size() != count) {
      throw std::invalid_argument(
          fmt::format("group '{}': stretches of {} and {} samples in one row: must be equal", layout_.group,
                      count, stretch.size()));
    }
  }
  const auto append_one = [](GrowingColumn& column, double value) { column.append({&value, 1}); };
  append_one(row_columns_.front(), static_cast<double>(rows_++));
  for (std::size_t k = 0; k < row.size(); ++k) append_one(row_columns_[k + 1], row[k]);
  if (layout_.sample.empty()) return;
  append_one(row_columns_.back(), static_cast<double>(sample_count_));
  std::vector<double> index(count);
  std::iota(index.begin(), index.end(), static_cast<double>(sample_count_));
  sample_columns_.front().append(index);
  for (std::size_t k = 0; k < samples.size(); ++k) sample_columns_[k + 1].append(samples[k]);
  sample_count_ += count;
}

void RaggedTable::flush() {
  for (GrowingColumn& column : row_columns_) column.flush();
  for (GrowingColumn& column : sample_columns_) column.flush();
}

}  // namespace frahm::results
