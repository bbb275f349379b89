#include "engine/shard_log.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/io_error.hpp"
#include "engine/log_format.hpp"
#include "tests/engine/sample_job.hpp"

namespace shard_log_test {
using namespace frahm::engine;
using Catch::Matchers::Contains;

namespace {

const LogHeader study{.fingerprint = {.physics = "9a3f", .grid = "77c0"}, .tiles = 10};

// A log with the tiles 0, 1 and 2; returns the sizes of the file after each, from the empty log on.
std::vector<std::uint64_t> write_three(const std::filesystem::path& path) {
  ShardLog log(path, study);
  std::vector<std::uint64_t> sizes{std::filesystem::file_size(path)};
  for (std::uint64_t tile = 0; tile < 3; ++tile) {
    log.append(tile, sample(tile));
    sizes.push_back(std::filesystem::file_size(path));
  }
  return sizes;
}

// Reads a log alone: its tiles must be the first ones and their bytes right; returns how many.
std::uint64_t good_tiles(const std::filesystem::path& path) {
  std::uint64_t count = 0;
  bool right = true;
  const File file = File::open_if_present(path).value();
  const auto header = read_header(file);
  if (!header) return 0;
  read_entries(file, *header, [&](std::uint64_t tile, auto, std::span<const std::byte> payload) {
    right = right && tile == count && std::ranges::equal(payload, sample(tile));
    ++count;
  });
  CHECK(right);
  return count;
}

}  // namespace

TEST_CASE("a shard log gives back the tiles appended to it, before and after it is opened again") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  write_three(path);
  CHECK(good_tiles(path) == 3);
  {
    ShardLog again(path, study);
    again.append(3, sample(3));
    again.sync();
  }
  CHECK(good_tiles(path) == 4);
}

TEST_CASE("a record of no bytes is a record") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  { ShardLog(path, study).append(7, {}); }
  CHECK(kept_tiles(scratch.output(), study) == std::map<std::uint64_t, Bytes>{{7, {}}});
}

TEST_CASE("a log cut at any byte of its last record keeps the tiles before and takes new ones") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  const auto sizes = write_three(path);
  const std::string whole = read_file(path);
  for (std::uint64_t cut = sizes[2]; cut < sizes[3]; ++cut) {
    INFO("cut at byte " << cut << " of " << sizes[3]);
    write_file(path, whole.substr(0, cut));
    REQUIRE(good_tiles(path) == 2);
    { ShardLog(path, study).append(2, sample(2)); }
    REQUIRE(read_file(path).substr(header_size) == whole.substr(header_size));
  }
}

TEST_CASE("a log cut at any byte of its header is begun anew") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  write_three(path);
  const std::string whole = read_file(path);
  for (std::size_t cut = 0; cut < header_size; ++cut) {
    INFO("cut at byte " << cut);
    write_file(path, whole.substr(0, cut));
    { ShardLog(path, study).append(0, sample(0)); }
    REQUIRE(good_tiles(path) == 1);
  }
}

TEST_CASE("a log whose bytes a power failure left as zeros holds no tile and is begun anew") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  for (const std::size_t size : {header_size - 1, header_size}) {
    INFO(size << " bytes");
    write_file(path, std::string(size, '\0'));
    CHECK(good_tiles(path) == 0);
    CHECK_FALSE(study_of_log(path));
    { ShardLog(path, study).append(0, sample(0)); }
    CHECK(good_tiles(path) == 1);
  }
  // Records come after a header that was synced: zeros in place of both are damage.
  write_file(path, std::string(10 * header_size, '\0'));
  CHECK_THROWS_WITH(ShardLog(path, study), Contains("not a shard log"));
}

TEST_CASE("a bit flipped anywhere in a record cuts the log before that record") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  const auto sizes = write_three(path);
  const std::string whole = read_file(path);
  for (std::uint64_t at = sizes[1]; at < sizes[2]; ++at) {
    INFO("bit " << at % 8 << " of byte " << at);
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    write_file(path, damaged);
    REQUIRE(good_tiles(path) == 1);
  }
}

TEST_CASE("a bit flipped in the header is an error naming the file, except where it tells of the writer") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  write_three(path);
  const std::string whole = read_file(path);
  for (std::uint64_t at = 0; at < header_size; ++at) {
    INFO("byte " << at);
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    write_file(path, damaged);
    if (at < owner_offset) {
      REQUIRE_THROWS_WITH(ShardLog(path, study), Contains(path.string()) && Contains("damaged"));
    } else {
      REQUIRE(good_tiles(path) == 3);
    }
  }
}

