#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/end_to_end/runs.hpp"

namespace runs {

// The columns of a decay's or transient's file, run from its study; fails the test if the run does.
class MotionFile {
 public:
  MotionFile(const std::string& study, const std::string& group, const std::vector<std::string>& more = {});

  const std::vector<double>& operator[](const std::string& column) const { return columns_.at(column); }

 private:
  std::map<std::string, std::vector<double>> columns_;
};

}  // namespace runs
