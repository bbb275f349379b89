// Any bytes as a result file: all that it says is read, as `status`, `export`, `report` and `run --from` do.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "results/data_reader.hpp"
#include "results/map_reader.hpp"
#include "results/store_error.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/outcome.hpp"

namespace {

using namespace frahm::results;
using frahm::fuzz::Outcome;

// The first numbers of each variable: a corner of the map.
void read_variables(const MapReader& reader) {
  constexpr std::uint64_t most = 16;
  const std::vector<std::uint64_t> shape = shape_of(reader.layout());
  std::vector<std::uint64_t> start(shape.size(), 0), count = shape;
  for (std::uint64_t& extent : count) extent = std::min(extent, most);
  for (std::size_t v = 0; v < reader.layout().variables.size(); ++v) {
    try {
      reader.read(v, start, count);
    } catch (const StoreError&) {
    }
  }
}

void read_groups(const MapReader& reader) {
  for (const std::string& group : reader.groups()) {
    try {
      reader.texts(group);
      reader.columns(group);
    } catch (const StoreError&) {
    }
  }
}

Outcome read_result(const std::filesystem::path& path) {
  try {
    const MapReader reader(path);
    read_variables(reader);
    read_groups(reader);
    return Outcome::read;
  } catch (const StoreError&) {
    return Outcome::refused;
  }
}

// As a file of another program.
void read_data(const std::filesystem::path& path) {
  try {
    const DataReader reader(path);
    for (const char* dataset : {"omega", "F", "/provenance/study", "main_peak"}) {
      try {
        reader.read(dataset);
      } catch (const StoreError&) {
      }
    }
  } catch (const StoreError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const frahm::fuzz::FileInMemory file({data, size});
  const Outcome outcome = read_result(file.path());
  if (outcome == Outcome::refused) read_data(file.path());
  frahm::fuzz::count(outcome);
  return 0;
}
