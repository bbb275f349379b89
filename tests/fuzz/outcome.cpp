#include "tests/fuzz/outcome.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace frahm::fuzz {
namespace {

struct Counts {
  unsigned long read = 0, refused = 0;
};

Counts& counts() {
  static Counts all;
  return all;
}

void print_counts() {
  fmt::print(stderr, "outcomes: {} read, {} refused\n", counts().read, counts().refused);
}

}  // namespace

void count(Outcome outcome) {
  static const bool printed_at_exit = std::atexit(print_counts) == 0;
  static_cast<void>(printed_at_exit);
  ++(outcome == Outcome::read ? counts().read : counts().refused);
}

}  // namespace frahm::fuzz
