#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <thread>

#include "results/map_reader.hpp"
#include "results/map_writer.hpp"
#include "results/store_error.hpp"
#include "sample.hpp"
#include "temporary_directory.hpp"
#include "whole_map.hpp"

namespace test_map {
using namespace frahm::results;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

// Equal, where NaN equals NaN.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (x != x && y != y); });
}

void check_same(const Variable& a, const Variable& b) {
  CHECK(a.name == b.name);
  CHECK(a.unit == b.unit);
  CHECK(a.long_name == b.long_name);
  CHECK(a.type == b.type);
  REQUIRE(a.flags.size() == b.flags.size());
  for (std::size_t k = 0; k < a.flags.size(); ++k) {
    CHECK(a.flags[k].meaning == b.flags[k].meaning);
    CHECK(a.flags[k].value == b.flags[k].value);
  }
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::array<std::uint64_t, 2> origin{0, 0}, whole{sample::designs, sample::frequencies};

}  // namespace

TEST_CASE("a map read back has the layout it was written with") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  const MapLayout written = sample::layout();
  const MapLayout& read = reader.layout();
  CHECK(read.title == written.title);
  CHECK(read.source == written.source);
  CHECK(read.history == written.history);
  CHECK(read.chunk == written.chunk);
  REQUIRE(read.axes.size() == written.axes.size());
  for (std::size_t k = 0; k < written.axes.size(); ++k) {
    CHECK(read.axes[k].name == written.axes[k].name);
    CHECK(read.axes[k].size == written.axes[k].size);
    REQUIRE(read.axes[k].coordinates.size() == written.axes[k].coordinates.size());
    for (std::size_t c = 0; c < written.axes[k].coordinates.size(); ++c) {
      const Coordinate &a = read.axes[k].coordinates[c], &b = written.axes[k].coordinates[c];
      CHECK(a.name == b.name);
      CHECK(a.unit == b.unit);
      CHECK(a.long_name == b.long_name);
      CHECK(a.values == b.values);
    }
  }
  REQUIRE(read.variables.size() == written.variables.size());
  for (std::size_t v = 0; v < written.variables.size(); ++v)
    check_same(read.variables[v], written.variables[v]);
}

TEST_CASE(
    "a map whose chunks are put together from tiles reads back, with missing values where nothing was "
    "written") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  for (std::size_t v = 0; v < reader.layout().variables.size(); ++v) {
    std::vector<double> expected;
    for (std::size_t i = 0; i < sample::designs; ++i) {
      for (std::size_t j = 0; j < sample::frequencies; ++j) expected.push_back(sample::value(v, i, j));
    }
    INFO(reader.layout().variables[v].name);
    CHECK(same(reader.read(v, origin, whole), expected));
  }
}

TEST_CASE(
    "a chunk never written is missing in every variable, and the others stand, in whatever order they came") {
  const TemporaryDirectory directory;
  const MapLayout layout = sample::layout();
  {
    MapWriter writer(directory / "map.h5", layout);
    MapChunk chunk(layout);
    for (const std::uint64_t from : {64u, 0u}) {
      chunk.begin({2, from});
      chunk.put(sample::peak, {{3, from + 5}, {1, 1}}, std::vector{static_cast<double>(from) + 0.5});
      writer.write_chunk(chunk.encoded());
    }
    writer.finish();
  }
  const MapReader reader(directory / "map.h5");
  std::vector<double> expected(sample::designs * sample::frequencies, missing);
  expected[3 * sample::frequencies + 5] = 0.5;
  expected[3 * sample::frequencies + 69] = 64.5;
  CHECK(same(reader.read(sample::peak, origin, whole), expected));
  CHECK(same(reader.read(sample::stops, origin, whole), std::vector<double>(expected.size(), -1.0)));
  CHECK(same(reader.read(sample::regime, origin, whole), std::vector<double>(expected.size(), 0.0)));
}

TEST_CASE("a box of a map reads as the same box of the whole") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  const std::vector<double> box =
      reader.read(sample::stops, std::array<std::uint64_t, 2>{1, 30}, std::array<std::uint64_t, 2>{3, 5});
  std::vector<double> expected;
  for (std::size_t i = 1; i < 4; ++i) {
    for (std::size_t j = 30; j < 35; ++j) expected.push_back(sample::value(sample::stops, i, j));
  }
  CHECK(box == expected);
  CHECK(reader.read(sample::stops, origin, std::array<std::uint64_t, 2>{0, 5}).empty());
}

TEST_CASE("a map of one axis keeps variables and derived coordinates apart") {
  const TemporaryDirectory directory;
  Axis axis{.name = "r", .size = 3};
  axis.coordinates = {{"r", "1", "frequency ratio", {0.5, 1.0, 1.5}},
                      {"omega", "rad s-1", "frequency", {5, 10, 15}}};
  const MapLayout layout{
      .axes = {axis}, .variables = {{.name = "x", .unit = "m", .long_name = "x"}}, .chunk = {1000}};
  {
    MapWriter writer(directory / "map.h5", layout);
    write_whole_map(writer, layout, {{1.0, missing, 3.0}});
    writer.finish();
  }
  const MapReader reader(directory / "map.h5");
  REQUIRE(reader.layout().variables.size() == 1);
  CHECK(reader.layout().chunk == std::vector<std::uint64_t>{3});
  REQUIRE(reader.layout().axes.at(0).coordinates.size() == 2);
  CHECK(reader.layout().axes[0].coordinates[1].values == std::vector<double>{5, 10, 15});
  CHECK(same(reader.read(0, std::array<std::uint64_t, 1>{0}, std::array<std::uint64_t, 1>{3}),
             {1.0, missing, 3.0}));
}

