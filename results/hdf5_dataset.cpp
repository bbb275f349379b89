#include <hdf5.h>
#include <hdf5_hl.h>

#include "results/hdf5.hpp"
#include "results/hdf5_call.hpp"
#include "results/storage.hpp"

namespace frahm::results::hdf5 {
namespace {

static_assert(sizeof(hsize_t) == sizeof(std::uint64_t));

const hsize_t* sizes(std::span<const std::uint64_t> values) {
  return reinterpret_cast<const hsize_t*>(values.data());
}

Handle make_space(const Storage& storage, const std::string& path) {
  const std::string what = "cannot create the data space";
  if (storage.shape.empty()) return Handle(checked(H5Screate(H5S_SCALAR), path, what));
  std::vector<hsize_t> largest(storage.shape.begin(), storage.shape.end());
  if (storage.growing) largest.front() = H5S_UNLIMITED;
  return Handle(checked(
      H5Screate_simple(static_cast<int>(largest.size()), sizes(storage.shape), largest.data()), path, what));
}

void set_filters(hid_t properties, const Storage& storage, const std::string& path) {
  const std::string what = "cannot set up the chunks";
  constexpr unsigned deflate_level = 1;
  checked(H5Pset_chunk(properties, static_cast<int>(storage.chunk.size()), sizes(storage.chunk)), path, what);
  // encode_chunk() writes exactly this pipeline.
  checked(H5Pset_shuffle(properties), path, what);
  checked(H5Pset_deflate(properties, deflate_level), path, what);
  checked(H5Pset_fletcher32(properties), path, what);
}

Handle creation_properties(const Storage& storage, const std::string& path) {
  const std::string what = "cannot set the creation properties";
  Handle properties(checked(H5Pcreate(H5P_DATASET_CREATE), path, what));
  checked(H5Pset_attr_creation_order(properties.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), path,
          what);
  checked(H5Pset_obj_track_times(properties.get(), false), path, what);
  checked(H5Pset_fill_value(properties.get(), numeric_type(storage.type),
                            missing_elements(storage.type, 1).data()),
          path, what);
  if (!storage.chunk.empty()) set_filters(properties.get(), storage, path);
  return properties;
}

// A data space of the file and one of memory for a box of a dataset.
struct Selection {
  Handle file, memory;
};

Selection select_box(hid_t dataset, std::span<const std::uint64_t> start,
                     std::span<const std::uint64_t> count, const std::string& where) {
  const std::string what = "cannot select a box";
  Handle file(checked(H5Dget_space(dataset), where, what));
  if (count.empty()) return {std::move(file), Handle(checked(H5Screate(H5S_SCALAR), where, what))};
  checked(H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, sizes(start), nullptr, sizes(count), nullptr),
          where, what);
  Handle memory(
      checked(H5Screate_simple(static_cast<int>(count.size()), sizes(count), nullptr), where, what));
  return {std::move(file), std::move(memory)};
}

}  // namespace

Type Dataset::type() const {
  const Handle type(checked(H5Dget_type(id()), where_, "cannot read the type"));
  for (const Type known : {Type::float64, Type::float32, Type::int64, Type::int32, Type::flag}) {
    if (H5Tequal(type.get(), numeric_type(known)) > 0) return known;
  }
  throw StoreError(where_, "must be float64, float32, int64, int32 or int8, little-endian", "");
}

