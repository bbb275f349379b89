#include <fmt/core.h>
#include <fmt/ranges.h>
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
  // A single number has no chunks; within the dataset's header it lies under that header's checksum.
  if (storage.shape.empty()) checked(H5Pset_layout(properties.get(), H5D_COMPACT), path, what);
  return properties;
}

constexpr std::uint64_t most_values = std::uint64_t{1} << 40;
constexpr std::uint64_t most_values_of_chunk = std::uint64_t{1} << 28;  // as check(MapLayout) has it
constexpr hssize_t most_uses = 1 << 20;                                 // of a scale; 16 MiB

// { reference to an object, integer }, as H5DSattach_scale writes it.
bool is_reference_list(hid_t type) {
  if (H5Tget_class(type) != H5T_COMPOUND || H5Tget_nmembers(type) != 2) return false;
  return H5Tget_member_class(type, 0) == H5T_REFERENCE && H5Tget_member_class(type, 1) == H5T_INTEGER;
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

// By its attribute, not H5DSis_scale: the high-level library trusts the attribute's size.
bool Dataset::is_scale() const {
  return text("CLASS") == "DIMENSION_SCALE";
}

void Dataset::attach_scale(unsigned axis, const Dataset& scale) {
  checked(H5DSattach_scale(id(), scale.id(), axis), where_, "cannot attach the scale " + scale.name());
}

// From DIMENSION_LIST, which has a list of references for each dimension.
std::vector<std::vector<std::uint64_t>> Dataset::listed_scales() const {
  const std::string what = "cannot read the list of its scales";
  const std::size_t rank = shape().size();
  std::vector<std::vector<std::uint64_t>> scales(rank);
  if (checked(H5Aexists(id(), "DIMENSION_LIST"), where_, what) == 0) return scales;
  const Handle list(checked(H5Aopen(id(), "DIMENSION_LIST", H5P_DEFAULT), where_, what));
  const Handle type(checked(H5Aget_type(list.get()), where_, what));
  const Handle space(checked(H5Aget_space(list.get()), where_, what));
  const Handle expected(checked(H5Tvlen_create(H5T_STD_REF_OBJ), where_, what));
  if (rank == 0 || checked(H5Tequal(type.get(), expected.get()), where_, what) == 0 ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(rank))
    throw StoreError(where_, "its attribute DIMENSION_LIST must be a list of references for each dimension",
                     "");
  std::vector<hvl_t> rows(rank);
  checked(H5Aread(list.get(), expected.get(), rows.data()), where_, what);
  for (std::size_t d = 0; d < rank; ++d) {
    const auto* references = static_cast<const hobj_ref_t*>(rows[d].p);
    scales[d].assign(references, references + rows[d].len);
  }
  checked(H5Dvlen_reclaim(expected.get(), space.get(), H5P_DEFAULT, rows.data()), where_, what);
  return scales;
}

// From REFERENCE_LIST of the scale, pairs of a dataset's address and an axis. DIMENSION_LIST of the dataset
// says the same in lists of variable length, and HDF5 1.10 reads these beyond its buffer where a file is
// damaged.
std::vector<Dataset::Use> Dataset::uses() const {
  const std::string what = "cannot read where it is attached";
  constexpr const char* list_name = "REFERENCE_LIST";
  if (checked(H5Aexists(id(), list_name), where_, what) == 0) return {};
  const Handle attribute(checked(H5Aopen(id(), list_name, H5P_DEFAULT), where_, what));
  const Handle type(checked(H5Aget_type(attribute.get()), where_, what));
  const Handle space(checked(H5Aget_space(attribute.get()), where_, what));
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (!is_reference_list(type.get()) || count < 0 || count > most_uses)
    throw StoreError(where_, "its attribute REFERENCE_LIST must be pairs of a dataset and an axis", "");
  struct Pair {
    hobj_ref_t dataset;
    unsigned axis;
  };
  std::vector<Pair> pairs(static_cast<std::size_t>(count));
  if (pairs.empty()) return {};
  const Handle memory(checked(H5Tcreate(H5T_COMPOUND, sizeof(Pair)), where_, what));
  checked(H5Tinsert(memory.get(), "dataset", HOFFSET(Pair, dataset), H5T_STD_REF_OBJ), where_, what);
  checked(H5Tinsert(memory.get(), "dimension", HOFFSET(Pair, axis), H5T_NATIVE_UINT), where_, what);
  checked(H5Aread(attribute.get(), memory.get(), pairs.data()), where_, what);
  std::vector<Use> uses;
  uses.reserve(pairs.size());
  for (const Pair& pair : pairs) uses.push_back({pair.dataset, pair.axis});
  return uses;
}

// An object reference is the address of the object's header.
std::uint64_t Dataset::address() const {
  H5O_info_t info;
  checked(H5Oget_info2(id(), &info, H5O_INFO_BASIC), where_, "cannot find its place");
  return info.addr;
}

std::uint64_t Dataset::count_chunks() const {
  if (chunk().empty()) return 0;
  const Handle space(checked(H5Dget_space(id()), where_, "cannot read the shape"));
  hsize_t count = 0;
  checked(H5Dget_num_chunks(id(), space.get(), &count), where_, "cannot count its chunks");
  return count;
}

void Dataset::require_chunk(std::span<const std::uint64_t> start) const {
  print_no_errors();
  hsize_t bytes = 0;
  if (H5Dget_chunk_storage_size(id(), sizes(start), &bytes) >= 0 && bytes > 0) return;
  throw StoreError(where_, fmt::format("its chunk at [{}] is missing", fmt::join(start, ", ")), "");
}

std::vector<double> Dataset::read_all() const {
  const Shape extent = shape();
  const std::uint64_t values = product(extent), stored = H5Dget_storage_size(id());
  if (values == 0) return {};
  const Handle type(checked(H5Dget_type(id()), where_, "cannot read the type"));
  // Deflate makes at most 1032 bytes of one; a chunk at the end may be filled with nothing.
  constexpr std::uint64_t most_from_one = 1040;
  if (values * H5Tget_size(type.get()) > most_from_one * stored)
    throw StoreError(where_,
                     fmt::format("{} values do not fit in the {} bytes stored for it", values, stored), "");
  return read(Shape(extent.size(), 0), extent);
}

// The data must lie in the file itself, in an extent and chunks that a result may have.
void Dataset::check_storage() const {
  const std::string what = "cannot read how it is stored";
  const Handle properties(checked(H5Dget_create_plist(id()), where_, what));
  if (checked(H5Pget_external_count(properties.get()), where_, what) > 0)
    throw StoreError(where_, "its data lie in another file", "external storage is not read");
  const H5D_layout_t layout = H5Pget_layout(properties.get());
  if (layout == H5D_VIRTUAL)
    throw StoreError(where_, "its data lie in other files", "virtual datasets are not read");
  const Handle space(checked(H5Dget_space(id()), where_, what));
  if (H5Sget_simple_extent_type(space.get()) == H5S_NULL) throw StoreError(where_, "holds no data", "");
  check_product(shape(), most_values, "values");
  if (layout != H5D_CHUNKED) return;
  const Shape extent = chunk();
  if (extent.empty()) throw StoreError(where_, "is in chunks of no extent", "");
  check_product(extent, most_values_of_chunk, "values in a chunk");
}

// Throws StoreError where the product of an extent is above a limit.
void Dataset::check_product(const Shape& extent, std::uint64_t limit, const char* of) const {
  std::uint64_t left = limit;
  for (const std::uint64_t size : extent) {
    if (size == 0) return;
    left /= size;
  }
  if (left == 0) throw StoreError(where_, fmt::format("has more {} than {}", of, limit), "");
}

Group::Scales Group::scales() const {
  Scales scales;
  for (const std::string& name : dataset_names()) {
    const Dataset scale = dataset(name);
    if (!scale.is_scale()) continue;
    for (const Dataset::Use& use : scale.uses()) scales[{use.dataset, use.axis}] = name;
  }
  return scales;
}

Dataset Group::create_dataset(const std::string& name, const Storage& storage) {
  const std::string path = path_of(name);
  const Handle space = make_space(storage, path);
  const Handle properties = creation_properties(storage, path);
  return Dataset(Handle(checked(H5Dcreate2(id(), name.c_str(), numeric_type(storage.type), space.get(),
                                           H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                                path, "cannot create the dataset"),
                        handle_.failure()),
                 path);
}

Dataset Group::dataset(const std::string& name) const {
  const std::string path = path_of(name);
  if (has(name)) refuse_foreign_link(name);
  Dataset found(Handle(checked(H5Dopen2(id(), name.c_str(), H5P_DEFAULT), path, "cannot open the dataset"),
                       handle_.failure()),
                path);
  found.check_storage();
  return found;
}

}  // namespace frahm::results::hdf5
