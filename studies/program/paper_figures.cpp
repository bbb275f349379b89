#include "studies/program/paper_figures.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <ostream>
#include <random>
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

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw engine::IoError(folder, "create", error.value());
}

void require_node() {
  const ProgramEnd version = run_program_of_system("node", {"--version"});
  if (version.found) return;
  throw StudyError(
      rules::not_installed,
      "--figures: needs the program node, which is not on the PATH (Debian: apt-get install nodejs)");
}

// The drawing script, as a file that exists only while it is needed.
class FigureScript {
 public:
  explicit FigureScript(const std::filesystem::path& folder)
      : path_(folder / fmt::format(".frahm-figures-{:08x}{:08x}.mjs", random_(), random_())) {
    write_whole_file(path_, results::figure_script());
  }
  ~FigureScript() {
    std::error_code unimportant;
    std::filesystem::remove(path_, unimportant);
  }
  FigureScript(const FigureScript&) = delete;
  FigureScript& operator=(const FigureScript&) = delete;

  std::string path() const { return path_.string(); }

 private:
  std::random_device random_;  // no file of the folder has the name
  std::filesystem::path path_;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Converts with the first installed converter.
ProgramEnd make_pdf(const std::string& svg, const std::string& pdf) {
  ProgramEnd end = run_program_of_system("rsvg-convert", {"--format=pdf", "--output=" + pdf, svg});
  if (!end.found) end = run_program_of_system("inkscape", {"--export-filename=" + pdf, svg});
  return end;
}

// names: of the figures, without their extension. Prints the files made of each.
void make_pdfs(const std::vector<std::string>& names, const std::filesystem::path& folder,
               std::ostream& out) {
  bool has_converter = true;
  for (const std::string& name : names) {
    const std::string path = (folder / name).string();
    ProgramEnd end;
    if (has_converter) end = make_pdf(path + ".svg", path + ".pdf");
    has_converter = has_converter && end.found;
    const bool made = has_converter && end.code == 0;
    fmt::print(out, "{}.svg, .csv{}\n", path, made ? ", .pdf" : "");
    if (has_converter && !made)
      fmt::print(out, "No {}.pdf: the converter ended with code {}.\n", path, end.code);
  }
  if (!has_converter)
    fmt::print(out, "No PDF: neither rsvg-convert nor inkscape is installed (Debian: librsvg2-bin).\n");
}

}  // namespace

void write_paper_figures(const std::string& data, const std::filesystem::path& folder, std::ostream& out) {
  require_node();
  make_folder(folder);
  const FigureScript script(folder);
  const ProgramEnd drawn = run_program_of_system("node", {script.path(), folder.string()}, data);
  const std::vector<std::string> names = lines_of(drawn.output);
  make_pdfs(names, folder, out);
  if (drawn.code != 0)
    throw engine::IoError(folder,
                          fmt::format("not all figures could be drawn: node ended with code {}", drawn.code));
  if (names.empty()) fmt::print(out, "This result has no figures; its page has its tables.\n");
}

}  // namespace frahm::studies
