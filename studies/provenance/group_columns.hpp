#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/layout.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {

// Columns of a group as they are added. Units are in the form of UDUNITS.
class GroupColumns {
 public:
  // dimension: "" for a single number.
  void add(const Named& named, const std::string& unit, const std::string& dimension,
           std::vector<double> values, results::Type type = results::Type::float64) {
    columns_.push_back({variable(named, unit, type), dimension, std::move(values)});
  }
  void add_number(const Named& named, const std::string& unit, double value) {
    add(named, unit, "", {value});
  }
  void add_count(const Named& named, const std::string& dimension, std::vector<double> values) {
    add(named, "1", dimension, std::move(values), results::Type::int32);
  }
  void add_flag(const Named& named, const std::string& dimension, const std::vector<std::string>& meanings,
                std::vector<double> values) {
    columns_.push_back({flag_variable(named, meanings), dimension, std::move(values)});
  }

  std::vector<results::Column> take() { return std::move(columns_); }

 private:
  std::vector<results::Column> columns_;
};

}  // namespace frahm::studies
