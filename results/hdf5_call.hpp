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

// Errors are thrown, not printed. The setting is the calling thread's; a file may be read by another one than
// that which opened it.
void do_not_print();

// HDF5's identifier of the type in the file, which is also that of to_storage()'s bytes.
std::int64_t numeric_type(Type type);

}  // namespace frahm::results::hdf5
