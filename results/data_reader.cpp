#include "results/data_reader.hpp"

#include <fmt/core.h>

#include <limits>

#include "results/store_error.hpp"

namespace frahm::results {
namespace {

constexpr std::size_t most_names_listed = 12;  // a longer list hides what it should show

// The parts of a path between its slashes.
std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  while (from <= path.size()) {
    const std::size_t slash = std::min(path.find('/', from), path.size());
    if (slash > from) parts.push_back(path.substr(from, slash - from));
    from = slash + 1;
  }
  return parts;
}

[[noreturn]] void fail_missing(const hdf5::Group& group, const std::string& name) {
  const std::vector<std::string> names = group.link_names();
  std::string known;
  for (std::size_t i = 0; i < names.size() && i < most_names_listed; ++i)
    known += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > most_names_listed) known += ", ...";
  throw StoreError(group.where(), fmt::format("has no \"{}\"", name),
                   names.empty() ? "it is empty" : "there are " + known);
}

void check_form(const hdf5::Dataset& dataset) {
  if (!dataset.is_numeric()) throw StoreError(dataset.where(), "must be numbers", "");
  const std::size_t dimensions = dataset.shape().size();
  if (dimensions != 1)
    throw StoreError(dataset.where(), fmt::format("has {} dimensions: must have one", dimensions), "");
  for (const char* packing : {"scale_factor", "add_offset"}) {
    if (dataset.numbers(packing))
      throw StoreError(dataset.where(), fmt::format("is packed by {}: must be plain numbers", packing), "");
  }
}

}  // namespace

DataReader::DataReader(const std::filesystem::path& path) : file_(hdf5::File::open(path)) {}

DataColumn DataReader::read(const std::string& dataset) const {
  const std::vector<std::string> parts = parts_of(dataset);
  hdf5::Group group = file_.root();
  if (parts.empty()) throw StoreError(group.where(), "is a group: a dataset is needed", "");
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if (!group.has(parts[i]) || group.has_dataset(parts[i])) fail_missing(group, parts[i]);
    group = group.group(parts[i]);
  }
  if (!group.has_dataset(parts.back())) fail_missing(group, parts.back());
  const hdf5::Dataset found = group.dataset(parts.back());
  check_form(found);
  DataColumn column;
  const Shape shape = found.shape();
  if (shape.front() > 0) column.values = found.read(Shape{0}, shape);
  column.unit = found.text("units");
  if (const auto missing = found.numbers("_FillValue"); missing && missing->size() == 1) {
    for (double& value : column.values) {
      if (value == missing->front()) value = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return column;
}

}  // namespace frahm::results
