#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace frahm::studies {

// The options of `frahm export --data`, as typed.
struct DataOptions {
  std::filesystem::path output;  // CSV; "-": stdout
  std::vector<std::string> set;  // name=value: parameters of a study
  std::vector<std::string> at;   // name=value: the point of a periodic response
  std::string rate;              // "1000", "1 kHz"
  std::string duration;          // "10", "10 s"
  std::string noise;             // "1%" of each column, "0.1 mm"
  std::string seed;              // a whole number, 1 by default
  std::vector<std::string> columns;
};

// Writes simulated measurements of the motion of a study, or of the study of a result, as a table that an
// identification reads. Returns 0. Throws StudyError naming the option, engine::IoError.
int export_data(const std::filesystem::path& file, const DataOptions& options, std::ostream& out);

}  // namespace frahm::studies
