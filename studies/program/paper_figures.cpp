#include "studies/program/paper_figures.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <fstream>
#include <iterator>
#include <ostream>
#include <random>
#include <sstream>
#include <system_error>
#include <vector>

#include "engine/io_error.hpp"
#include "results/report/report_page.hpp"
#include "studies/program/external_program.hpp"
#include "studies/program/figure_mark.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/reading/text/study_source.hpp"

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
      "--figures: it needs the program node, which is not on the PATH (Debian: apt-get install nodejs)");
}

// A folder within that of the figures, in which they are drawn before any is put in its place. It exists only
// while it is needed, and has the drawing script.
class Workshop {
 public:
  explicit Workshop(const std::filesystem::path& folder)
      : path_(folder / fmt::format(".frahm-figures-{:08x}{:08x}", random_(), random_())) {
    make_folder(path_);
    write_whole_file(script(), results::figure_script());
  }
  ~Workshop() {
    std::error_code unimportant;
    std::filesystem::remove_all(path_, unimportant);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path script() const { return path_ / "figures.mjs"; }

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

// Makes the PDFs of drawn figures.  names: of the figures, without their extension.  Returns what to tell.
std::string make_pdfs(const std::vector<std::string>& names, const std::filesystem::path& drawn) {
  std::string problems;
  for (const std::string& name : names) {
    const std::string path = (drawn / name).string();
    const ProgramEnd end = make_pdf(path + ".svg", path + ".pdf");
    if (!end.found) return "No PDF: neither rsvg-convert nor inkscape is installed (Debian: librsvg2-bin).\n";
    if (end.code == 0) continue;
    std::error_code unimportant;
    std::filesystem::remove(path + ".pdf", unimportant);
    problems += fmt::format("No {}.pdf: the converter ended with code {}.\n", name, end.code);
  }
  return problems;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct FigureFile {
  std::filesystem::path drawn, place;
  Replaces replaces = Replaces::own_figure;
};

std::vector<FigureFile> files_of(const std::string& name, const std::filesystem::path& drawn,
                                 const std::filesystem::path& folder) {
  std::vector<FigureFile> files;
  for (const char* extension : {".svg", ".csv", ".pdf"}) {
    const FigureFile file{drawn / (name + extension), folder / (name + extension),
                          extension == std::string_view(".csv") ? Replaces::own_table : Replaces::own_figure};
    if (std::filesystem::exists(file.drawn)) files.push_back(file);
  }
  return files;
}

// Puts drawn figures in their places, all or none, and prints their names.
void place_figures(const std::vector<std::string>& names, const std::filesystem::path& drawn,
                   const std::filesystem::path& folder, std::ostream& out) {
  for (const std::string& name : names) {
    for (const FigureFile& file : files_of(name, drawn, folder))
      require_place(file.place, file.drawn, file.replaces);
  }
  for (const std::string& name : names) {
    std::string made;
    for (const FigureFile& file : files_of(name, drawn, folder)) {
      const std::string extension = file.place.extension().string();
      const bool is_table = file.replaces == Replaces::own_table;
      const std::string text = text_of(file.drawn);
      write_whole_file(file.place, is_table ? text : with_figure_mark(text, extension), file.replaces);
      made += (made.empty() ? "" : ", ") + extension;
    }
    fmt::print(out, "{}{}\n", (folder / name).string(), made);
  }
}

}  // namespace

void write_paper_figures(const std::string& data, const std::filesystem::path& folder, std::ostream& out) {
  require_node();
  make_folder(folder);
  const Workshop workshop(folder);
  const ProgramEnd drawn =
      run_program_of_system("node", {workshop.script().string(), workshop.path().string()}, data);
  const std::vector<std::string> names = lines_of(drawn.output);
  const std::string about_pdfs = make_pdfs(names, workshop.path());
  place_figures(names, workshop.path(), folder, out);
  out << about_pdfs;
  if (drawn.code != 0)
    throw engine::IoError(folder,
                          fmt::format("not all figures could be drawn: node ended with code {}", drawn.code));
  if (names.empty()) fmt::print(out, "This result has no figures; its page has its tables.\n");
}

}  // namespace frahm::studies
