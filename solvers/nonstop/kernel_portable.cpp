// Two lanes a register, on every processor.
#define FRAHM_KERNEL portable
#include "solvers/nonstop/kernel_body.hpp"
