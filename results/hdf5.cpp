#include "results/hdf5.hpp"

#include <fmt/core.h>
#include <hdf5.h>

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "results/hdf5_call.hpp"
#include "results/storage.hpp"
#include "results/utf8.hpp"

namespace frahm::results::hdf5 {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

// The deepest entry of HDF5's error stack states the cause ("No such file or directory"). Takes the entries
// off: HDF5 does not free those of a thread that ends.
std::string take_deepest_error() {
  std::string cause;
  const auto visit = [](unsigned depth, const H5E_error2_t* error, void* text) -> herr_t {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &cause);
  H5Eclear2(H5E_DEFAULT);
  return cause.substr(0, cause.find(", buf = "));  // without memory addresses
}

// netCDF-4 orders its dimensions, variables and attributes by creation.
constexpr unsigned in_creation_order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

void order_by_creation(hid_t properties, const std::string& where) {
  checked(H5Pset_link_creation_order(properties, in_creation_order), where,
          "cannot track the order of links");
  checked(H5Pset_attr_creation_order(properties, in_creation_order), where,
          "cannot track the order of attributes");
  // No modification times: the same data give the same bytes.
  checked(H5Pset_obj_track_times(properties, false), where, "cannot leave out times");
}

Handle file_access(const std::string& path) {
  // This must be the first HDF5 call: HDF5 must not clean up at the program's exit. Our handles have closed
  // everything by then, and after a full disk HDF5's own attempt ends in a segmentation fault. (Further calls
  // do nothing.)
  H5dont_atexit();
  print_no_errors();
  Handle access(checked(H5Pcreate(H5P_FILE_ACCESS), path, "cannot open"));
  // V18 stores texts above 64 KiB as attributes; nothing newer than 1.10 is needed to read the file.
  checked(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V18, H5F_LIBVER_V110), path,
          "cannot set the file version");
  // A file is written next to its name by one process and only then renamed, so HDF5's lock guards nothing;
  // on network file systems without locks it would fail.
  checked(H5Pset_file_locking(access.get(), false, true), path, "cannot switch locks off");
  return access;
}

// A file that this process has open already, as a dataset in Python, HDF5 would not open but share, if only
// both ask for the same locks and the same way of closing; it knows a file by its inode and by the driver
// that reads it. The driver with a log, of which none is kept, is the usual one under another name: so ours
// is a file of its own.
void keep_to_ourselves(const Handle& access, const std::string& path) {
  checked(H5Pset_fapl_log(access.get(), nullptr, 0, 0), path, "cannot open");
}

Handle string_type(std::size_t size, const std::string& where) {
  Handle type(checked(H5Tcopy(H5T_C_S1), where, "cannot make a string type"));
  checked(H5Tset_size(type.get(), std::max<std::size_t>(size, 1)), where, "cannot make a string type");
  checked(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), where, "cannot make a string type");
  checked(H5Tset_cset(type.get(), H5T_CSET_UTF8), where, "cannot make a string type");
  return type;
}

Handle open_attribute(hid_t object, const std::string& name, const std::string& where) {
  return Handle(checked(H5Aopen(object, name.c_str(), H5P_DEFAULT), where, "cannot read attribute " + name));
}

// A text of a result is that of a study, 1 MiB, or a list of failed points.
constexpr std::size_t longest_attribute = std::size_t{64} << 20;  // [bytes]

// For an attribute of `elements` of a type.
void check_size(hid_t type, hssize_t elements, const std::string& where) {
  const std::size_t size = H5Tget_size(type);
  if (size > 0 && elements >= 0 && static_cast<std::size_t>(elements) <= longest_attribute / size) return;
  throw StoreError(where, "has an attribute above 64 MiB", "");
}

// The text of an attribute of variable-length strings, as h5py and others write them.
std::string variable_text_of(hid_t attribute, hid_t type, const std::string& where) {
  char* text = nullptr;
  checked(H5Aread(attribute, type, static_cast<void*>(&text)), where, "cannot read an attribute");
  std::string copy = text ? text : "";
  H5free_memory(text);
  return copy;
}

// The text of an attribute that is a single string.
std::optional<std::string> text_of(hid_t attribute, const std::string& where) {
  const Handle type(checked(H5Aget_type(attribute), where, "cannot read an attribute"));
  const Handle space(checked(H5Aget_space(attribute), where, "cannot read an attribute"));
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1)
    return std::nullopt;
  if (H5Tis_variable_str(type.get()) > 0) return variable_text_of(attribute, type.get(), where);
  check_size(type.get(), 1, where);
  std::string text(H5Tget_size(type.get()), '\0');
  checked(H5Aread(attribute, type.get(), text.data()), where, "cannot read an attribute");
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

}  // namespace

