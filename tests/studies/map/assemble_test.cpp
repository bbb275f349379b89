#include "studies/map/assemble.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <sstream>
#include <thread>

#include "engine/io_error.hpp"
#include "engine/shard_log.hpp"
#include "engine/tile_index.hpp"
#include "results/map_reader.hpp"
#include "studies/map/tile_entry.hpp"
#include "studies/provenance/assembly_stage.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/studies/temporary_folder.hpp"

namespace assemble_test {
namespace {

using namespace frahm::studies;
using Catch::Matchers::Contains;
using small_studies::axis, small_studies::oscillator;
namespace engine = frahm::engine;
namespace results = frahm::results;

const std::string quantities = "[output]\nquantities = [\"main_peak\", \"friction_stops\", \"status\"]\n";
const std::string two_axes = axis("f", 0, 1, 300) + axis("r", 0.2, 2, 481);
const std::string frequency_first = axis("r", 0.2, 2, 481) + axis("f", 0, 1, 300);
const std::string with_resonances =
    axis("f", 0, 0.3, 40) + axis("r", 0.2, 2, 61) + quantities +
    "resonances = [\"main\"]\norbits = [{ f = 0.1, r = 0.9 }, { f = 0.2, r = 1.1 }, { f = 0.3, r = 0.5 }]\n";

MapPlan plan_of(const std::string& text) {
  return plan_map(parse_study(oscillator() + text, "small.toml"), {});
}

// Values that no two neighbours share, told by the variable and the place in the map.
double value_at(std::size_t variable, std::uint64_t offset) {
  const auto x = static_cast<double>(offset);
  return variable == 0   ? 0.1 * x + 0.25
         : variable == 1 ? static_cast<double>(offset % 1013)
                         : 1.0 + static_cast<double>(offset % 3);
}

// What stands where no tile was finished.
bool is_missing(std::size_t variable, double value) {
  return variable == 0 ? value != value : value == (variable == 1 ? -1.0 : 0.0);
}

std::uint64_t place_of(const Grid& grid, const std::vector<std::uint64_t>& index) {
  std::uint64_t offset = 0;
  for (std::size_t d = 0; d < index.size(); ++d) offset = offset * grid.shape[d] + index[d];
  return offset;
}

// The record of a tile of such values, every point of which fails if so.
engine::Bytes tile_bytes(const MapPlan& plan, std::uint64_t tile, bool failed) {
  const MapBox box = plan.grid.box(tile);
  const std::vector<std::size_t> dimensions{0, 1};
  TileEntry entry;
  for (std::size_t v = 0; v < 3; ++v) {
    std::vector<std::uint64_t> index = box.start;
    do {
      entry.values.push_back(value_at(v, place_of(plan.grid, index)));
    } while (next_point(box, dimensions, index));
  }
  for (std::uint64_t offset = 0; failed && offset < box.points(); ++offset)
    entry.failed.push_back({offset, "tile " + std::to_string(tile)});
  engine::Bytes bytes;
  encode(entry, bytes);
  return bytes;
}

// Two logs with the tiles that `kept` names; every 50th tile has failed.
std::vector<std::filesystem::path> write_logs(const MapPlan& plan, const std::filesystem::path& output,
                                              const std::function<bool(std::uint64_t)>& kept) {
  engine::ShardLog odd(engine::log_path(output, "odd"), plan.log_header());
  engine::ShardLog even(engine::log_path(output, "even"), plan.log_header());
  for (std::uint64_t tile = plan.tiles; tile-- > 0;) {
    if (kept(tile)) (tile % 2 == 0 ? even : odd).append(tile, tile_bytes(plan, tile, tile % 50 == 0));
  }
  return engine::find_logs(output);
}

bool all_tiles(std::uint64_t) {
  return true;
}

AssemblyOptions options_of(const std::filesystem::path& output, int threads, bool partial = false) {
  return {.output = output,
          .logs = engine::find_logs(output),
          .partial = partial,
          .threads = threads,
          .stop_asked = [] { return false; }};
}

Assembly assembled(const MapPlan& plan, const AssemblyOptions& options) {
  const frahm::engine::OutputLock lock(options.output);
  return assemble(plan, {.command = "test", .threads = 1, .started = "then"}, options, lock);
}

// The number of points that are not what the tiles held, or missing where there was no tile.
std::uint64_t wrong_points(const MapPlan& plan, const std::filesystem::path& file,
                           const std::function<bool(std::uint64_t)>& kept) {
  const results::MapReader map(file);
  const std::vector<std::uint64_t> origin{0, 0};
  std::uint64_t wrong = 0;
  for (std::size_t v = 0; v < 3; ++v) {
    const std::vector<double> values = map.read(v, origin, plan.grid.shape);
    std::vector<std::uint64_t> index = origin;
    const MapBox whole{origin, plan.grid.shape};
    const std::vector<std::size_t> dimensions{0, 1};
    do {
      const double value = values[place_of(plan.grid, index)];
      const bool right = kept(plan.grid.tile_of(index)) ? value == value_at(v, place_of(plan.grid, index))
                                                        : is_missing(v, value);
      wrong += right ? 0 : 1;
    } while (next_point(whole, dimensions, index));
  }
  return wrong;
}

std::string text_of(const std::filesystem::path& file, const std::string& name) {
  for (const auto& [text_name, text] : results::MapReader(file).texts("provenance")) {
    if (text_name == name) return text;
  }
  return {};
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

TEST_CASE("a map read back is what its tiles held, on any number of threads and for any order of axes") {
  for (const std::string& axes : {two_axes, frequency_first}) {
    const MapPlan plan = plan_of(axes + quantities);
    REQUIRE(plan.grid.chunks() > 5);
    for (const int threads : {1, 2, 5}) {
      const TemporaryFolder folder;
      write_logs(plan, folder / "map.h5", all_tiles);
      const Assembly assembly = assembled(plan, options_of(folder / "map.h5", threads));
      INFO(threads << " threads, " << axes);
      CHECK(assembly.finished);
      CHECK(assembly.missing_tiles == 0);
      CHECK(wrong_points(plan, folder / "map.h5", all_tiles) == 0);
      CHECK(names_in(folder / "") == std::vector<std::string>{"map.h5"});
    }
  }
}

TEST_CASE(
    "a partial map holds the tiles there are, and missing values where a tile or a whole chunk is not") {
  const MapPlan plan = plan_of(two_axes + quantities);
  const std::uint64_t second_chunk = plan.grid.tile_of(plan.grid.chunk_box(1).start),
                      third_chunk = plan.grid.tile_of(plan.grid.chunk_box(2).start);
  const auto kept = [&](std::uint64_t tile) {
    return tile % 3 != 1 && (tile < second_chunk || tile >= third_chunk);
  };
  for (const int threads : {1, 3}) {
    const TemporaryFolder folder;
    write_logs(plan, folder / "map.h5", kept);
    CHECK_THROWS_AS(assembled(plan, options_of(folder / "map.h5", threads)), engine::IoError);
    const Assembly assembly = assembled(plan, options_of(folder / "map.h5", threads, true));
    INFO(threads << " threads");
    CHECK(assembly.finished);
    CHECK(assembly.missing_tiles > third_chunk - second_chunk);
    CHECK(wrong_points(plan, folder / "map.h5", kept) == 0);
    CHECK(engine::find_logs(folder / "map.h5").size() == 2);
  }
}

TEST_CASE("failed points are counted, and the first thousand told in the order of their tiles") {
  const MapPlan plan = plan_of(two_axes + quantities);
  std::uint64_t failed = 0;
  for (std::uint64_t tile = 0; tile < plan.tiles; tile += 50) failed += plan.grid.box(tile).points();
  REQUIRE(failed > 1000);
  std::string told;
  for (const int threads : {1, 2, 5}) {
    const TemporaryFolder folder;
    write_logs(plan, folder / "map.h5", all_tiles);
    INFO(threads << " threads");
    CHECK(assembled(plan, options_of(folder / "map.h5", threads)).failed_points == failed);
    const std::string text = text_of(folder / "map.h5", "failed_points");
    CHECK(std::ranges::count(text, '\n') == 999);
    CHECK_THAT(text, Catch::StartsWith("f=0,r=0.2: tile 0\n"));
    if (told.empty()) told = text;
    CHECK(text == told);
  }
}

TEST_CASE(
    "an assembly asked to stop, at its logs, its chunks or what is solved after them, leaves all as it was") {
  const MapPlan plan = plan_of(with_resonances);
  REQUIRE(plan.grid.chunks() == 1);
  // At the first log, in the middle of it, at the chunk, the orbits, the resonances.
  const std::uint64_t read = plan.tiles;
  for (const std::uint64_t looks : {std::uint64_t{0}, read / 2, read, read + 1, read + 20}) {
    const TemporaryFolder folder;
    write_logs(plan, folder / "map.h5", all_tiles);
    const auto before = names_in(folder / "");
    AssemblyOptions options = options_of(folder / "map.h5", 2);
    std::atomic<std::uint64_t> looked = 0;
    options.stop_asked = [&] { return looked++ >= looks; };
    INFO("asked at look " << looks);
    CHECK_FALSE(assembled(plan, options).finished);
    CHECK(names_in(folder / "") == before);
  }
}

TEST_CASE("a record that is no tile's ends the assembly with an error and leaves all as it was") {
  const MapPlan plan = plan_of(two_axes + quantities);
  for (const int threads : {1, 4}) {
    const TemporaryFolder folder;
    const std::uint64_t bad = plan.tiles / 2;
    write_logs(plan, folder / "map.h5", [&](std::uint64_t tile) { return tile != bad; });
    engine::ShardLog(engine::log_path(folder / "map.h5", "bad"), plan.log_header())
        .append(bad, engine::Bytes(100));
    const auto before = names_in(folder / "");
    CHECK_THROWS_WITH(assembled(plan, options_of(folder / "map.h5", threads)),
                      Contains("shorter than its header says"));
    CHECK(names_in(folder / "") == before);
  }
}

TEST_CASE("resonances and kept orbits are the same on any number of threads") {
  const MapPlan plan = plan_of(with_resonances);
  std::vector<std::vector<double>> first;
  for (const int threads : {1, 2, 5}) {
    const TemporaryFolder folder;
    write_logs(plan, folder / "map.h5", all_tiles);
    REQUIRE(assembled(plan, options_of(folder / "map.h5", threads)).finished);
    std::vector<std::vector<double>> found;
    const results::MapReader map(folder / "map.h5");
    for (const char* group : {"resonance", "orbits"}) {
      for (const results::Column& column : map.columns(group)) found.push_back(column.values);
    }
    INFO(threads << " threads");
    REQUIRE(found.size() > 6);
    CHECK(found[0].size() == 40);
    CHECK(std::ranges::is_sorted(found[0]));  // the friction, a curve each
    if (first.empty()) first = found;
    CHECK(found == first);
  }
}

TEST_CASE("a mass that sticks has no resonance, though rounding moves it") {
  std::string text = oscillator() + small_studies::axis_of("f", "[0.2, 1.11864406779661]") +
                     axis("r", 0.1, 2.5, 481) + quantities + "resonances = [\"main\"]\n";
  const std::string damping = "zeta = 0.05";
  text.replace(text.find(damping), damping.size(), "zeta = 0.1650485436893204");
  const MapPlan plan = plan_map(parse_study(text, "small.toml"), {});
  const TemporaryFolder folder;
  write_logs(plan, folder / "map.h5", all_tiles);
  REQUIRE(assembled(plan, options_of(folder / "map.h5", 2)).finished);
  const auto columns = results::MapReader(folder / "map.h5").columns("resonance");
  REQUIRE(columns.at(1).variable.name == "main_resonance_frequency");
  CHECK_THAT(columns[1].values.at(0), Catch::WithinAbs(1.0, 0.1));
  CHECK(std::isnan(columns[1].values.at(1)));
  CHECK(std::isnan(columns.at(2).values.at(1)));
}

// What a stage of pieces that take so long says on stderr.
std::string said_by_stage(std::chrono::milliseconds each, engine::ProgressStyle style) {
  const AssemblyOptions options{
      .output = {}, .logs = {}, .threads = 2, .progress = style, .stop_asked = [] { return false; }};
  const engine::PieceWork work = [each](std::uint64_t) {
    std::this_thread::sleep_for(each);
    return [] {};
  };
  std::ostringstream said;
  auto* before = std::cerr.rdbuf(said.rdbuf());
  carry_out({.name = "writing",
             .pieces = 6,
             .points = 600,
             .points_of = [](std::uint64_t) { return 100; },
             .make_work = [&] { return work; }},
            options);
  std::cerr.rdbuf(before);
  return said.str();
}

TEST_CASE("an assembly that takes longer than a second shows its progress, and a quick one says nothing",
          "[slow]") {
  using namespace std::chrono_literals;
  CHECK(said_by_stage(0ms, engine::ProgressStyle::plain).empty());
  CHECK(said_by_stage(500ms, engine::ProgressStyle::none).empty());
  const std::string said = said_by_stage(500ms, engine::ProgressStyle::plain);
  CHECK_THAT(said, Catch::StartsWith("writing ") && Contains(" left\n") &&
                       Contains("writing 100.0 %  600/600 points"));
}

}  // namespace
}  // namespace assemble_test
