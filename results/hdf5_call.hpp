#pragma once

#include <cstdint>
#include <string>

#include "results/layout.hpp"
#include "results/store_error.hpp"

// Shared by hdf5.cpp and hdf5_dataset.cpp; no other file includes it.
namespace frahm::results::hdf5 {

// Throws StoreError with the cause HDF5 recorded for the call that just failed in this thread.
[[noreturn]] void fail(const std::string& where, const std::string& what);

// Returns the result of an HDF5 call, or throws StoreError if it is negative (failure).
template <typename Result>
Result checked(Result result, const std::string& where, const std::string& what) {
  if (result < 0) fail(where, what);
  return result;
}

// Stops HDF5 from printing errors, which are thrown instead. The setting holds for the calling thread: call
// this before any function that may make the thread's first HDF5 call.
void print_no_errors();

// HDF5's identifier of the type in the file, which is also that of to_storage()'s bytes.
std::int64_t numeric_type(Type type);

}  // namespace frahm::results::hdf5
