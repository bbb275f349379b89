#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/reading/data_files/record_form.hpp"
#include "studies/reading/keys/toml_section.hpp"

// The columns that a record selects by its key `columns`.
namespace frahm::studies {

// A column by its number or its name.
struct WantedColumn {
  std::string role;
  std::optional<std::size_t> number;  // from 1
  std::string name;                   // in the header, or the path of a dataset; of no number
  Position position;                  // in the study
  std::string key{};                  // that names it; empty: it is named in `columns`

  std::string where() const { return key.empty() ? "columns: " + role : key; }  // in messages
};

// Reads the key `columns`; none if it is absent. Throws StudyError for a role that no form has.
std::vector<WantedColumn> read_wanted(const TomlSection& record, const std::vector<RecordForm>& forms);

// The form of the columns wanted. Throws StudyError where one is missing or does not belong to it.
const RecordForm& form_of_wanted(const TomlSection& record, const std::vector<RecordForm>& forms,
                                 const std::vector<WantedColumn>& wanted);

}  // namespace frahm::studies
