#pragma once

#include "results/hdf5.hpp"

namespace frahm::results {

// Whether every chunk was written, as of all finished results, or some of the map are not, as of a part.
enum class Completeness { whole, part };

// Reads all numbers of a group and of those within it, chunk by chunk, as each carries a checksum.
// Throws StoreError, naming the dataset, for the first that cannot be read.
void check_data(const hdf5::Group& group, Completeness completeness);

// Compares the lists of dimensions of a group and of those within it with what its scales say. Throws
// StoreError, naming the dataset, for the first that differs. Only in a child (check_apart): see
// Dataset::listed_scales().
void check_scales(const hdf5::Group& group);

}  // namespace frahm::results
