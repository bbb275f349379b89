#pragma once

#include <stdexcept>
#include <string>

namespace frahm::results {

// The record could not be written or read: what() is "where: what: cause", e.g.
// "atlas.h5:/main_peak: cannot read: data error detected by Fletcher32 checksum".
class StoreError : public std::runtime_error {
 public:
  StoreError(const std::string& where, const std::string& what, const std::string& cause)
      : std::runtime_error(where + ": " + what + (cause.empty() ? "" : ": " + cause)) {}
  explicit StoreError(const std::string& whole) : std::runtime_error(whole) {}
};

}  // namespace frahm::results
