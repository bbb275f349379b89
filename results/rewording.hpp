#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "results/layout.hpp"

namespace frahm::results {

// What a variable is to be reported in. Its numbers are multiplied by `factor`, or are `values` where there
// are any.
struct Words {
  std::string unit, long_name;
  double factor = 1.0;
  std::vector<double> values = {};
};

// The words of a variable of a group (its path; "" the root); nothing where they stay.
using WordsOf = std::function<std::optional<Words>(const std::string& group, const Variable& variable)>;

// Words, units and whole groups of a result, in place of those that its file has.
struct Rewording {
  std::string title;
  std::vector<std::pair<std::string, std::vector<Text>>> texts;  // of groups: of those they have
  WordsOf words_of;
  std::vector<GroupContent> anew = {};  // each after the one above it; also groups that the file has not
};

// Writes them into a copy of the file, which takes the place of the file in one step: a process that is
// killed leaves the file as it was. All other numbers stay the same bytes. The caller must prevent two
// writers of one path. Throws StoreError.
void reword(const std::filesystem::path& result, const Rewording& to);

}  // namespace frahm::results
