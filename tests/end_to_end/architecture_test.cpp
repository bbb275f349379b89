// The arrows between the rooms, and each foreign library in a file of its own.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace architecture_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = FRAHM_SOURCE_DIR;
constexpr std::size_t least_files = 100;  // so that an empty folder does not pass

// Room -> what it may include besides itself.
const std::map<std::string, std::set<std::string>> arrows{
    {"solvers", {}}, {"engine", {}}, {"results", {}}, {"studies", {"engine", "solvers", "results"}}};

struct Include {
  fs::path file;  // from the root
  std::string name;
};

std::vector<fs::path> sources_of(const std::string& room) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
    const std::string type = entry.path().extension().string();
    if (type == ".cpp" || type == ".hpp" || type == ".ipp") files.push_back(fs::relative(entry.path(), root));
  }
  return files;
}

std::vector<Include> includes_of(const fs::path& file) {
  static const std::regex form("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"].*");
  std::vector<Include> includes;
  std::ifstream text(root / file);
  std::smatch match;
  for (std::string line; std::getline(text, line);) {
    if (std::regex_match(line, match, form)) includes.push_back({file, match[1]});
  }
  return includes;
}

std::vector<Include> all_includes() {
  std::vector<Include> all;
  for (const auto& [room, allowed] : arrows) {
    for (const auto& file : sources_of(room)) {
      const auto some = includes_of(file);
      all.insert(all.end(), some.begin(), some.end());
    }
  }
  return all;
}

TEST_CASE("rooms include each other only along the arrows") {
  std::size_t files = 0;
  for (const auto& [room, allowed] : arrows) files += sources_of(room).size();
  CHECK(files >= least_files);
  for (const Include& include : all_includes()) {
    const std::string from = include.file.begin()->string(), to = fs::path(include.name).begin()->string();
    if (to == from || !(arrows.contains(to) || to == "tests")) continue;
    INFO(include.file.string() << " includes " << include.name);
    CHECK(arrows.at(from).contains(to));
  }
}

// From the ground up: each folder of a room may include those before it.
using Floors = std::vector<std::string>;
const Floors of_solvers{"laws",     "algebra",    "samples",        "mechanics", "flow",   "events",
                        "orbits",   "quantities", "nonstop",        "exact",     "smooth", "transient",
                        "response", "branches",   "identification", "tuning"};
const Floors of_reading{"text",   "quantities", "keys",  "study", "data_files",
                        "system", "map",        "kinds", "."};  // ".": its own files

void check_floors(const fs::path& room, const Floors& floors) {
  const auto floor_of = [&](const fs::path& file) {
    const std::string folder = file.lexically_relative(room).begin()->string();
    const bool is_own_file = folder == file.filename();
    return std::find(floors.begin(), floors.end(), is_own_file ? "." : folder) - floors.begin();
  };
  for (const auto& file : sources_of(room.string())) {
    const bool is_known = floor_of(file) < static_cast<std::ptrdiff_t>(floors.size());
    INFO(file.string());
    CHECK(is_known);
    for (const Include& include : includes_of(file)) {
      if (!include.name.starts_with(room.string() + "/")) continue;
      INFO("includes " << include.name);
      CHECK(floor_of(include.name) <= floor_of(file));
    }
  }
}

TEST_CASE("a folder of the solvers includes only folders below it") {
  check_floors("solvers", of_solvers);
}

TEST_CASE("a folder of the reading of studies includes only folders below it") {
  check_floors("studies/reading", of_reading);
}

TEST_CASE("no source is a body that does not compile alone") {
  for (const auto& [room, allowed] : arrows) {
    for (const auto& file : sources_of(room)) CHECK(file.extension() != ".ipp");
  }
}

TEST_CASE("our own headers are named from the root of the repository") {
  for (const Include& include : all_includes()) {
    if (!fs::exists((root / include.file).parent_path() / include.name)) continue;
    INFO(include.file.string() << " includes " << include.name);
    CHECK(fs::exists(root / include.name));
  }
}

TEST_CASE("each foreign library is known to one file, and to no header") {
  // HDF5's two files are two halves of one adapter, which share a header of their own.
  const std::map<std::string, std::set<std::string>> adapters{
      {"hdf5", {"results/hdf5.cpp", "results/hdf5_dataset.cpp", "results/hdf5_call.hpp"}},
      {"toml\\+\\+|toml", {"studies/reading/text/toml_reading.cpp"}},
      {"CLI", {"studies/program/command_line.cpp"}},
      {"udunits2", {"studies/reading/quantities/units.cpp"}},
      {"suitesparse/cholmod", {"studies/reading/data_files/matrix_market.cpp"}},
      {"isa-l/crc", {"engine/checksum.cpp"}},
      {"mpi", {"engine/mpi.cpp"}},
      {"libdeflate", {"results/deflate.cpp"}},
      {"cvodes|nvector|sundials|sunlinsol|sunmatrix", {"solvers/smooth/cvodes.cpp"}},
      {"boost/math",
       {"solvers/identification/half_power.cpp", "solvers/identification/identification.cpp",
        "solvers/response/resonance_peak.cpp", "solvers/samples/scatter.cpp",
        "solvers/tuning/exchange/band_maxima.cpp", "solvers/tuning/stages/leap_place.cpp"}},
      {"boost/tokenizer", {"studies/reading/text/csv_table.cpp"}},
      {"boost/random",
       {"solvers/samples/sequence.cpp", "solvers/tuning/stages/starts.cpp",
        "studies/motion/measurements.cpp"}},
      {"Ip.*", {"solvers/tuning/problem/ipopt.cpp"}},
      {"nlopt", {"solvers/tuning/problem/nlopt.cpp"}},
      {"xxhash", {"studies/provenance/digest.cpp"}},
      {"nlohmann",
       {"studies/program/point_json.cpp", "studies/program/schema_command.cpp",
        "results/report/page_data.cpp"}},
      {"boost/archive", {"results/report/page_numbers.cpp"}},
      // The header that the parts of the Python module share, and none else.
      {"pybind11", {"studies/python/binding.hpp"}}};
  std::map<std::string, std::set<std::string>> found;
  for (const Include& include : all_includes()) {
    for (const auto& [library, files] : adapters) {
      if (std::regex_match(include.name, std::regex("(" + library + ")(_hl)?(\\.h|\\.hpp|/.*)"))) {
        found[library].insert(include.file.generic_string());
      }
    }
  }
  for (const auto& [library, files] : adapters) {
    INFO(library);
    CHECK_FALSE(found[library].empty());
    CHECK(std::includes(files.begin(), files.end(), found[library].begin(), found[library].end()));
  }
}

}  // namespace
}  // namespace architecture_test
