#include "studies/identification/identified_study.hpp"
#include "studies/python/binding.hpp"
#include "studies/record/build_facts.hpp"

namespace frahm::python {

PYBIND11_MODULE(_frahm, module) {
  module.doc() = "The compiled part of frahm.";
  add_errors(module);
  add_study(module);
  add_run(module);
  module.def("identified_study", [](const std::string& file) { return studies::identified_study(file); });
}

}  // namespace frahm::python
