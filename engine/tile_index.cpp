#include "engine/tile_index.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/bad_entry.hpp"
#include "engine/io_error.hpp"
#include "engine/log_format.hpp"

namespace frahm::engine {
namespace {

constexpr std::string_view log_suffix = ".frahm-log";

// Whether `name` is <output_name>.<writer>.frahm-log with no dot in the writer's name.
bool is_log_name(std::string_view name, std::string_view output_name) {
  if (!name.starts_with(output_name) || !name.ends_with(log_suffix)) return false;
  name.remove_prefix(output_name.size());
  if (name.size() <= log_suffix.size() || !name.starts_with('.')) return false;
  name.remove_suffix(log_suffix.size());
  return name.size() > 1 && name.find('.', 1) == std::string_view::npos;
}

[[noreturn]] void refuse_entry(const std::filesystem::path& log, std::uint64_t tile, std::uint64_t offset,
                               const BadEntry& bad) {
  throw IoError(log, fmt::format("the record of tile {} at byte {} has a correct checksum but wrong content: "
                                 "{}; remove the file to have its tiles computed again",
                                 tile, offset, bad.what()));
}

// Enters the tiles of one log into the index.
void index_log(const File& file, TileIndex& index, const TileVisitor& visit) {
  const std::optional<LogHeader> kept = read_header(file);
  if (!kept) return;
  const bool same_study = *kept == index.study;
  const auto log = static_cast<std::uint32_t>(index.logs.size());
  const LogExtent extent =
      read_entries(file, *kept, [&](std::uint64_t tile, std::uint64_t offset, auto payload) {
        if (!same_study) throw ResumeRefused(file.path(), *kept, index.study);
        if (index.has(tile)) return;
        index.places[tile] = {log, offset};
        try {
          visit(tile, payload);
        } catch (const BadEntry& bad) {
          refuse_entry(file.path(), tile, offset, bad);
        }
      });
  if (!same_study) return;
  index.logs.push_back(file.path());
  if (extent.unused_bytes() > 0) {
    index.unused.push_back({file.path(), extent.good_bytes, extent.unused_bytes()});
  }
}

// Logs held open at a time: a quarter of the files that this process may have open.
int most_open_logs() {
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  return static_cast<int>(std::clamp<rlim_t>(files.rlim_cur / 4, 1, 256));
}

}  // namespace

std::filesystem::path log_path(const std::filesystem::path& output, const std::string& writer) {
  return fmt::format("{}.{}{}", output.string(), writer, log_suffix);
}

std::vector<std::filesystem::path> find_logs(const std::filesystem::path& output) {
  const std::string output_name = output.filename().string();
  std::vector<std::filesystem::path> logs;
  std::error_code error;
  std::filesystem::directory_iterator entry(directory_of(output), error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (is_log_name(name, output_name)) logs.push_back(output.parent_path() / name);
  }
  if (error) throw IoError(directory_of(output), "list", error.value());
  std::ranges::sort(logs);
  return logs;
}

std::optional<LogHeader> study_of_log(const std::filesystem::path& log) {
  const std::optional<File> file = File::open_if_present(log);
  return file ? read_header(*file) : std::nullopt;
}

TileIndex index_tiles(const std::vector<std::filesystem::path>& logs, const LogHeader& study,
                      const TileVisitor& visit) {
  TileIndex index{
      .study = study, .logs = {}, .places = std::vector<TileIndex::Place>(study.tiles), .unused = {}};
  for (const auto& log : logs) {
    if (const std::optional<File> file = File::open_if_present(log)) index_log(*file, index, visit);
  }
  return index;
}

std::vector<std::uint64_t> missing_tiles(const TileIndex& index) {
  std::vector<std::uint64_t> missing;
  for (std::uint64_t tile = 0; tile < index.places.size(); ++tile) {
    if (!index.has(tile)) missing.push_back(tile);
  }
  return missing;
}

TileReader::TileReader(const TileIndex& index)
    : index_(index),
      mark_(study_mark(index.study)),
      most_open_(most_open_logs()),
      files_(index.logs.size()) {}

std::span<const std::byte> TileReader::read(std::uint64_t tile, Bytes& entry) {
  const auto [log, offset] = index_.places[tile];
  const std::shared_ptr<const File> file = open(log);
  if (!read_entry(*file, offset, file->size(), mark_, index_.study.tiles, entry) || tile_of(entry) != tile) {
    throw IoError(
        file->path(),
        fmt::format("the record of tile {} at byte {} has been damaged since it was indexed", tile, offset));
  }
  return payload_of(entry);
}

std::shared_ptr<const File> TileReader::open(std::uint32_t log) {
  const std::lock_guard turn(turn_);
  if (files_[log]) return files_[log];
  if (open_ >= most_open_) {
    std::ranges::fill(files_, nullptr);
    open_ = 0;
  }
  std::optional<File> file = File::open_if_present(index_.logs[log]);
  if (!file) throw IoError(index_.logs[log], "this shard log was removed while its tiles were read");
  files_[log] = std::make_shared<const File>(std::move(*file));
  ++open_;
  return files_[log];
}

void for_each_tile(const TileIndex& index, const TileVisitor& visit) {
  TileReader reader(index);
  Bytes entry;
  for (std::uint64_t tile = 0; tile < index.places.size(); ++tile) {
    if (index.has(tile)) visit(tile, reader.read(tile, entry));
  }
}

void remove_logs(const std::vector<std::filesystem::path>& logs) {
  for (const auto& log : logs) {
    const File held = open_locked(log, owner_offset);
    if (!begins_as_log(held)) throw IoError(log, "is not a shard log and is not removed; rename it");
    std::error_code error;
    std::filesystem::remove(log, error);
    if (error) throw IoError(log, "remove", error.value());
  }
}

std::vector<std::string> remove_free_logs(const std::vector<std::filesystem::path>& logs) {
  std::vector<std::string> in_use;
  for (const auto& log : logs) {
    try {
      remove_logs({log});
    } catch (const Locked& locked) {
      in_use.emplace_back(locked.what());
    }
  }
  return in_use;
}

}  // namespace frahm::engine
