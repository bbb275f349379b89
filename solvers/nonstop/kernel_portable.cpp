// Two lanes a register, on every processor; and what the kernel needs of memory, the same for all.
#define FRAHM_KERNEL portable
#include "solvers/nonstop/kernel_body.hpp"

namespace frahm::periodic::nonstop {

std::size_t workspace_size(const Shape& shape) {
  Pack pack;
  pack.shape = &shape;
  Arena arena(nullptr);
  const Work<AnyCounts> work(pack, arena);
  return arena.used();
}

}  // namespace frahm::periodic::nonstop
