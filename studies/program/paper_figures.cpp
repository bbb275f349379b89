#include "studies/program/paper_figures.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cerrno>
#include <ostream>
#include <sstream>
#include <system_error>
#include <vector>

#include "engine/io_error.hpp"
#include "results/report/report_page.hpp"
#include "studies/program/external_program.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/reading/study_source.hpp"

namespace frahm::studies {
namespace {

constexpr const char* script_name = ".frahm-figures.mjs";  // in the folder, while they are drawn

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw engine::IoError(folder, "create", error.value());
}

void require_node() {
  const ProgramEnd version = run_program_of_system("node", {"--version"});
  if (version.found) return;
  throw StudyError(
      "--figures: needs the program node, which is not on the PATH (Debian: apt-get install nodejs)");
}

// The names of the figures, without their extension.
std::vector<std::string> draw(const std::string& data, const std::filesystem::path& folder) {
  const std::filesystem::path script = folder / script_name;
  write_whole_file(script, results::figure_script());
  const ProgramEnd end = run_program_of_system("node", {script.string(), folder.string()}, data);
  std::error_code unimportant;
  std::filesystem::remove(script, unimportant);
  if (end.code != 0)
    throw engine::IoError(folder,
                          fmt::format("not all figures could be drawn: node ended with code {}", end.code));
  std::vector<std::string> names;
  std::istringstream lines(end.output);
  for (std::string name; std::getline(lines, name);) names.push_back(name);
  return names;
}

// Whether the PDF was made: by the first converter that is installed.
bool make_pdf(const std::string& svg, const std::string& pdf) {
  ProgramEnd end = run_program_of_system("rsvg-convert", {"--format=pdf", "--output=" + pdf, svg});
  if (!end.found) end = run_program_of_system("inkscape", {"--export-filename=" + pdf, svg});
  return end.found && end.code == 0;
}

}  // namespace

void write_paper_figures(const std::string& data, const std::filesystem::path& folder, std::ostream& out) {
  require_node();
  make_folder(folder);
  const std::vector<std::string> names = draw(data, folder);
  if (names.empty()) fmt::print(out, "This result has no figures; its page has its tables.\n");
  bool pdf = true;
  for (const std::string& name : names) {
    const std::string path = (folder / name).string();
    pdf = pdf && make_pdf(path + ".svg", path + ".pdf");
    fmt::print(out, "{}.svg{}\n", path, pdf ? ", .csv, .pdf" : ", .csv");
  }
  if (!pdf)
    fmt::print(out, "No PDF: neither rsvg-convert nor inkscape is installed (Debian: librsvg2-bin).\n");
}

}  // namespace frahm::studies
