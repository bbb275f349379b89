#include "tests/end_to_end/motion_file.hpp"

#include <catch2/catch.hpp>

namespace runs {

MotionFile::MotionFile(const std::string& study, const std::string& group,
                       const std::vector<std::string>& more) {
  const Folder folder;
  const std::string file = folder / "motion.h5";
  std::vector<std::string> arguments{"run", study, "-o", file};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = frahm(arguments);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const frahm::results::MapReader reader(file);
  for (const frahm::results::Column& column : reader.columns(group))
    columns_[column.variable.name] = column.values;
}

}  // namespace runs
