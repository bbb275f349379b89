#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <thread>

#include "results/hdf5.hpp"
#include "results/map_chunk.hpp"
#include "results/map_reader.hpp"
#include "results/map_writer.hpp"
#include "results/part_file.hpp"
#include "results/store_error.hpp"
#include "sample.hpp"
#include "temporary_directory.hpp"
#include "whole_map.hpp"

namespace test_refusals {
using namespace frahm::results;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
const std::array<std::uint64_t, 2> origin{0, 0}, one{1, 1};

// What is thrown, with its type; empty if nothing is.
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const StoreError& error) {
    return std::string("StoreError: ") + error.what();
  } catch (const std::invalid_argument& error) {
    return std::string("invalid_argument: ") + error.what();
  }
  return "";
}

// As long as it lives, what the process prints on stderr goes to a file.
class StderrInFile {
 public:
  explicit StderrInFile(const std::filesystem::path& path) : before_(::dup(STDERR_FILENO)) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, STDERR_FILENO);
    ::close(file);
  }
  StderrInFile(const StderrInFile&) = delete;
  StderrInFile& operator=(const StderrInFile&) = delete;
  ~StderrInFile() {
    ::dup2(before_, STDERR_FILENO);
    ::close(before_);
  }

 private:
  int before_;
};

// The refusal of the sample's layout after a change.
std::string refusal_of(const std::function<void(MapLayout&)>& change) {
  MapLayout layout = sample::layout();
  change(layout);
  return refusal([&] { check(layout); });
}

void write_at(const std::filesystem::path& path, std::streamoff offset, const std::string& bytes) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(offset);
  file << bytes;
}

}  // namespace

TEST_CASE("a layout that would not open everywhere is refused by name and rule") {
  CHECK(refusal_of([](MapLayout&) {}).empty());
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[0].name = "main peak"; }),
             Contains("'main peak'") && Contains("[A-Za-z][A-Za-z0-9_]*"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[0].name = "1st"; }), Contains("'1st'"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[1].name = "omega"; }),
             Contains("'omega'") && Contains("once"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.axes[0].coordinates[0].name = "frequency_ratio"; }),
             Contains("once"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[0].unit = ""; }),
             Contains("'main_peak'") && Contains("unit"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[0].long_name = ""; }), Contains("long_name"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[4].unit = "1"; }), Contains("'status'"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[4].flags = {{"ok", 1}}; }), Contains("not_computed"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[4].flags[2].value = 128; }),
             Contains("grazing = 128"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[4].flags[2].value = 1; }), Contains("used once"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.variables[4].flags[2].meaning = "a b"; }), Contains("'a b'"));
  CHECK_THAT(refusal_of([](MapLayout& l) {
               l.variables[0].flags = {{"not_computed", 0}};
             }),
             Contains("flag only"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.axes[1].size = 71; }), Contains("70 values") && Contains("71"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.axes[1].coordinates[0].values[3] = missing; }),
             Contains("finite"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.axes[1].coordinates[1].unit = ""; }),
             Contains("'frequency_ratio'"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.axes[1] = {.name = "omega", .size = 0}; }), Contains("size 0"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.chunk = {64}; }), Contains("1 dimensions") && Contains("2"));
  CHECK_THAT(refusal_of([](MapLayout& l) { l.chunk = {0, 64}; }), Contains("chunk"));
  CHECK_THAT(refusal([] { check(MapLayout{.variables = {{.name = "x", .unit = "m", .long_name = "x"}}}); }),
             Contains("without axes"));
}

