#if defined(__x86_64__)
#define FRAHM_KERNEL v2
#include "solvers/nonstop/kernel_body.hpp"
#endif