void print_no_errors() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void fail(const std::string& where, const std::string& what) {
  throw StoreError(where, what, take_deepest_error());
}

std::int64_t numeric_type(Type type) {
  switch (type) {
    case Type::float64:
      return H5T_IEEE_F64LE;
    case Type::float32:
      return H5T_IEEE_F32LE;
    case Type::int64:
      return H5T_STD_I64LE;
    case Type::int32:
      return H5T_STD_I32LE;
    case Type::flag:
      return H5T_STD_I8LE;
  }
  throw std::logic_error("unknown results::Type");
}

Handle& Handle::operator=(Handle&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(failure_, other.failure_);
  return *this;
}

// A destructor cannot throw: File::close() reports the failure.
Handle::~Handle() {
  if (id_ < 0 || H5Idec_ref(id_) >= 0 || !failure_ || !failure_->empty()) return;
  *failure_ = take_deepest_error();
  if (failure_->empty()) *failure_ = "an object could not be closed";
}

std::int64_t Handle::release() noexcept {
  return std::exchange(id_, -1);
}

std::string Object::name() const {
  return where_.substr(where_.rfind('/') + 1);
}

void Object::write_text(const std::string& name, const std::string& text) {
  check_utf8(name, text);
  const std::string what = "cannot write attribute " + name;
  const Handle type = string_type(text.size(), where_);
  const Handle space(checked(H5Screate(H5S_SCALAR), where_, what));
  const Handle attribute(checked(
      H5Acreate2(id(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), where_, what));
  checked(H5Awrite(attribute.get(), type.get(), text.c_str()), where_,
          what);  // c_str(): one byte even if empty
}

void Object::replace_text(const std::string& name, const std::string& text) {
  const std::string what = "cannot replace attribute " + name;
  if (checked(H5Aexists(id(), name.c_str()), where_, what) > 0)
    checked(H5Adelete(id(), name.c_str()), where_, what);
  write_text(name, text);
}

void Object::write_numbers(const std::string& name, const Variable& as, std::span<const double> values) {
  const std::string what = "cannot write attribute " + name;
  const hid_t type = numeric_type(as.type);
  const hsize_t size = values.size();
  const Handle space(checked(H5Screate_simple(1, &size, nullptr), where_, what));
  const Handle attribute(
      checked(H5Acreate2(id(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), where_, what));
  checked(H5Awrite(attribute.get(), type, to_storage(as, values).data()), where_, what);
}

std::optional<std::string> Object::text(const std::string& name) const {
  if (checked(H5Aexists(id(), name.c_str()), where_, "cannot look for attribute " + name) == 0)
    return std::nullopt;
  return text_of(open_attribute(id(), name, where_).get(), where_);
}

std::optional<std::vector<double>> Object::numbers(const std::string& name) const {
  const std::string what = "cannot read attribute " + name;
  if (checked(H5Aexists(id(), name.c_str()), where_, what) == 0) return std::nullopt;
  const Handle attribute = open_attribute(id(), name, where_);
  const Handle space(checked(H5Aget_space(attribute.get()), where_, what));
  const Handle type(checked(H5Aget_type(attribute.get()), where_, what));
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT)
    throw StoreError(where_, fmt::format("its attribute {} must be numbers", name), "");
  const hssize_t count = checked(H5Sget_simple_extent_npoints(space.get()), where_, what);
  check_size(H5T_NATIVE_DOUBLE, count, where_);
  std::vector<double> values(static_cast<std::size_t>(count));
  if (values.empty()) return values;
  checked(H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, values.data()), where_, what);
  return values;
}

std::vector<std::string> Object::attribute_names() const {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hsize_t position = 0;
  checked(H5Aiterate2(id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, &position, visit, &names), where_,
          "cannot list the attributes");
  return names;
}

std::vector<Text> Object::texts() const {
  std::vector<Text> texts;
  for (const std::string& attribute : attribute_names()) {
    if (auto value = text(attribute)) texts.emplace_back(attribute, std::move(*value));
  }
  return texts;
}

void Object::check_attributes() const {
  for (const std::string& name : attribute_names()) {
    const Handle type(
        checked(H5Aget_type(open_attribute(id(), name, where_).get()), where_, "cannot read an attribute"));
    const H5T_class_t kind = H5Tget_class(type.get());
    if (kind == H5T_STRING) text(name);
    if (kind == H5T_INTEGER || kind == H5T_FLOAT) numbers(name);
  }
}

std::string Group::path_of(const std::string& name) const {
  return where_.back() == '/' ? where_ + name : where_ + "/" + name;
}

