#include "studies/map/earlier_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>

#include "engine/io_error.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";  // HDF5 file format, III.A: superblock

void check_is_hdf5(const std::filesystem::path& path) {
  std::error_code ignored;  // opening reports the error
  const std::filesystem::file_status kind = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(kind))
    throw engine::IoError(path, "is a folder; --from needs the result of a map");
  if (std::filesystem::exists(kind) && !std::filesystem::is_regular_file(kind))
    throw engine::IoError(path, "is a pipe or a device; --from needs the result of a map");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw engine::IoError(path, "open", errno);
  std::array<char, hdf5_signature.size()> start = {};
  file.read(start.data(), start.size());
  if (std::string_view(start.data(), start.size()) != hdf5_signature)
    throw engine::IoError(path, "is not an HDF5 file; --from needs the result of a map");
}

}  // namespace

results::MapReader open_earlier_map(const std::filesystem::path& file) {
  check_is_hdf5(file);
  results::MapReader result(file);
  if (kind_of(result) == ResultKind::map) return result;
  throw StudyError(rules::wrong_option, "--from {}: is {}, not a map: there is no point to reuse",
                   file.string(), noun_of(result));
}

}  // namespace frahm::studies
