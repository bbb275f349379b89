#include "studies/program/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "engine/io_error.hpp"
#include "engine/output_lock.hpp"
#include "results/part_file.hpp"
#include "studies/program/figure_mark.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/reading/text/readable_file.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

// named: the path given in messages.
void write_file(const std::filesystem::path& path, const std::filesystem::path& named,
                const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) throw engine::IoError(named, "create", errno);
  write(file);
  file.close();
  if (!file) throw engine::IoError(named, "write", errno);
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The names of the columns of a table; a page that is named .csv has one long column.
std::set<std::string> columns_of(const std::filesystem::path& table) {
  std::ifstream file(table, std::ios::binary);
  std::string line;
  std::getline(file, line);
  std::istringstream cells(line);
  std::set<std::string> names;
  for (std::string name; std::getline(cells, name, ',');) names.insert(name);
  return names;
}

bool has_own_columns(const std::filesystem::path& there, const std::filesystem::path& made) {
  const std::set<std::string> old_columns = columns_of(there), columns = columns_of(made);
  if (old_columns.empty() || columns.empty()) return false;
  return std::ranges::includes(old_columns, columns) || std::ranges::includes(columns, old_columns);
}

// By words of its body that are as old as pages are (results/report/page/page.html).
bool is_page(const std::filesystem::path& there) {
  std::ifstream file(there, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    if (line.find("<main id=\"page\"><p class=\"waiting\">Unpacking the results") != std::string::npos)
      return true;
  }
  return false;
}

void check_replaced(const std::filesystem::path& there, const std::filesystem::path& made,
                    Replaces replaces) {
  std::error_code ignored;  // a file that is gone is not replaced
  if (!std::filesystem::is_regular_file(there, ignored) || std::filesystem::is_empty(there, ignored)) return;
  if (replaces == Replaces::own_table && !has_own_columns(there, made))
    throw engine::IoError(
        there, "exists already and is not a table with these columns; name another file, or remove it");
  if (replaces == Replaces::own_page && !is_page(there))
    throw engine::IoError(there,
                          "exists already and is not a page of frahm; name another file, or remove it");
  if (replaces == Replaces::own_figure && !has_figure_mark(text_of(there), there.extension().string()))
    throw engine::IoError(there,
                          "exists already and is not a figure of frahm, or was changed since; name another "
                          "folder, or remove it");
  if (replaces == Replaces::own_text) refuse_other_text(there, text_of(made));
}

}  // namespace

void refuse_other_text(const std::filesystem::path& there, std::string_view text) {
  std::error_code ignored;  // a file that is gone is not replaced
  if (!std::filesystem::is_regular_file(there, ignored) || std::filesystem::is_empty(there, ignored)) return;
  if (text_of(there) == text) return;
  throw engine::IoError(there,
                        "exists already and differs from what would be written, perhaps because it was "
                        "changed by hand; name another file, or remove it");
}

void require_place(const std::filesystem::path& path, const std::filesystem::path& made, Replaces replaces) {
  refuse_link(path);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw engine::IoError(path, "create", EISDIR);
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw engine::IoError(path, "is not a regular file, which would be replaced; remove it");
  check_replaced(path, made, replaces);
}

void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write,
                      Replaces replaces) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw engine::IoError(path, "create", EISDIR);
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    return write_file(path, path, write);
  }
  refuse_link(path);
  require_folder_of(path);
  const engine::OutputLock lock(path);
  results::PartFile part(path);
  write_file(part.part(), path, write);
  if (replaces != Replaces::anything) check_replaced(path, part.part(), replaces);
  part.publish();
}

void write_whole_file(const std::filesystem::path& path, std::string_view text, Replaces replaces) {
  write_whole_file(
      path, [&](std::ostream& file) { file.write(text.data(), static_cast<std::streamsize>(text.size())); },
      replaces);
}

void check_output_is_not_input(const std::filesystem::path& output, const std::filesystem::path& input,
                               std::string_view extension) {
  std::error_code error;
  if (std::filesystem::equivalent(output, input, error))
    throw engine::IoError(output, "is the input file; name another file for the output");
  for (const std::filesystem::path& read : files_read()) {
    if (std::filesystem::equivalent(output, read, error))
      throw engine::IoError(output, "is a file that the study reads; name another file for the output");
  }
  require_folder_of(output);
  if (output.extension() == ".toml" || output.extension() == ".h5") {
    throw StudyError(rules::wrong_file, "{}: has the name of a study or a result; name this output {}",
                     output.string(), extension);
  }
}

}  // namespace frahm::studies
