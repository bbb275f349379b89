#include "results/data_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "results/checked_apart.hpp"
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

void check_form(const hdf5::Dataset& dataset, std::size_t needed) {
  if (!dataset.is_numeric()) throw StoreError(dataset.where(), "must be numbers", "");
  const std::size_t dimensions = dataset.shape().size();
  if (dimensions != needed)
    throw StoreError(dataset.where(),
                     fmt::format("has {} dimensions: must have {}", dimensions, needed == 1 ? "one" : "two"),
                     "");
  for (const char* packing : {"scale_factor", "add_offset"}) {
    if (dataset.numbers(packing))
      throw StoreError(dataset.where(), fmt::format("is packed by {}: must be plain numbers", packing), "");
  }
}

// A file that anybody may have made is first read by a child.
hdf5::File open_foreign(const std::filesystem::path& path) {
  check_apart(path, opening_check(path));
  return hdf5::File::open(path);
}

hdf5::Dataset find(const hdf5::File& file, const std::string& dataset, std::size_t dimensions) {
  const std::vector<std::string> parts = parts_of(dataset);
  hdf5::Group group = file.root();
  if (parts.empty()) throw StoreError(group.where(), "is a group: a dataset is needed", "");
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if (!group.has(parts[i]) || group.has_dataset(parts[i])) fail_missing(group, parts[i]);
    group = group.group(parts[i]);
  }
  if (!group.has_dataset(parts.back())) fail_missing(group, parts.back());
  hdf5::Dataset found = group.dataset(parts.back());
  check_form(found, dimensions);
  return found;
}

std::vector<double> numbers_of(const hdf5::Dataset& dataset) {
  std::vector<double> values = dataset.read_all();
  if (const auto missing = dataset.numbers("_FillValue"); missing && missing->size() == 1)
    std::ranges::replace(values, missing->front(), std::numeric_limits<double>::quiet_NaN());
  return values;
}

}  // namespace

void check_opening(const std::filesystem::path& path) {
  hdf5::File::open(path).root();
}

void check_dataset(const std::filesystem::path& path, const std::string& dataset, std::size_t dimensions) {
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Dataset found = find(file, dataset, dimensions);
  numbers_of(found);
  found.text("units");
}

DataReader::DataReader(const std::filesystem::path& path) : path_(path), file_(open_foreign(path)) {}

DataColumn DataReader::read(const std::string& dataset) const {
  check_apart(path_, dataset_check(path_, dataset, 1));
  const hdf5::Dataset found = find(file_, dataset, 1);
  return {numbers_of(found), found.text("units")};
}

DataMatrix DataReader::read_matrix(const std::string& dataset) const {
  check_apart(path_, dataset_check(path_, dataset, 2));
  const hdf5::Dataset found = find(file_, dataset, 2);
  const Shape shape = found.shape();
  return {shape[0], shape[1], numbers_of(found)};
}

}  // namespace frahm::results
