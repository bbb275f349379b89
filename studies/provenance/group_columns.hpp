#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/layout.hpp"

namespace frahm::studies {

// Columns of a group as they are added. Units are in the form of UDUNITS.
class GroupColumns {
 public:
  // dimension: "" for a single number.
  void add(const std::string& name, const std::string& unit, const std::string& long_name,
           const std::string& dimension, std::vector<double> values,
           results::Type type = results::Type::float64);
  void add_number(const std::string& name, const std::string& unit, const std::string& long_name,
                  double value);
  void add_count(const std::string& name, const std::string& long_name, const std::string& dimension,
                 std::vector<double> values);
  void add_flag(const std::string& name, const std::string& long_name, const std::string& dimension,
                const std::vector<std::string>& meanings, std::vector<double> values);

  std::vector<results::Column> take() { return std::move(columns_); }

 private:
  std::vector<results::Column> columns_;
};

}  // namespace frahm::studies
