#include "studies/provenance/finished_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "engine/file.hpp"
#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "results/store_error.hpp"
#include "studies/provenance/provenance_checksum.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

engine::Fingerprint fingerprint_of(const results::MapReader& map) {
  return {.physics = provenance_text(map, "fingerprint_physics"),
          .grid = provenance_text(map, "fingerprint_grid")};
}

void refuse_study(const std::filesystem::path& result) {
  if (result.extension() == ".toml")
    throw StudyError(rules::wrong_file,
                     "{}: is a study; name its result, such as {}, which frahm run {} makes", result.string(),
                     result.stem().string() + ".h5", result.string());
}

void refuse_folder(const std::filesystem::path& result) {
  std::error_code ignored;  // what is not there is no folder
  if (std::filesystem::is_directory(result, ignored))
    throw engine::IoError(result, "is a folder, not a result of frahm");
}

void require_result(const std::filesystem::path& path) {
  refuse_folder(path);
  if (std::filesystem::exists(path)) return refuse_study(path);
  if (engine::find_logs(path).empty()) throw engine::IoError(path, "there is no such file");
  throw engine::IoError(
      path,
      "the run that makes it is not finished (frahm status shows how much is done): frahm run completes it, "
      "frahm merge --partial makes a file of the finished part of a map");
}

// The group that holds a result of each kind but a map.
struct OwnGroup {
  const char* group;
  ResultKind kind;
  const char* noun;
};
static constexpr OwnGroup own_groups[] = {{"branches", ResultKind::branch, "a branch"},
                                          {"optimum", ResultKind::tuning, "a tuning"},
                                          {"identification", ResultKind::identification, "an identification"},
                                          {"decay", ResultKind::motion, "one motion"},
                                          {"transient", ResultKind::motion, "one motion"}};

static const OwnGroup* find_own_group(const results::MapReader& result) {
  if (!result.layout().axes.empty()) return nullptr;
  const auto* const own =
      std::ranges::find_if(own_groups, [&](const OwnGroup& each) { return result.has_group(each.group); });
  return own == std::end(own_groups) ? nullptr : own;
}

ResultKind kind_of(const results::MapReader& result) {
  if (!result.layout().axes.empty()) return ResultKind::map;
  const OwnGroup* const own = find_own_group(result);
  return own ? own->kind : ResultKind::motion;
}

std::string noun_of(const results::MapReader& result) {
  if (!result.layout().axes.empty()) return "a map";
  const OwnGroup* const own = find_own_group(result);
  return own ? own->noun : "one motion";
}

std::string own_group(const results::MapReader& result) {
  const OwnGroup* const own = find_own_group(result);
  return own ? own->group : "";
}

bool is_part(const results::MapReader& map) {
  return !provenance_text(map, missing_tiles_text).empty();
}

void refuse_link(const std::filesystem::path& output) {
  std::error_code ignored;  // what is not there is no link
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(output, ignored)))
    throw engine::IoError(output,
                          "is a link, which would be replaced instead of its target; name the file itself");
}

void require_folder_of(const std::filesystem::path& output) {
  const auto words = [](int reason) { return std::generic_category().message(reason); };
  const std::filesystem::path folder = engine::directory_of(output);
  std::error_code error;
  const std::filesystem::file_status found = std::filesystem::status(folder, error);
  if (found.type() == std::filesystem::file_type::not_found)
    throw engine::IoError(output, fmt::format("there is no folder {}: {}", folder.string(), words(ENOENT)));
  if (std::filesystem::exists(found) && !std::filesystem::is_directory(found))
    throw engine::IoError(output, fmt::format("{} is not a folder: {}", folder.string(), words(ENOTDIR)));
}

namespace {

// Whether a file that cannot be read was a result: by its first bytes, of HDF5 and of the attributes of its
// root.
bool begins_as_result(const std::filesystem::path& path) {
  constexpr std::size_t length_of_beginning = 4096;
  std::string beginning(length_of_beginning, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  const auto has = [&](std::string_view word) { return beginning.find(word) != std::string::npos; };
  return beginning.starts_with("\x89HDF\r\n\x1a\n") && has("format_version") && has("frahm");
}

void refuse_name_of_study(const std::filesystem::path& output) {
  if (output.extension() == ".toml")
    throw StudyError(rules::wrong_file,
                     "{}: has the name of a study; the name of this output must end in .h5", output.string());
}

}  // namespace

void check_result_place(const std::filesystem::path& output, const std::filesystem::path& study,
                        std::optional<bool> fresh) {
  std::error_code error;
  if (!std::filesystem::exists(output, error)) {
    refuse_name_of_study(output);
    require_folder_of(output);
    return refuse_link(output);
  }
  if (std::filesystem::equivalent(output, study, error))
    throw engine::IoError(output, "is the study itself; name another file with -o");
  refuse_name_of_study(output);
  if (!std::filesystem::is_regular_file(output, error))
    throw engine::IoError(
        output, "is not a regular file, so a result is not written there; name another file with -o");
  refuse_link(output);
  try {
    const results::MapReader result(output);
  } catch (const results::StoreError& reason) {
    if (!begins_as_result(output))
      throw engine::IoError(
          output, fmt::format("is not a result of frahm; name another file with -o, or remove it ({})",
                              reason.what()));
    if (!fresh.value_or(false))
      throw engine::IoError(
          output, fmt::format("is a result that is damaged or has a later version ({}); {}", reason.what(),
                              fresh ? "--fresh computes it again" : "remove it"));
  }
}

void refuse_damage(const results::MapReader& result, const std::string& advice) {
  try {
    refuse_changed_provenance(result);
    result.check_data(is_part(result) ? results::Completeness::part : results::Completeness::whole);
  } catch (const results::StoreError& reason) {
    throw results::StoreError(reason.what(), "the result is damaged", advice);
  }
}

results::MapReader undamaged_result(const std::filesystem::path& path) {
  require_result(path);
  results::MapReader result(path);
  refuse_damage(result, "frahm run --fresh computes it again");
  return result;
}

std::string provenance_text(const results::MapReader& map, const std::string& name) {
  if (!map.has_group("provenance")) return "";
  for (const auto& [key, text] : map.texts("provenance")) {
    if (key == name) return text;
  }
  return "";
}

}  // namespace frahm::studies
