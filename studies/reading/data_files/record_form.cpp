#include "studies/reading/data_files/record_form.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

std::size_t required_there(const RecordForm& form, const std::vector<std::string>& found) {
  return static_cast<std::size_t>(std::count_if(form.roles.begin(), form.roles.end(), [&](const Role& role) {
    return role.required && std::find(found.begin(), found.end(), role.name) != found.end();
  }));
}

std::size_t required_in_all(const RecordForm& form) {
  return static_cast<std::size_t>(
      std::count_if(form.roles.begin(), form.roles.end(), [](const Role& role) { return role.required; }));
}

}  // namespace

const Role* RecordForm::find(const std::string& name) const {
  const auto role =
      std::find_if(roles.begin(), roles.end(), [&](const Role& each) { return each.name == name; });
  return role == roles.end() ? nullptr : &*role;
}

std::vector<std::string> role_names(const std::vector<RecordForm>& forms) {
  std::vector<std::string> names;
  bool tables = false;
  for (const RecordForm& form : forms) {
    for (const Role& role : form.roles) {
      if (std::find(names.begin(), names.end(), role.name) == names.end()) names.push_back(role.name);
    }
    tables = tables || !form.is_trace;
  }
  if (tables) names.emplace_back(label_role);
  names.emplace_back(doubtful_role);
  return names;
}

const RecordForm& form_of(const std::vector<RecordForm>& forms, const std::vector<std::string>& found) {
  for (const RecordForm& form : forms) {
    if (required_there(form, found) == required_in_all(form)) return form;
  }
  return *std::max_element(forms.begin(), forms.end(), [&](const RecordForm& a, const RecordForm& b) {
    return required_there(a, found) < required_there(b, found);
  });
}

std::string described(const RecordForm& form) {
  std::vector<std::string> must, may;
  for (const Role& role : form.roles) (role.required ? must : may).push_back(role.name);
  std::string text = listed(must, " and ");
  if (!may.empty()) text += fmt::format(", and any of {}", listed(may, " and "));
  return text;
}

bool is_excitation(const Study& study, const std::string& role) {
  const auto names = [&](const std::vector<std::string>& nodes, const char* ending) {
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](const std::string& node) { return role == node + ending; });
  };
  return names(study.network.masses, "_force") || names(study.network.prescribed, "_displacement");
}

bool is_motion(const Study& study, const std::string& role) {
  return role != "time" && !is_excitation(study, role);
}

}  // namespace frahm::studies
