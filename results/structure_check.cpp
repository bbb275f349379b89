#include "results/structure_check.hpp"

#include <fmt/core.h>

#include "results/hdf5.hpp"
#include "results/store_error.hpp"

namespace frahm::results {
namespace {

constexpr int deepest_group = 8;                  // a result needs two: /optimum/front
constexpr std::uint64_t most_objects = 100'000;   // a map of sixty storeys has some thousands
constexpr std::uint64_t small_dataset = 1 << 15;  // [values]

class Walk {
 public:
  void group(const hdf5::Group& group, int depth) {
    if (depth > deepest_group)
      throw StoreError(group.where(), fmt::format("is nested deeper than {} groups", deepest_group), "");
    group.check_attributes();
    for (const std::string& name : group.link_names()) {
      if (++objects_ > most_objects)
        throw StoreError(group.where(), fmt::format("the file has more than {} objects", most_objects), "");
      if (group.has_dataset(name)) {
        dataset(group.dataset(name));
      } else {
        this->group(group.group(name), depth + 1);
      }
    }
    follow_scales(group);
    group.dataset_names();  // in the other order of its links, as readers ask for them
  }

 private:
  // When every object was opened once: after an object that could not be read HDF5 opens it the second time.
  static void follow_scales(const hdf5::Group& group) {
    for (const std::string& name : group.link_names()) {
      if (!group.has_dataset(name)) continue;
      try {
        group.dataset(name).is_scale();
        group.dataset(name).listed_scales();
      } catch (const StoreError&) {  // as below
      }
    }
  }

  static void dataset(const hdf5::Dataset& dataset) {
    dataset.check_attributes();
    if (!dataset.is_numeric()) return;  // not read by anything of ours
    try {
      read(dataset);
    } catch (
        const StoreError&) {  // told by who needs these data; what counts here is that HDF5 survives them
    }
  }

  // Reads what is small whole; of a large one the index of its chunks, which HDF5 follows at a reading.
  static void read(const hdf5::Dataset& dataset) {
    const Shape shape = dataset.shape();
    if (product(shape) > small_dataset) {
      dataset.count_chunks();
    } else if (product(shape) > 0) {
      dataset.read(Shape(shape.size(), 0), shape);
    }
  }

  std::uint64_t objects_ = 0;
};

}  // namespace

void check_structure(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  Walk().group(file.root(), 0);
}

}  // namespace frahm::results
