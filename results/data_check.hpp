#pragma once

#include "results/hdf5.hpp"

namespace frahm::results {

// Reads all numbers of a group and of those within it, chunk by chunk, as each carries a checksum. Throws
// StoreError, naming the dataset, for the first that cannot be read.
void check_data(const hdf5::Group& group);

}  // namespace frahm::results