TEST_CASE("a group may hold a map of its own, on its own axes") {
  const TemporaryDirectory directory;
  Axis r{.name = "r", .size = 2}, design{.name = "design", .size = 3};
  r.coordinates = {{"r", "1", "frequency ratio", {0.5, 1.0}}};
  design.coordinates = {{"k", "N m-1", "stiffness", {1, 2, 3}}};
  const Variable x{.name = "x", .unit = "m", .long_name = "x"};
  const MapLayout map{.axes = {r}, .variables = {x}, .chunk = {2}};
  const MapLayout of_group{
      .axes = {design, r},
      .variables = {{.name = "x_mean", .unit = "m", .long_name = "mean"},
                    {.name = "n", .unit = "1", .long_name = "number", .type = Type::int32}},
      .chunk = {2, 2}};
  {
    MapWriter writer(directory / "map.h5", map);
    const std::size_t number = writer.create_map("statistics", of_group);
    MapChunk chunk(of_group);
    for (const std::uint64_t start : {0U, 2U}) {
      const Box box{{start, 0}, {start == 0 ? 2U : 1U, 2}};
      chunk.begin({start, 0});
      chunk.put(0, box, start == 0 ? std::vector<double>{1, 2, 3, missing} : std::vector<double>{5, 6});
      writer.write_chunk(number, chunk.encoded());
    }
    write_whole_map(writer, map, {{7.0, 8.0}});
    CHECK_THROWS_AS(writer.write_chunk(2, chunk.encoded()), std::invalid_argument);
    writer.finish();
  }
  const MapReader root(directory / "map.h5"), group(directory / "map.h5", "statistics");
  CHECK(root.layout().variables.size() == 1);
  CHECK(root.read(0, std::array<std::uint64_t, 1>{0}, std::array<std::uint64_t, 1>{2}) ==
        std::vector<double>{7.0, 8.0});
  REQUIRE(group.layout().axes.size() == 2);
  CHECK(group.layout().axes[0].name == "design");
  CHECK(group.layout().axes[0].coordinates.at(0).values == std::vector<double>{1, 2, 3});
  CHECK(group.layout().axes[1].coordinates.at(0).values == std::vector<double>{0.5, 1.0});
  const std::array<std::uint64_t, 2> all{3, 2};
  CHECK(same(group.read(0, origin, all), {1, 2, 3, missing, 5, 6}));
  CHECK(group.read(1, origin, all) == std::vector<double>(6, -1));
  CHECK_THROWS_AS(MapReader(directory / "map.h5", "tornado"), StoreError);
}

TEST_CASE("a file may hold groups only, without a map") {
  const TemporaryDirectory directory;
  {
    MapWriter writer(directory / "decay.h5", {.title = "free decay"});
    writer.write_columns(
        "decay", {{.variable = {.name = "stop_time", .unit = "s", .long_name = "stop"}, .values = {2.5}}});
    writer.finish();
  }
  const MapReader reader(directory / "decay.h5");
  CHECK(reader.layout().axes.empty());
  CHECK(reader.layout().variables.empty());
  CHECK(reader.columns("decay").at(0).values == std::vector<double>{2.5});
}

TEST_CASE("numbers at the limits of their types survive") {
  const TemporaryDirectory directory;
  const Axis axis{.name = "point", .size = 4};
  const std::map<Type, std::vector<double>> limits = {
      {Type::float64,
       {std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min(), -0.0, 1.0 / 3.0}},
      {Type::float32,
       {std::numeric_limits<float>::max(), std::numeric_limits<float>::denorm_min(), -0.0, 0.125}},
      {Type::int32, {2147483647.0, -2147483647.0, 0.0, -1.0}},
      {Type::int64, {9007199254740992.0, -9007199254740992.0, 0.0, -1.0}},
      {Type::flag, {0.0, 127.0, 1.0, 0.0}}};
  for (const auto& [type, values] : limits) {
    Variable variable{.name = "x", .unit = "1", .long_name = "x", .type = type};
    if (type == Type::flag) {
      variable.unit.clear();
      variable.flags = {{"not_computed", 0}, {"ok", 1}, {"last", 127}};
    }
    const MapLayout layout{.axes = {axis}, .variables = {variable}, .chunk = {4}};
    {
      MapWriter writer(directory / "map.h5", layout);
      write_whole_map(writer, layout, {values});
      writer.finish();
    }
    const MapReader reader(directory / "map.h5");
    CHECK(reader.layout().variables.at(0).type == type);
    CHECK(reader.read(0, std::array<std::uint64_t, 1>{0}, std::array<std::uint64_t, 1>{4}) == values);
  }
}

TEST_CASE("the same data give the same bytes at another time") {
  const TemporaryDirectory directory;
  sample::write(directory / "a.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's times, if kept, are in seconds
  sample::write(directory / "b.h5");
  CHECK(bytes_of(directory / "a.h5") == bytes_of(directory / "b.h5"));
}

TEST_CASE("a finished file replaces the one before in one step and leaves no part") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader before(directory / "map.h5");
  sample::write(directory / "map.h5");
  CHECK(before.layout().title == "Sample");
  CHECK_NOTHROW(before.read(sample::peak, origin, whole));  // the old file lives on for who has it open
  CHECK(directory.parts() == 0);
}
}  // namespace test_map
