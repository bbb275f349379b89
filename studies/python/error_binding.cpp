#include <fmt/format.h>

#include "engine/fingerprint.hpp"
#include "engine/io_error.hpp"
#include "results/store_error.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/program/refusal_advice.hpp"
#include "studies/python/binding.hpp"

// The errors of the program as exceptions of Python, with the same words but for options and commands.
namespace frahm::python {
namespace {

// Never destroyed: exceptions may be thrown until the interpreter ends.
PyObject* study_error = nullptr;
PyObject* resume_refused = nullptr;

PyObject* new_error(py::module_& module, const char* name, const char* doc, PyObject* base,
                    const py::dict& attributes = {}) {
  const std::string full = fmt::format("frahm.{}", name);
  PyObject* error = PyErr_NewExceptionWithDoc(full.c_str(), doc, base, attributes.ptr());
  if (!error) throw py::error_already_set();
  module.attr(name) = py::handle(error);
  return error;
}

py::object in_words_of_python(std::string_view message) {
  return py::module_::import("frahm.words").attr("of_python")(text_of(message));
}

void raise(PyObject* type, std::string_view message) {
  PyErr_SetObject(type, in_words_of_python(message).ptr());
}

void raise_study_error(std::string_view message, std::string_view rule) {
  const py::object error = py::handle(study_error)(in_words_of_python(message));
  error.attr("rule") = std::string(rule);
  PyErr_SetObject(study_error, error.ptr());
}

// pybind11 gives the exception by value.
void translate(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param)
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const studies::StudyError& error) {
    raise_study_error(error.what(), error.rule().key);
  } catch (const mechanics::MechanicsError& error) {
    raise_study_error(error.what(), studies::rules::not_computed.key);
  } catch (const engine::ResumeRefused& error) {
    const std::string advice = error.advice().empty() ? studies::refusal_advice({}) : error.advice();
    raise(resume_refused, fmt::format("{}\n{}", error.what(), advice));
  } catch (const engine::IoError& error) {
    raise(PyExc_OSError, error.what());
  } catch (const results::StoreError& error) {
    raise(PyExc_OSError, error.what());
  }
}

}  // namespace

void add_errors(py::module_& module) {
  study_error = new_error(module, "StudyError",
                          "A mistake in a study, a name or a value, in the words of the program.\n\n"
                          "`rule` is the stable key of the rule that is broken.",
                          PyExc_ValueError, py::dict(py::arg("rule") = ""));
  resume_refused = new_error(module, "ResumeRefused", "What lies at the output belongs to another study.",
                             PyExc_RuntimeError);
  py::register_exception_translator(translate);
}

}  // namespace frahm::python
