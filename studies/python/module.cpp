#include "results/checked_apart.hpp"
#include "studies/identification/identified_study.hpp"
#include "studies/python/binding.hpp"

namespace frahm::python {

PYBIND11_MODULE(_frahm, module) {
  // A child of a process with other threads, of which one may be inside HDF5, might wait for ever.
  results::keep_checks_here();
  module.doc() = "The compiled part of frahm.";
  add_errors(module);
  add_study(module);
  add_run(module);
  module.def("identified_study", [](const std::string& file) { return studies::identified_study(file); });
}

}  // namespace frahm::python
