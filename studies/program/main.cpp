#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <iostream>

#include "studies/program/exit_code.hpp"
#include "studies/program/program.hpp"

namespace {

// The BLAS under Ipopt's linear solver must use only the calling thread, because this program starts the
// threads. OpenBLAS reads OPENBLAS_NUM_THREADS before main(), so its own function sets the number; another
// BLAS has none.
void keep_blas_to_one_thread() {
  using SetThreads = void (*)(int);
  const auto set_threads = reinterpret_cast<SetThreads>(::dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads) set_threads(1);
}

// A file opened where standard output or error is closed (`>&-`) would get its number, and what is printed
// would end up in it: in a shard log. So these numbers are taken first.
void occupy_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      ::open("/dev/null", O_RDWR);  // the lowest free number
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    occupy_standard_streams();
    keep_blas_to_one_thread();
    std::signal(SIGXFSZ, SIG_IGN);  // a file above the limit of the shell is an error of its write, EFBIG
    return frahm::studies::run_program(argc, argv, std::cout);
  } catch (const std::exception& error) {
    std::cerr << "frahm: internal error, please report it: " << error.what() << '\n';
  } catch (...) {
    std::cerr << "frahm: internal error, please report it\n";
  }
  return frahm::studies::exit_code::internal_error;
}
