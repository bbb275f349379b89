#include "studies/program/report_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "results/map_reader.hpp"
#include "results/report/page_data.hpp"
#include "results/report/report_page.hpp"
#include "studies/program/paper_figures.hpp"
#include "studies/program/report_content.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

void require_page_parts() {
  if (results::has_report_page()) return;
  throw StudyError(
      rules::not_installed,
      "report: this frahm was built without the parts of the page, which need Node.js and npm. Install them "
      "(Debian: apt-get install nodejs npm), configure and build again (cmake --preset release && cmake "
      "--build --preset release); everything else in this program is complete");
}

void write_page(const ReportOptions& options, const results::MapReader& result, std::ostream& out) {
  const std::filesystem::path output = options.output.empty()
                                           ? std::filesystem::path(options.file).replace_extension(".html")
                                           : options.output;
  const std::string title =
      result.layout().title.empty() ? options.file.filename().string() : result.layout().title;
  const std::string page = results::report_page(
      title, results::page_data(result, page_content(result, options.file, options.quantities, false)));
  if (output == "-") {
    out << page;
    return;
  }
  check_output_is_not_input(output, options.file, ".html");
  write_whole_file(output, page, Replaces::own_page);
  fmt::print(out, "{} ({:.1f} MB)\n", output.string(), static_cast<double>(page.size()) * 1e-6);
}

}  // namespace

int report_command(const ReportOptions& options, std::ostream& out) {
  require_page_parts();
  if (!options.figures.empty() && !options.output.empty())
    throw StudyError(rules::wrong_option, "--output: --figures writes into its own folder and makes no page");
  const results::MapReader result = undamaged_result(options.file);
  if (options.figures.empty()) {
    write_page(options, result, out);
  } else {
    const results::PageContent content = page_content(result, options.file, options.quantities, true);
    write_paper_figures(results::page_data(result, content), options.figures, out);
  }
  return 0;
}

}  // namespace frahm::studies