TEST_CASE("columns and rows that do not fit together are refused") {
  const Variable x{.name = "x", .unit = "m", .long_name = "x"}, y{.name = "y", .unit = "m", .long_name = "y"};
  CHECK_THAT(refusal([&] {
               check(std::vector<Column>{{x, "t", {1, 2}}, {y, "t", {1}}});
             }),
             Contains("'y': 1 values"));
  CHECK_THAT(refusal([&] { check(std::vector<Column>{{x, "", {1, 2}}}); }), Contains("must be 1"));
  CHECK_THAT(refusal([&] {
               check(std::vector<Column>{{x, "y", {1}}, {y, "t", {1}}});
             }),
             Contains("dimension 'y'"));
  CHECK_THAT(
      refusal([&] { check(RaggedLayout{.group = "orbits", .row = "orbit", .sample_variables = {x}}); }),
      Contains("samples must have a dimension"));
  CHECK_THAT(refusal([&] { check(RaggedLayout{.group = "a/b", .row = "orbit"}); }), Contains("'a/b'"));

  const TemporaryDirectory directory;
  MapWriter writer(directory / "map.h5", {});
  const std::size_t table =
      writer.create_ragged({.group = "orbits",
                            .row = "orbit",
                            .row_variables = {x},
                            .sample = "s",
                            .sample_variables = {y, {.name = "z", .unit = "m", .long_name = "z"}}});
  CHECK_THAT(refusal([&] { writer.append_ragged(table, {}, {}); }),
             Contains("'orbits'") && Contains("must be 1 and 2"));
  CHECK_THAT(
      refusal([&] {
        writer.append_ragged(table, std::vector{1.0}, std::vector<std::vector<double>>{{1.0}, {1.0, 2.0}});
      }),
      Contains("must be equal"));
  CHECK_THAT(refusal([&] { writer.append_ragged(7, {}, {}); }), Contains("table 7"));
}

TEST_CASE("a value its type cannot hold is refused by variable, value and rule") {
  const MapLayout layout = sample::layout();
  MapChunk chunk(layout);
  const auto write = [&](std::size_t variable, double value) {
    return refusal([&] { chunk.put(variable, {{0, 0}, {1, 1}}, std::vector<double>{value}); });
  };
  CHECK(write(sample::peak, missing).empty());
  CHECK_THAT(write(sample::stops, missing), Contains("'guide_stops': value nan: must be a whole number"));
  CHECK_THAT(write(sample::stops, 1.5), Contains("1.5"));
  CHECK_THAT(write(sample::stops, 2147483648.0), Contains("int32"));
  CHECK_THAT(write(sample::regime, 6.0), Contains("'guide_regime': value 6: must be one of its flag values"));
  CHECK_THAT(write(sample::regime, missing), Contains("flag values"));
  CHECK_THAT(write(sample::regime, -1.0), Contains("flag values"));
  CHECK_THAT(write(sample::phase, 1e39), Contains("float32"));
}

TEST_CASE("a block outside its chunk or the map, or with other than its values, is refused") {
  const MapLayout layout = sample::layout();
  MapChunk chunk(layout);
  chunk.begin({4, 64});  // its last design and its last 26 frequencies are beyond the map's edge
  const auto put = [&](std::vector<std::uint64_t> start, std::vector<std::uint64_t> count,
                       std::size_t values) {
    return refusal([&] { chunk.put(0, {start, count}, std::vector<double>(values)); });
  };
  CHECK(put({4, 64}, {1, 6}, 6).empty());
  CHECK_THAT(
      put({4, 64}, {1, 7}, 7),
      Contains("main_peak: block of [1, 7] at [4, 64]: must lie within the chunk of [1, 6] at [4, 64]"));
  CHECK_THAT(put({3, 64}, {1, 6}, 6), Contains("must lie within"));
  CHECK_THAT(put({5, 64}, {1, 6}, 6), Contains("must lie within"));
  CHECK_THAT(put({4, 65}, {1, std::numeric_limits<std::uint64_t>::max()}, 1), Contains("must lie within"));
  CHECK_THAT(put({4}, {1}, 1), Contains("must lie within"));
  CHECK_THAT(put({4, 64}, {1, 3}, 5), Contains("5 values for a block of [1, 3]"));
  CHECK_THAT(refusal([&] { chunk.put(5, {{4, 64}, {1, 1}}, std::vector{1.0}); }), Contains("variable 5"));
}

TEST_CASE("a chunk that does not begin where the map has one is refused, and one of other variables") {
  const MapLayout layout = sample::layout();
  MapChunk chunk(layout);
  const auto begin = [&](std::vector<std::uint64_t> start) { return refusal([&] { chunk.begin(start); }); };
  CHECK(begin({2, 32}).empty());
  CHECK_THAT(begin({1, 32}),
             Contains("chunk at [1, 32]: must begin at a multiple of [2, 32] within [5, 70]"));
  CHECK_THAT(begin({6, 0}), Contains("must begin"));
  CHECK_THAT(begin({0}), Contains("must begin"));
  const TemporaryDirectory directory;
  MapWriter writer(directory / "map.h5", layout);
  EncodedChunk encoded = chunk.encoded();
  encoded.variables.pop_back();
  CHECK_THAT(refusal([&] { writer.write_chunk(encoded); }), Contains("chunk of 4 variables: must be 5"));
}