bool Dataset::is_numeric() const {
  const Handle type(checked(H5Dget_type(id()), where_, "cannot read the type"));
  const H5T_class_t kind = H5Tget_class(type.get());
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

Shape Dataset::shape() const {
  const Handle space(checked(H5Dget_space(id()), where_, "cannot read the shape"));
  Shape shape(static_cast<std::size_t>(
      checked(H5Sget_simple_extent_ndims(space.get()), where_, "cannot read the shape")));
  checked(H5Sget_simple_extent_dims(space.get(), reinterpret_cast<hsize_t*>(shape.data()), nullptr), where_,
          "cannot read the shape");
  return shape;
}

Shape Dataset::chunk() const {
  const Handle properties(checked(H5Dget_create_plist(id()), where_, "cannot read the chunk shape"));
  if (H5Pget_layout(properties.get()) != H5D_CHUNKED) return {};
  Shape chunk(shape().size());
  checked(H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()),
                       reinterpret_cast<hsize_t*>(chunk.data())),
          where_, "cannot read the chunk shape");
  return chunk;
}

void Dataset::write(std::span<const std::uint64_t> start, std::span<const std::uint64_t> count,
                    std::span<const std::byte> elements) {
  print_no_errors();
  const Selection box = select_box(id(), start, count, where_);
  checked(
      H5Dwrite(id(), numeric_type(type()), box.memory.get(), box.file.get(), H5P_DEFAULT, elements.data()),
      where_, "cannot write");
}

std::vector<double> Dataset::read(std::span<const std::uint64_t> start,
                                  std::span<const std::uint64_t> count) const {
  print_no_errors();
  std::vector<double> values(product(count));
  const Selection box = select_box(id(), start, count, where_);
  checked(H5Dread(id(), H5T_NATIVE_DOUBLE, box.memory.get(), box.file.get(), H5P_DEFAULT, values.data()),
          where_, "cannot read");
  return values;
}

void Dataset::write_chunk(std::span<const std::uint64_t> start, std::span<const std::byte> encoded) {
  print_no_errors();
  constexpr std::uint32_t every_filter_applied = 0;
  checked(
      H5Dwrite_chunk(id(), H5P_DEFAULT, every_filter_applied, sizes(start), encoded.size(), encoded.data()),
      where_, "cannot write a chunk");
}

void Dataset::grow(std::uint64_t size) {
  print_no_errors();
  Shape grown = shape();
  grown.front() = size;
  checked(H5Dset_extent(id(), sizes(grown)), where_, "cannot grow");
}

void Dataset::make_scale() {
  checked(H5DSset_scale(id(), name().c_str()), where_, "cannot make it a scale");
}

bool Dataset::is_scale() const {
  return checked(H5DSis_scale(id()), where_, "cannot tell whether it is a scale") > 0;
}

void Dataset::attach_scale(unsigned axis, const Dataset& scale) {
  checked(H5DSattach_scale(id(), scale.id(), axis), where_, "cannot attach the scale " + scale.name());
}

std::string Dataset::scale_name(unsigned axis) const {
  std::string name;
  const auto visit = [](hid_t, unsigned, hid_t scale, void* text) -> herr_t {
    const ssize_t length = H5Iget_name(scale, nullptr, 0);
    if (length < 0) return -1;
    std::string path(static_cast<std::size_t>(length), '\0');
    if (H5Iget_name(scale, path.data(), path.size() + 1) < 0) return -1;
    *static_cast<std::string*>(text) = path.substr(path.rfind('/') + 1);
    return 1;  // stop: an axis has one scale
  };
  checked(H5DSiterate_scales(id(), axis, nullptr, visit, &name), where_, "cannot find its scales");
  return name;
}

Dataset Group::create_dataset(const std::string& name, const Storage& storage) {
  const std::string path = path_of(name);
  const Handle space = make_space(storage, path);
  const Handle properties = creation_properties(storage, path);
  return Dataset(Handle(checked(H5Dcreate2(id(), name.c_str(), numeric_type(storage.type), space.get(),
                                           H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                                path, "cannot create the dataset")),
                 path);
}

Dataset Group::dataset(const std::string& name) const {
  const std::string path = path_of(name);
  return Dataset(Handle(checked(H5Dopen2(id(), name.c_str(), H5P_DEFAULT), path, "cannot open the dataset")),
                 path);
}

}  // namespace frahm::results::hdf5
