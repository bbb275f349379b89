#pragma once

#include <dlfcn.h>

namespace frahm::python {

// While it exists, the BLAS of the process uses only the calling thread: a run starts threads of its own.
// NumPy shares that BLAS and has its threads back afterwards. OpenBLAS alone has these functions; of another
// nothing changes.
class OneBlasThread {
 public:
  OneBlasThread() { set(1); }
  ~OneBlasThread() { set(before_); }
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  template <class Function>
  static Function find(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_DEFAULT, name));
  }
  static int now() {
    const auto get = find<int (*)()>("openblas_get_num_threads");
    return get ? get() : 0;
  }
  static void set(int threads) {
    const auto set_threads = find<void (*)(int)>("openblas_set_num_threads");
    if (set_threads && threads > 0) set_threads(threads);
  }

  int before_ = now();
};

}  // namespace frahm::python