TEST_CASE("a file that is no shard log is refused and left as it is") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  for (const std::size_t size : {1UL, 9UL, header_size, 1000UL}) {
    const std::string text(size, 'x');
    write_file(path, text);
    CHECK_THROWS_AS(ShardLog(path, study), IoError);
    CHECK(read_file(path) == text);
    CHECK_THROWS_AS(study_of_log(path), IoError);
  }
}

TEST_CASE("a log of another study is refused with both values and left as it is") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  write_three(path);
  const std::string before = read_file(path);
  const bool other_physics = GENERATE(true, false);
  LogHeader other = study;
  (other_physics ? other.fingerprint.physics : other.fingerprint.grid) = "beef";
  try {
    const ShardLog log(path, other);
    FAIL("not refused");
  } catch (const ResumeRefused& refused) {
    CHECK(refused.kept() == study);
    CHECK(refused.wanted() == other);
    CHECK(refused.physics_differs() == other_physics);
    CHECK_THAT(refused.what(), Contains(path.string()) && Contains("beef"));
    CHECK_THAT(refused.what(), Contains(other_physics ? "9a3f" : "77c0"));
  }
  CHECK(read_file(path) == before);
}

TEST_CASE("a log of another study that keeps nothing is begun anew") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  LogHeader other = study;
  other.fingerprint.physics = "beef";
  const Bytes header = encode_header(other);
  write_file(path, std::string(reinterpret_cast<const char*>(header.data()), header.size()));
  { ShardLog(path, study).append(0, sample(0)); }
  CHECK(study_of_log(path) == study);
}

TEST_CASE("a log without a record is removed when it is closed") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  {
    const ShardLog log(path, study);
    CHECK(std::filesystem::exists(path));
  }
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("a second writer of a log is refused and told who has it") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  write_three(path);
  const ShardLog log(path, study);
  CHECK_THROWS_WITH(ShardLog(path, study), Contains(path.string()) && Contains(this_process()));
  CHECK_THROWS_AS(remove_logs({path}), Locked);
  CHECK(good_tiles(path) == 3);
}

TEST_CASE("a log tells when its present writer began and what that found") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  const auto began = [&] { return read_writer(File::open_if_present(path).value()).value(); };
  const auto before = std::chrono::system_clock::now() - std::chrono::milliseconds(1);
  const auto sizes = write_three(path);
  CHECK(began().good_bytes == header_size);
  CHECK(began().time >= before);
  const auto between = std::chrono::system_clock::now() - std::chrono::milliseconds(1);
  { ShardLog(path, study).append(3, sample(3)); }
  CHECK(began().good_bytes == sizes[3]);
  CHECK(began().time >= between);
  CHECK(began().time <= std::chrono::system_clock::now());
}

TEST_CASE("a log that is older or damaged there does not tell of its writer and keeps its tiles") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  write_three(path);
  const std::string whole = read_file(path), owner = "process 4711 on node17";
  std::string older = whole;
  older.replace(owner_offset, header_size - owner_offset,
                owner + std::string(header_size - owner_offset - owner.size(), '\0'));
  std::vector<std::string> logs{older};
  for (const std::uint64_t at : {owner_offset, owner_offset + owner_size, header_size - 1}) {
    logs.push_back(whole);
    logs.back()[at] = static_cast<char>(whole[at] ^ 1);
  }
  for (const std::string& bytes : logs) {
    write_file(path, bytes);
    CHECK_FALSE(read_writer(File::open_if_present(path).value()).has_value());
    CHECK(good_tiles(path) == 3);
  }
}

TEST_CASE("looking whether a log is in use tells its writer's lock and keeps none") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  write_three(path);
  const File look = File::open_if_present(path).value();
  CHECK_FALSE(look.is_locked());
  {
    const ShardLog log(path, study);
    CHECK(look.is_locked());
  }
  CHECK_FALSE(look.is_locked());
  const ShardLog again(path, study);
}

TEST_CASE("a fingerprint that does not fit is refused before anything is written") {
  const Scratch scratch;
  const auto path = log_path(scratch.output(), "a");
  LogHeader bad = study;
  bad.fingerprint.grid = GENERATE(std::string(), std::string(65, 'a'));
  CHECK_THROWS_AS(ShardLog(path, bad), std::invalid_argument);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("a full disk is an error naming file, operation and reason") {
  File full = File::open_for_writing("/dev/full");
  CHECK_THROWS_WITH(full.write_at(0, sample(1)),
                    Contains("write") && Contains("/dev/full") && Contains("No space left on device"));
}
}  // namespace shard_log_test
