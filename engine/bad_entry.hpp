#pragma once

#include <stdexcept>

namespace frahm::engine {

// The entry of a tile has the checksum that it should have, but its contents mean nothing. Thrown by those
// who know what an entry means; who reads the logs adds which log it was.
class BadEntry : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace frahm::engine
