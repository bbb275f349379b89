#include "studies/reading/data_files/matrix_market.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "studies/reading/text/readable_file.hpp"
#include "studies/reading/text/study_source.hpp"

// CHOLMOD's module Check reads Matrix Market: coordinates and arrays, general and symmetric.
namespace frahm::studies {
namespace {

// The workspace of CHOLMOD, which reports errors by its status alone.
struct Workspace {
  cholmod_common common{};
  Workspace() {
    cholmod_start(&common);
    common.print = 0;
    common.try_catch = 1;
  }
  ~Workspace() { cholmod_finish(&common); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
};

// A file read line by line, comments and empty lines left out.
struct Lines {
  std::ifstream file;
  std::string name, line;
  int number = 0;

  bool next() {
    while (std::getline(file, line)) {
      ++number;
      if (line.find_first_not_of(" \t\r") != std::string::npos && line[0] != '%') return true;
    }
    return false;
  }

  [[noreturn]] void fail(Rule rule, const std::string& problem) const {
    throw StudyError(rule, "{}:{}: {}", name, number, problem);
  }

  // The numbers of the line; a word that is none is an error.
  std::vector<double> numbers() const {
    std::vector<double> found;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const char* first = word.data() + (word[0] == '+' ? 1 : 0);
      const char* end = word.data() + word.size();
      const auto [stopped, error] = std::from_chars(first, end, found.emplace_back());
      if (stopped != end || error != std::errc())
        fail(rules::wrong_row, fmt::format("\"{}\" is not a number", word));
    }
    return found;
  }
};

// The first line, as %%MatrixMarket matrix coordinate real symmetric. CHOLMOD would read files without it,
// and make up the values of a pattern. Returned in lower case.
std::string read_header(Lines& lines) {
  std::string header;
  std::getline(lines.file, header);
  lines.number = 1;
  std::ranges::transform(header, header.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!header.starts_with("%%matrixmarket matrix "))
    lines.fail(rules::wrong_file,
               "is not a Matrix Market file: its first line does not begin with %%MatrixMarket matrix");
  for (const char* form : {"pattern", "complex"}) {
    if (header.find(form) != std::string::npos)
      lines.fail(rules::wrong_file, fmt::format("is a {} matrix; real numbers are needed", form));
  }
  return header;
}

bool is_whole(double number, double least) {
  return number >= least && number == std::floor(number);
}

// Finds the line that is at fault, for CHOLMOD does not tell it, makes room for any size, returns a stray
// pointer for sizes below zero, and takes 1.0D5 for 1.0.
void check_lines(const std::filesystem::path& path, const std::string& name) {
  constexpr double most = 4096;  // of rows or columns
  Lines lines{.file = std::ifstream(path), .name = name, .line = {}};
  const bool is_list = read_header(lines).find("coordinate") != std::string::npos;
  const std::size_t sizes_needed = is_list ? 3 : 2, entry_needs = is_list ? 3 : 1;
  if (!lines.next()) lines.fail(rules::wrong_row, "ends before the sizes of the matrix");
  const std::vector<double> sizes = lines.numbers();
  if (sizes.size() != sizes_needed)
    lines.fail(rules::wrong_row, fmt::format("{} numbers, but the sizes of the matrix are {}", sizes.size(),
                                             is_list ? "rows, columns, entries" : "rows, columns"));
  const double rows = sizes[0], columns = sizes[1];
  if (!is_whole(rows, 1) || !is_whole(columns, 1) || (is_list && !is_whole(sizes[2], 0)))
    lines.fail(rules::wrong_row,
               fmt::format("the sizes {} are not whole numbers of 1 and more", fmt::join(sizes, ", ")));
  if (std::max(rows, columns) > most)
    lines.fail(rules::too_large,
               fmt::format("is {} x {}; at most {} degrees of freedom are read", rows, columns, most));
  double entries = 0.0;
  for (; lines.next(); ++entries) {
    const std::vector<double> entry = lines.numbers();
    if (entry.size() != entry_needs)
      lines.fail(rules::wrong_row, fmt::format("{} numbers, but an entry is {}", entry.size(),
                                               is_list ? "row, column, value" : "a value"));
    if (is_list && !(is_whole(entry[0], 1) && is_whole(entry[1], 1)))
      lines.fail(rules::wrong_row,
                 fmt::format("row {}, column {} of an entry are not whole numbers of 1 and more", entry[0],
                             entry[1]));
    if (is_list && !(entry[0] <= rows && entry[1] <= columns))
      lines.fail(rules::wrong_row, fmt::format("entry ({}, {}) is outside the {} x {} matrix", entry[0],
                                               entry[1], rows, columns));
  }
  if (is_list && entries != sizes[2])
    lines.fail(rules::wrong_row, fmt::format("ends after {} of {} entries", entries, sizes[2]));
}

Eigen::MatrixXd copy_of(const cholmod_dense& dense) {
  const Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>> view(
      static_cast<const double*>(dense.x), static_cast<Eigen::Index>(dense.nrow),
      static_cast<Eigen::Index>(dense.ncol), Eigen::OuterStride<>(static_cast<Eigen::Index>(dense.d)));
  return view;
}

}  // namespace

Eigen::MatrixXd read_matrix_market(const std::filesystem::path& path, const std::string& name) {
  check_readable(path, name);
  check_lines(path, name);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "r"), &std::fclose);
  if (!file) throw StudyError(rules::unreadable_file, "{}: cannot be read", name);
  Workspace work;
  constexpr int kBothTriangles = 1;
  int type = 0;
  void* read = cholmod_read_matrix(file.get(), kBothTriangles, &type, &work.common);
  cholmod_dense* dense = nullptr;
  if (read != nullptr && type == CHOLMOD_SPARSE) {
    auto* sparse = static_cast<cholmod_sparse*>(read);
    dense = cholmod_sparse_to_dense(sparse, &work.common);
    cholmod_free_sparse(&sparse, &work.common);
  } else if (read != nullptr) {
    dense = static_cast<cholmod_dense*>(read);
  }
  if (dense == nullptr || dense->xtype != CHOLMOD_REAL) {
    cholmod_free_dense(&dense, &work.common);
    throw StudyError(rules::wrong_file,
                     "{}: is not a Matrix Market file: its form, sizes or numbers cannot be read", name);
  }
  Eigen::MatrixXd matrix = copy_of(*dense);
  cholmod_free_dense(&dense, &work.common);
  return matrix;
}

}  // namespace frahm::studies
