#include <fmt/format.h>

#include <cmath>

#include "studies/python/binding.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"
#include "studies/reading/text/toml_reading.hpp"
#include "studies/reading/text/toml_writing.hpp"

// A study as Python holds it: read from a file, a text or a dictionary.
namespace frahm::python {
namespace {

using studies::TomlArray;
using studies::TomlTable;
using studies::TomlValue;

// As deep as the reader takes; a dictionary may hold itself.
constexpr int kDeepest = 16;

TomlValue toml_of(py::handle value, const std::string& place, int depth);

TomlTable table_of(const py::dict& dictionary, const std::string& place, int depth) {
  TomlTable table;
  for (const auto& [key, value] : dictionary) {
    const std::string name = py::str(key);
    table.push_back(
        {name, {}, toml_of(value, place.empty() ? name : fmt::format("{}.{}", place, name), depth + 1)});
  }
  return table;
}

// TOML's whole numbers have 64 bits.
std::int64_t whole_number(py::handle value, const std::string& place) {
  const py::int_ number(py::reinterpret_borrow<py::object>(value));
  int overflow = 0;
  const long long result = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
  if (overflow == 0) return result;
  throw studies::StudyError(studies::rules::out_of_range,
                            "{}: a whole number beyond 64 bits; write it as a float, such as 1e20", place);
}

// place: its keys, for messages. numbers.Integral and numbers.Real hold NumPy's numbers too.
TomlValue toml_of(py::handle value, const std::string& place, int depth) {
  if (depth > kDeepest)
    throw studies::StudyError(studies::rules::too_large, "{}: nested deeper than {} levels", place, kDeepest);
  const py::module_ numbers = py::module_::import("numbers");
  if (py::isinstance<py::bool_>(value)) return {{}, value.cast<bool>()};
  if (py::isinstance(value, numbers.attr("Integral"))) return {{}, whole_number(value, place)};
  if (py::isinstance(value, numbers.attr("Real")))
    return {{}, py::float_(py::reinterpret_borrow<py::object>(value)).cast<double>()};
  if (py::isinstance<py::str>(value)) return {{}, value.cast<std::string>()};
  if (py::isinstance<py::dict>(value))
    return {{}, table_of(py::reinterpret_borrow<py::dict>(value), place, depth)};
  if (py::hasattr(value, "tolist")) return toml_of(value.attr("tolist")(), place, depth + 1);
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    TomlArray array;
    for (const py::handle item : value) array.push_back(toml_of(item, place, depth + 1));
    return {{}, std::move(array)};
  }
  throw studies::StudyError(studies::rules::wrong_type,
                            "{}: a study holds numbers, texts, lists and dictionaries, not {}", place,
                            std::string(py::str(py::type::handle_of(value).attr("__name__"))));
}

// The numbers of [parameters]: name, value, unit.
py::list parameters_of(const LoadedStudy& loaded) {
  const studies::Study& study = loaded.study;
  const std::vector<double> nominal = study.parameters.nominal();
  py::list list;
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    if (!study.parameters.list[i].is_number()) continue;
    const studies::SpokenValue spoken = studies::spoken_value(study, i, nominal[i]);
    list.append(py::make_tuple(study.parameters.list[i].name, spoken.value, spoken.unit));
  }
  return list;
}

// Its axes: parameter, unit, values.
py::list axes_of(const LoadedStudy& loaded) {
  py::list list;
  if (!loaded.study.map()) return list;
  for (const studies::ParameterAxis& axis : loaded.study.map()->axes) {
    list.append(py::make_tuple(loaded.study.parameters.list[axis.parameter].name, axis.unit,
                               array_of<double>(axis.values)));
  }
  return list;
}

// All there are: name, unit, meaning.
py::list quantities_of(const LoadedStudy& loaded) {
  py::list list;
  for (const periodic::Quantity& quantity : periodic::all_quantities(loaded.study.network)) {
    const auto described = periodic::describe(quantity, loaded.study.network, loaded.study.dimensionless);
    list.append(py::make_tuple(described.name, described.unit, described.long_name));
  }
  return list;
}

LoadedStudy with(studies::Study study, const std::vector<std::string>& set) {
  return {studies::with_settings(std::move(study), set, "parameter"), set};
}

}  // namespace

void add_study(py::module_& module) {
  py::class_<LoadedStudy> study(module, "Study");
  study
      .def_static("load",
                  [](const std::string& path, const std::vector<std::string>& set) {
                    return with(studies::read_study(path), set);
                  })
      .def_static("parse",
                  [](const std::string& text, const std::string& name, const std::vector<std::string>& set) {
                    return with(studies::parse_study(text, name), set);
                  })
      .def_property_readonly("name", [](const LoadedStudy& self) { return self.study.source.name; })
      .def_property_readonly("text", [](const LoadedStudy& self) { return self.study.source.text; })
      .def_property_readonly("title", [](const LoadedStudy& self) { return self.study.title; })
      .def_property_readonly(
          "kind", [](const LoadedStudy& self) { return std::string(kind_name(self.study.kind())); })
      .def_property_readonly(
          "noun", [](const LoadedStudy& self) { return std::string(kind_noun(self.study.kind())); })
      .def_property_readonly("dimensionless",
                             [](const LoadedStudy& self) { return self.study.dimensionless; })
      .def_property_readonly("set", [](const LoadedStudy& self) { return self.set; })
      .def("parameters", parameters_of)
      .def("axes", axes_of)
      .def("quantities", quantities_of);
  add_responses(study);
  module.def("toml_text", [](const py::dict& dictionary) {
    return studies::toml_text(TomlValue{{}, table_of(dictionary, "", 0)});
  });
}

}  // namespace frahm::python
