#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/box.hpp"
#include "results/layout.hpp"

// Classes for HDF5's objects: file, group, dataset, attribute, dimension scale. Only hdf5.cpp and
// hdf5_dataset.cpp call the library. Every HDF5 failure is thrown as StoreError with the object concerned and
// HDF5's own reason.
namespace frahm::results::hdf5 {

// The reason of the first failure to close an object of a file; empty if there was none. HDF5 writes a
// dataset's buffered data when the dataset is closed, and drops them if the write fails.
using CloseFailure = std::shared_ptr<std::string>;

// The owner of one HDF5 identifier (hid_t).
class Handle {
 public:
  Handle() = default;
  explicit Handle(std::int64_t id, CloseFailure failure = nullptr) : id_(id), failure_(std::move(failure)) {}
  Handle(Handle&& other) noexcept : id_(other.release()), failure_(std::move(other.failure_)) {}
  Handle& operator=(Handle&& other) noexcept;
  ~Handle();

  std::int64_t get() const { return id_; }
  std::int64_t release() noexcept;  // gives up ownership
  const CloseFailure& failure() const { return failure_; }

 private:
  std::int64_t id_ = -1;
  CloseFailure failure_;
};

// An object with attributes: a group or a dataset.
class Object {
 public:
  const std::string& where() const { return where_; }  // "atlas.h5:/orbits/time", for messages
  std::string name() const;                            // the last part of its path

  // A scalar UTF-8 string of fixed length. std::invalid_argument if `text` is not UTF-8 or contains a zero
  // byte.
  void write_text(const std::string& name, const std::string& text);
  void write_numbers(const std::string& name, const Variable& as,
                     std::span<const double> values);                   // shape [n]
  void replace_text(const std::string& name, const std::string& text);  // write_text() where it is there too

  // The attribute, if it exists: a single string, of fixed or variable length.
  std::optional<std::string> text(const std::string& name) const;
  std::optional<std::vector<double>> numbers(const std::string& name) const;  // if there is such an attribute
  std::vector<Text> texts() const;  // every single string among the attributes, in order of creation
  // Reads every text and number; throws StoreError for those of no use to a result, or above 64 MiB.
  void check_attributes() const;

 protected:
  Object(Handle handle, std::string where) : handle_(std::move(handle)), where_(std::move(where)) {}
  std::int64_t id() const { return handle_.get(); }
  std::vector<std::string> attribute_names() const;  // in order of creation

  Handle handle_;
  std::string where_;
};

// How a dataset is stored.
struct Storage {
  Type type = Type::float64;
  Shape shape = {};      // empty: a single number
  Shape chunk = {};      // shuffle, deflate and fletcher32 by chunk; a single number: none
  bool growing = false;  // its first dimension is unlimited (needs a chunk)
};

class Dataset : public Object {
 public:
  Type type() const;
  bool is_numeric() const;  // integers or floats of any size and byte order
  Shape shape() const;
  Shape chunk() const;                 // empty if contiguous
  std::uint64_t count_chunks() const;  // that are stored; 0 if contiguous
  // Throws StoreError where the chunk that begins there is not stored: it would be read as missing values.
  void require_chunk(std::span<const std::uint64_t> start) const;

  // A box of the dataset. Start and count are empty for a single number.
  void write(std::span<const std::uint64_t> start, std::span<const std::uint64_t> count,
             std::span<const std::byte> elements);  // as stored
  std::vector<double> read(std::span<const std::uint64_t> start, std::span<const std::uint64_t> count) const;
  // All of it. StoreError where more values are claimed than what is stored can hold.
  std::vector<double> read_all() const;

  void write_chunk(std::span<const std::uint64_t> start,
                   std::span<const std::byte> encoded);  // see encode_chunk
  void grow(std::uint64_t size);                         // sets the size of the unlimited dimension

  void make_scale();  // makes this the dimension scale of its own name
  bool is_scale() const;
  void attach_scale(unsigned axis, const Dataset& scale);

  // The axes of other datasets to which this scale is attached.
  struct Use {
    std::uint64_t dataset = 0;  // its address()
    unsigned axis = 0;
  };
  std::vector<Use> uses() const;
  // The scales along each dimension by the list that other readers follow: their address(). Throws
  // StoreError for a list that is none. HDF5 may not survive a damaged one: only in a child (check_apart).
  std::vector<std::vector<std::uint64_t>> listed_scales() const;
  std::uint64_t address() const;  // in the file

 private:
  friend class Group;
  using Object::Object;
  void check_storage() const;
  void check_product(const Shape& extent, std::uint64_t limit, const char* of) const;
};

class Group : public Object {
 public:
  bool has(const std::string& name) const;
  bool has_dataset(const std::string& name) const;
  std::vector<std::string> dataset_names() const;  // in order of creation
  std::vector<std::string> group_names() const;    // in order of creation
  std::vector<std::string> link_names() const;     // of all links, by name; for any file

  Group create_group(const std::string& name);
  Group group(const std::string& name) const;
  void remove(const std::string& name);  // the link to it, and with it what is in it
  Dataset create_dataset(const std::string& name, const Storage& storage);
  // StoreError where its data are not in this file, or their extent is none that a result may have.
  Dataset dataset(const std::string& name) const;

  // The scales of the datasets of the group: of an address and an axis the name of the scale attached there.
  using Scales = std::map<std::pair<std::uint64_t, unsigned>, std::string>;
  Scales scales() const;

 private:
  friend class File;
  using Object::Object;
  std::string path_of(const std::string& name) const;
  void refuse_foreign_link(const std::string& name) const;
  std::vector<std::string> names_in_order() const;  // of creation
};

class File {
 public:
  static File create(const std::filesystem::path& path);  // replaces a file there
  static File open(const std::filesystem::path& path);    // to read
  static File open_to_change(const std::filesystem::path& path);

  Group root() const;
  // Hands everything written to the operating system, or throws StoreError. Close groups and datasets before.
  void close();

 private:
  File(Handle handle, std::string path) : handle_(std::move(handle)), path_(std::move(path)) {}
  Handle handle_;
  std::string path_;
};

}  // namespace frahm::results::hdf5