bool Group::has(const std::string& name) const {
  return checked(H5Lexists(id(), name.c_str(), H5P_DEFAULT), where_, "cannot look for " + name) > 0;
}

// Links to other names and other files: they may lead to a pipe, or a file that was never meant to be read.
void Group::refuse_foreign_link(const std::string& name) const {
  H5L_info_t link;
  checked(H5Lget_info(id(), name.c_str(), &link, H5P_DEFAULT), path_of(name), "cannot open");
  if (link.type == H5L_TYPE_HARD) return;
  throw StoreError(path_of(name),
                   link.type == H5L_TYPE_SOFT ? "is a link to another name" : "is a link to another file",
                   "such links are not followed");
}

bool Group::has_dataset(const std::string& name) const {
  if (!has(name)) return false;
  refuse_foreign_link(name);
  H5O_info_t info;
  checked(H5Oget_info_by_name2(id(), name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT), path_of(name),
          "cannot open");
  return info.type == H5O_TYPE_DATASET;
}

// Reads the links one by one: on a damaged list H5Literate of HDF5 1.10 frees names that it has not read.
std::vector<std::string> Group::names_in_order() const {
  const std::string what = "cannot list the group";
  H5G_info_t info;
  checked(H5Gget_info(id(), &info), where_, what);
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto get = [&](char* text, std::size_t size) {
      return static_cast<std::size_t>(
          checked(H5Lget_name_by_idx(id(), ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, i, text, size, H5P_DEFAULT),
                  where_, what));
    };
    std::string name(get(nullptr, 0), '\0');
    get(name.data(), name.size() + 1);
    names.push_back(std::move(name));
  }
  return names;
}

std::vector<std::string> Group::dataset_names() const {
  std::vector<std::string> names = names_in_order();
  std::erase_if(names, [&](const std::string& name) { return !has_dataset(name); });
  return names;
}

std::vector<std::string> Group::group_names() const {
  std::vector<std::string> names = names_in_order();
  std::erase_if(names, [&](const std::string& name) { return has_dataset(name); });
  return names;
}

std::vector<std::string> Group::link_names() const {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  checked(H5Literate(id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names), where_,
          "cannot list the group");
  return names;
}

Group Group::create_group(const std::string& name) {
  const std::string path = path_of(name);
  const Handle properties(checked(H5Pcreate(H5P_GROUP_CREATE), path, "cannot create"));
  order_by_creation(properties.get(), path);
  return Group(Handle(checked(H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                              path, "cannot create the group"),
                      handle_.failure()),
               path);
}

void Group::remove(const std::string& name) {
  checked(H5Ldelete(id(), name.c_str(), H5P_DEFAULT), path_of(name), "cannot remove");
}

Group Group::group(const std::string& name) const {
  const std::string path = path_of(name);
  if (name.find('/') == std::string::npos) {
    if (has(name)) refuse_foreign_link(name);
  } else {
    const std::size_t slash = name.find('/');
    return group(name.substr(0, slash)).group(name.substr(slash + 1));
  }
  return Group(Handle(checked(H5Gopen2(id(), name.c_str(), H5P_DEFAULT), path, "cannot open the group"),
                      handle_.failure()),
               path);
}

File File::create(const std::filesystem::path& path) {
  const Handle access = file_access(path.string());
  const Handle properties(checked(H5Pcreate(H5P_FILE_CREATE), path.string(), "cannot create"));
  order_by_creation(properties.get(), path.string());
  return File(Handle(checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, properties.get(), access.get()),
                             path.string(), "cannot create the file"),
                     std::make_shared<std::string>()),
              path.string());
}

File File::open(const std::filesystem::path& path) {
  const Handle access = file_access(path.string());
  keep_to_ourselves(access, path.string());
  return File(Handle(checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), path.string(),
                             "cannot open the file")),
              path.string());
}

File File::open_to_change(const std::filesystem::path& path) {
  const Handle access = file_access(path.string());
  return File(Handle(checked(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get()), path.string(),
                             "cannot open the file to change it"),
                     std::make_shared<std::string>()),
              path.string());
}

Group File::root() const {
  return Group(Handle(checked(H5Gopen2(handle_.get(), "/", H5P_DEFAULT), path_, "cannot open the root group"),
                      handle_.failure()),
               path_ + ":/");
}

void File::close() {
  checked(H5Fflush(handle_.get(), H5F_SCOPE_GLOBAL), path_, "cannot write");
  checked(H5Fclose(handle_.release()), path_, "cannot close");
  if (handle_.failure() && !handle_.failure()->empty())
    throw StoreError(path_, "cannot write", *handle_.failure());
}

}  // namespace frahm::results::hdf5
