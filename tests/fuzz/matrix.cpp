// Any bytes as a matrix in the form Matrix Market.
#include <cstddef>
#include <cstdint>

#include "studies/reading/data_files/matrix_file.hpp"
#include "studies/reading/data_files/matrix_market.hpp"
#include "studies/reading/text/study_source.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/outcome.hpp"

using namespace frahm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::FileInMemory file({data, size});
  try {
    studies::read_matrix_market(file.path(), "input.mtx");
    fuzz::count(fuzz::Outcome::read);
  } catch (const studies::StudyError&) {
    fuzz::count(fuzz::Outcome::refused);
  }
  return 0;
}
