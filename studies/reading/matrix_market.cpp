#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

#include "studies/reading/matrix_file.hpp"
#include "studies/reading/readable_file.hpp"
#include "studies/reading/study_source.hpp"

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

// The sizes, in the first line that is no comment: CHOLMOD makes room for whatever they say.
void check_sizes(std::istream& file, const std::string& name) {
  constexpr long most = 4096;  // of rows or columns
  std::string line;
  while (std::getline(file, line) && (line.empty() || line[0] == '%')) {
  }
  std::istringstream sizes(line);
  long rows = 0, columns = 0;
  if (!(sizes >> rows >> columns)) return;  // CHOLMOD says so
  if (std::max(rows, columns) > most)
    throw StudyError(rules::too_large, "{}: is {} x {}; at most {} degrees of freedom are read", name, rows,
                     columns, most);
}

// The first line, as %%MatrixMarket matrix coordinate real symmetric. CHOLMOD would read files without it,
// and make up the values of a pattern.
void check_header(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file(path);
  std::string header;
  std::getline(file, header);
  std::ranges::transform(header, header.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!header.starts_with("%%matrixmarket matrix "))
    throw StudyError(rules::wrong_file,
                     "{}: is no Matrix Market file: its first line does not begin with "
                     "%%MatrixMarket matrix",
                     name);
  for (const char* form : {"pattern", "complex"}) {
    if (header.find(form) != std::string::npos)
      throw StudyError(rules::wrong_file, "{}: is a {} matrix; real numbers are needed", name, form);
  }
  check_sizes(file, name);
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
  check_header(path, name);
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
                     "{}: is no Matrix Market file: its sizes, places or numbers cannot be read", name);
  }
  Eigen::MatrixXd matrix = copy_of(*dense);
  cholmod_free_dense(&dense, &work.common);
  return matrix;
}

}  // namespace frahm::studies