TEST_CASE("a text that is not UTF-8 is refused") {
  const TemporaryDirectory directory;
  MapWriter writer(directory / "map.h5", {});
  const auto write = [&](const std::string& text) {
    return refusal([&] { writer.write_texts("provenance", {{"t" + std::to_string(text.size()), text}}); });
  };
  CHECK(write("plain ζ 漢 😀").empty());
  for (const std::string bad :
       {"\xff", "a\x80", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe6\xbc"}) {
    CHECK_THAT(write(bad), Contains("must be UTF-8"));
  }
  CHECK_THAT(write(std::string("a\0b", 3)), Contains("byte 1 (0x00)"));
}

TEST_CASE("an unfinished file leaves nothing behind and the finished one before it alone") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  {
    MapWriter writer(directory / "map.h5", {.title = "another"});
    CHECK(directory.parts() == 1);
  }
  CHECK(directory.parts() == 0);
  CHECK(MapReader(directory / "map.h5").layout().title == "Sample");
}

TEST_CASE("a part that a killed process left is removed, copied to another disk too; files of others stay") {
  const TemporaryDirectory directory;
  const std::string dead = "map.h5.part-0f1e2d3cf0e1d2c3", foreign = "map.h5.part-0f1e2d3cf0e1d2c4";
  for (const std::string& name : {dead, foreign}) std::ofstream(directory / name) << "half a file";
  sample::write(directory / "map.h5");
  CHECK_FALSE(std::filesystem::exists(directory / dead));
  CHECK(std::filesystem::exists(directory / foreign));
}

TEST_CASE("a part that another machine took for a dead one is told as such: it is to be written again") {
  const TemporaryDirectory directory;
  frahm::results::PartFile taken(directory / "note"), whole(directory / "note");
  std::filesystem::remove(taken.part());
  taken.write("lost");  // to the file that has no name any more
  CHECK_THROWS_AS(taken.publish(), frahm::results::PartTaken);
  CHECK_FALSE(std::filesystem::exists(directory / "note"));
  whole.write("wh");
  whole.write("ole");
  whole.publish();
  std::string text;
  std::ifstream(directory / "note") >> text;
  CHECK(text == "whole");
  CHECK(directory.parts() == 0);
}

TEST_CASE("a layout refused leaves nothing behind") {
  const TemporaryDirectory directory;
  MapLayout layout = sample::layout();
  layout.variables[0].unit.clear();
  CHECK_THAT(refusal([&] { MapWriter(directory / "map.h5", layout); }), Contains("invalid_argument"));
  CHECK(directory.parts() == 0);
}

TEST_CASE("a place that cannot be written is a StoreError with path and cause") {
  const TemporaryDirectory directory;
  CHECK_THAT(refusal([&] { MapWriter(directory / "absent" / "map.h5", {}); }),
             Contains("StoreError") && Contains("absent/map.h5") && Contains("No such file or directory"));
  std::ofstream(directory / "file") << "a file, not a directory";
  CHECK_THAT(refusal([&] { MapWriter(directory / "file" / "map.h5", {}); }), Contains("Not a directory"));
  if (::geteuid() != 0) {  // root may write anywhere
    std::filesystem::create_directory(directory / "closed");
    std::filesystem::permissions(directory / "closed", std::filesystem::perms::owner_read);
    CHECK_THAT(refusal([&] { MapWriter(directory / "closed" / "map.h5", {}); }),
               Contains("Permission denied"));
  }
}

TEST_CASE("a path taken by a directory is refused at the end and the part removed") {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory / "map.h5");
  CHECK_THAT(refusal([&] { sample::write(directory / "map.h5"); }),
             Contains("cannot rename") && Contains("directory"));
  CHECK(directory.parts() == 0);
}

TEST_CASE("a file that is not ours is refused, and why") {
  const TemporaryDirectory directory;
  const auto open = [&](const std::string& name) { return refusal([&] { MapReader(directory / name); }); };
  CHECK_THAT(open("absent.h5"), Contains("StoreError") && Contains("absent.h5") && Contains("No such file"));
  std::ofstream(directory / "text.h5") << "not HDF5 at all";
  CHECK_THAT(open("text.h5"), Contains("text.h5") && Contains("signature"));
  hdf5::File::create(directory / "foreign.h5").close();
  CHECK_THAT(open("foreign.h5"), Contains("must be a Frahm result"));
  {
    hdf5::File file = hdf5::File::create(directory / "newer.h5");
    hdf5::Group root = file.root();
    root.write_text("format", "frahm");
    const double version = 2;
    root.write_numbers("format_version", {.name = "v", .type = Type::int32}, {&version, 1});
  }
  CHECK_THAT(open("newer.h5"), Contains("format_version 2") && Contains("must be 1 to 1"));
}

