#include <dlfcn.h>

#include "results/checked_apart.hpp"
#include "studies/identification/identified_study.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/python/binding.hpp"

namespace frahm::python {
namespace {

// The file of this module, wherever the process goes later.
std::filesystem::path own_file() {
  Dl_info here{};
  ::dladdr(reinterpret_cast<void*>(&own_file), &here);
  return std::filesystem::absolute(here.dli_fname ? here.dli_fname : "");
}

// A file that anybody may have made, before a library of Python reads it.
void check_result(const std::string& path) {
  const py::gil_scoped_release free;
  studies::require_result(path);
  results::check_apart(path, results::result_check(path));
}

}  // namespace

PYBIND11_MODULE(_frahm, module) {
  results::check_by(own_file().replace_filename("check_file"));
  module.doc() = "The compiled part of frahm.";
  add_errors(module);
  add_study(module);
  add_run(module);
  module.def("check_result", check_result, py::arg("path"));
  module.def("identified_study", [](const std::string& file) { return studies::identified_study(file); });
}

}  // namespace frahm::python
