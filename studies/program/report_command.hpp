#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace frahm::studies {

struct ReportOptions {
  std::filesystem::path file;
  std::filesystem::path output;         // the page; "": FILE with .html
  std::filesystem::path figures;        // folder for figures instead of a page; "": the page
  std::vector<std::string> quantities;  // of a map; empty: those of its study, otherwise of an atlas
};

// Makes the page of a result, or its figures as files, and prints what was made to `out`. Returns the exit
// code. Throws StudyError, engine::IoError, results::StoreError.
int report_command(const ReportOptions& options, std::ostream& out);

}  // namespace frahm::studies