TEST_CASE("reading what is not there is refused") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  CHECK_THAT(refusal([&] {
               reader.read(0, origin, std::array<std::uint64_t, 2>{5, 71});
             }),
             Contains("must lie within"));
  CHECK_THAT(refusal([&] { reader.read(5, origin, one); }), Contains("variable 5"));
  CHECK_THAT(refusal([&] { reader.columns("decay"); }),
             Contains("map.h5:/decay") && Contains("cannot open the group"));
}

TEST_CASE(
    "a write that fails in a thread that did not open the file is thrown there, and HDF5 prints nothing") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  hdf5::File to_read = hdf5::File::open(directory / "map.h5");
  hdf5::Dataset peak = to_read.root().dataset("main_peak");
  const StderrInFile printed(directory / "stderr");
  std::string chunk_refusal, growth_refusal;
  std::jthread([&] { chunk_refusal = refusal([&] { peak.write_chunk(Shape{0, 0}, Bytes(10)); }); }).join();
  std::jthread([&] { growth_refusal = refusal([&] { peak.grow(6); }); }).join();
  CHECK_THAT(chunk_refusal, Contains("map.h5:/main_peak: cannot write a chunk"));
  CHECK_THAT(growth_refusal, Contains("map.h5:/main_peak: cannot grow"));
  CHECK(std::filesystem::file_size(directory / "stderr") == 0);
}

TEST_CASE("a chunk of a finished map that is not there is damage, of a part it is none") {
  const TemporaryDirectory directory;
  const auto path = directory / "map.h5";
  const MapLayout layout{.axes = {{.name = "p", .size = 4}},
                         .variables = {{.name = "x", .unit = "m", .long_name = "x"}},
                         .chunk = {2}};
  {
    MapWriter writer(path, layout);
    MapChunk chunk(layout);
    chunk.begin({2});
    chunk.put(0, {{2}, {2}}, std::vector{1.0, 2.0});
    writer.write_chunk(chunk.encoded());
    writer.finish();
  }
  const MapReader reader(path);
  reader.check_data(Completeness::part);
  CHECK_THAT(refusal([&] { reader.check_data(Completeness::whole); }),
             Contains("map.h5:/x: its chunk at [0] is missing"));
}

TEST_CASE("axes and coordinates are in chunks with a checksum, single numbers in a header with one") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const hdf5::File file = hdf5::File::open(directory / "map.h5");
  for (const std::string& name : file.root().dataset_names()) {
    INFO(name);
    CHECK(!file.root().dataset(name).chunk().empty());
  }
}

TEST_CASE("a damaged chunk is an error, not a wrong number") {
  const TemporaryDirectory directory;
  const auto path = directory / "map.h5";
  const std::array<std::uint64_t, 2> shape{64, 64};
  std::mt19937_64 random(1);
  std::vector<double> noise(64 * 64);
  for (double& value : noise) value = std::uniform_real_distribution<double>(1.0, 2.0)(random);
  const MapLayout layout{.axes = {{.name = "p", .size = 64}, {.name = "q", .size = 64}},
                         .variables = {{.name = "x", .unit = "m", .long_name = "x"}},
                         .chunk = {64, 64}};
  {
    MapWriter writer(path, layout);
    write_whole_map(writer, layout, {noise});
    writer.finish();
  }
  CHECK(MapReader(path).read(0, origin, shape) == noise);
  // The one chunk is most of the file: the file's middle lies in it.
  write_at(path, static_cast<std::streamoff>(std::filesystem::file_size(path) / 2), "damaged");
  const MapReader reader(path);
  CHECK_THAT(refusal([&] { reader.read(0, origin, shape); }),
             Contains("map.h5:/x: cannot read") && Contains("Fletcher32"));
  CHECK_THAT(refusal([&] { reader.check_data(Completeness::whole); }),
             Contains("map.h5:/x: cannot read") && Contains("Fletcher32"));
}
}  // namespace test_refusals
