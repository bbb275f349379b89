#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <string_view>
#include <vector>

#include "studies/reading/study/study.hpp"

// What the parts of the extension module frahm._frahm share; the package frahm around it is for users.
namespace frahm::python {

namespace py = pybind11;

// A study, and how it was changed since it was read.
struct LoadedStudy {
  studies::Study study;
  std::vector<std::string> set;  // name=value each
};

// A one-dimensional array of its own memory.
template <class Number>
py::array_t<Number> array_of(const std::vector<double>& values) {
  py::array_t<Number> array(static_cast<py::ssize_t>(values.size()));
  Number* out = array.mutable_data();
  for (const double value : values) *out++ = static_cast<Number>(value);
  return array;
}

// A text that may come from a file, whatever its bytes.
inline py::str text_of(std::string_view text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace"));
}

// Parts of the module.
void add_errors(py::module_& module);
void add_study(py::module_& module);
void add_responses(py::class_<LoadedStudy>& study);
void add_run(py::module_& module);

}  // namespace frahm::python
