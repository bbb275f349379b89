#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace frahm::results {

// A check of a file that may be damaged or made to do harm: what it does, and the words by which another
// program is asked for the same.
struct FileCheck {
  std::function<void()> carry_out;      // throws StoreError
  std::vector<std::string> words = {};  // what is checked, the file, what of it
};

// check_result(), check_scales(), check_opening() and check_dataset() as such checks.
FileCheck result_check(const std::filesystem::path& path);
FileCheck scales_check(const std::filesystem::path& path);
FileCheck opening_check(const std::filesystem::path& path);
FileCheck dataset_check(const std::filesystem::path& path, const std::string& dataset,
                        std::size_t dimensions);

// The check with these words. Throws std::invalid_argument where there is none.
FileCheck check_called(const std::vector<std::string>& words);

}  // namespace frahm::results
