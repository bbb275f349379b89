#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

// The file of one of the project's studies by its name, such as "den_hartog"; the folders under studies/ are by
// topic, and a name stands in one of them only.
inline std::string study_path(const std::string& name) {
  const std::filesystem::path studies = FRAHM_SOURCE_DIR "/studies";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(studies)) {
    if (entry.path().filename() == name + ".toml") return entry.path().string();
  }
  throw std::runtime_error("there is no study " + name + " in " + studies.string());
}
