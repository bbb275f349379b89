#include "studies/provenance/files_read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "studies/provenance/digest.hpp"

namespace frahm::studies {
namespace {

// Something that a study reads from files.
struct FileRead {
  std::string what;  // `parameter "A": table a.csv`
  std::string line;  // with the digest
};

// The order of parameters changes nothing, so that of the lines is by name.
std::vector<FileRead> all_of(const Study& study) {
  std::vector<FileRead> all;
  const auto add = [&](const std::string& what, const std::string& name, const std::string& digests) {
    all.push_back({what, fmt::format("{} {}", name, digests)});
  };
  for (const Parameter& parameter : study.parameters.list) {
    if (const auto* table = std::get_if<TableOf>(&parameter.definition))
      add(fmt::format("parameter \"{}\": the table {}", parameter.name, table->file),
          "parameter " + parameter.name, digest(table->table.x) + " " + digest(table->table.y));
  }
  for (const mechanics::MatrixPart& part : study.network.matrices)
    add(fmt::format("matrices \"{}\": a file", part.name), "matrices " + part.name,
        fmt::format("{} {} {}", digest(part.mass), digest(part.stiffness), digest(part.damping)));
  for (const PeriodSeries& period : study.values.series) {
    if (!period.file.empty())
      add(fmt::format("{}: the file {}", period.what, period.file), fmt::format("period {}", period.first),
          digest(period.time) + " " + digest(period.samples));
  }
  std::ranges::sort(all, {}, &FileRead::line);
  return all;
}

}  // namespace

std::string files_read(const Study& study) {
  std::string text;
  for (const FileRead& each : all_of(study)) text += (text.empty() ? "" : "\n") + each.line;
  return text;
}

void refuse_changed_files(const Study& study, const std::string& stored, const std::string& file) {
  if (stored.empty()) return;
  const std::string lines = "\n" + stored + "\n";
  for (const FileRead& each : all_of(study)) {
    if (lines.find("\n" + each.line + "\n") != std::string::npos) continue;
    throw StudyError(rules::changed_data,
                     "{}: {} has other numbers than when this result was made. Restore it next to the "
                     "result, or run the study again",
                     file, each.what);
  }
}

}  // namespace frahm::studies
