#pragma once

#include <cstdint>
#include <string>

#include "results/layout.hpp"
#include "results/store_error.hpp"

// What hdf5.cpp and hdf5_dataset.cpp share; no other file includes it.
namespace frahm::results::hdf5 {

// Throws StoreError with the cause HDF5 recorded for the call that just failed in this thread.
[[noreturn]] void fail(const std::string& where, const std::string& what);

// What an HDF5 call returned; negative is failure.
template <typename Result>
Result checked(Result result, const std::string& where, const std::string& what) {
  if (result < 0) fail(where, what);
  return result;
}

// Keeps HDF5 from printing errors, which are thrown. The setting is the calling thread's: whatever may be the
// first call in a thread comes after it.
void print_no_errors();

// HDF5's identifier of the type in the file, which is also that of to_storage()'s bytes.
std::int64_t numeric_type(Type type);

}  // namespace frahm::results::hdf5
