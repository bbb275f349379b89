#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>
#include <thread>

#include "results/chunk_codec.hpp"
#include "results/hdf5.hpp"
#include "results/map_chunk.hpp"
#include "results/map_reader.hpp"
#include "results/map_writer.hpp"
#include "temporary_directory.hpp"

namespace test_chunks {
using namespace frahm::results;

namespace {

Bytes as_bytes(const std::vector<double>& values) {
  Bytes bytes(values.size() * sizeof(double));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// A 3-D grid whose sizes are no multiples of the chunk's.
const Shape grid{5, 7, 11}, chunk{2, 3, 4};

double value_at(const Shape& point) {
  return static_cast<double>(point[0] * 10000 + point[1] * 100 + point[2]) + 0.25;
}

std::vector<double> values_of(const Box& box) {
  std::vector<double> values;
  Shape last = box.start;
  for (std::size_t k = 0; k < 3; ++k) last[k] += box.count[k] - 1;
  Shape point = box.start;
  do {
    values.push_back(value_at(point));
  } while (next_index(point, box.start, last));
  return values;
}

bool overlap(const Box& a, const Box& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.start[k] >= b.start[k] + b.count[k] || b.start[k] >= a.start[k] + a.count[k]) return false;
  }
  return true;
}

// The grid as boxes of `tile` points, clipped to it.
std::vector<Box> tiles(const Shape& tile) {
  std::vector<Box> boxes;
  for (std::uint64_t i = 0; i < grid[0]; i += tile[0]) {
    for (std::uint64_t j = 0; j < grid[1]; j += tile[1]) {
      for (std::uint64_t k = 0; k < grid[2]; k += tile[2]) {
        boxes.push_back(common({{i, j, k}, tile}, {{0, 0, 0}, grid}));
      }
    }
  }
  return boxes;
}

const MapLayout layout{
    .axes = {{.name = "a", .size = grid[0]}, {.name = "b", .size = grid[1]}, {.name = "c", .size = grid[2]}},
    .variables = {{.name = "x", .unit = "m", .long_name = "x"}},
    .chunk = chunk};

// The parts of the boxes that lie in one chunk, in turn, as it is stored.
EncodedChunk made_of(const std::vector<Box>& boxes, const Box& within) {
  MapChunk made(layout);
  made.begin(within.start);
  for (const Box& box : boxes) {
    if (overlap(box, within)) made.put(0, common(box, within), values_of(common(box, within)));
  }
  return made.encoded();
}

// Leaves this 16-bit number all over the memory in which the next functions called will have their variables.
[[gnu::noinline]] void soil_stack(std::uint16_t number) {
  std::array<std::uint16_t, 200000> memory;
  volatile std::uint16_t* const written = memory.data();
  for (std::size_t i = 0; i < memory.size(); ++i) written[i] = number;
}

}  // namespace

TEST_CASE("the bytes of a chunk depend on its elements alone, not on what the memory held before") {
  // Repeated at a distance: bytes that a compressor with a shorter memory would not find again.
  std::vector<double> values(20000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i % 3000));
  const Bytes chunk_bytes = as_bytes(values);
  soil_stack(0);
  const Bytes expected = encode_chunk(chunk_bytes, sizeof(double));
  for (std::uint16_t number = 1; number <= 15; ++number) {
    INFO("memory of " << number);
    soil_stack(number);
    CHECK((encode_chunk(chunk_bytes, sizeof(double)) == expected));
  }
}

TEST_CASE("blocks of any shape and order give the same chunks, which read back as the array") {
  const std::vector<Shape> shapes = {{5, 7, 11}, {2, 3, 4}, {1, 1, 1}, {4, 6, 8}, {3, 2, 5}, {1, 7, 11}};
  std::mt19937 shuffler(1);
  for (const Shape& shape : shapes) {
    std::vector<Box> boxes = tiles(shape);
    const std::vector<Box> again = tiles({3, 3, 3});  // points that come twice
    boxes.insert(boxes.end(), again.begin(), again.end());
    std::shuffle(boxes.begin(), boxes.end(), shuffler);
    INFO("blocks of " << shape[0] << " x " << shape[1] << " x " << shape[2]);
    const TemporaryDirectory directory;
    {
      MapWriter writer(directory / "array.h5", layout);
      for (const Box& within : tiles(chunk)) {
        const EncodedChunk encoded = made_of(boxes, within);
        CHECK(encoded.variables == made_of({within}, within).variables);
        writer.write_chunk(encoded);
      }
      writer.finish();
    }
    CHECK(MapReader(directory / "array.h5").read(0, Shape{0, 0, 0}, grid) == values_of({{0, 0, 0}, grid}));
  }
}

TEST_CASE(
    "of a point put twice the later value counts, and a chunk begun anew knows nothing of the one before") {
  const MapLayout line{.axes = {{.name = "a", .size = 6}},
                       .variables = {{.name = "x", .unit = "m", .long_name = "x"}},
                       .chunk = {3}};
  MapChunk made(line), expected(line);
  made.put(0, {{0}, {3}}, std::vector<double>{1, 1, 1});
  made.put(0, {{1}, {2}}, std::vector<double>{2, 3});
  expected.put(0, {{0}, {3}}, std::vector<double>{1, 2, 3});
  CHECK(made.encoded().variables == expected.encoded().variables);
  made.begin({3});
  expected.begin({0});
  for (MapChunk* chunk_of : {&made, &expected})
    chunk_of->put(0, {{chunk_of == &made ? 4u : 1u}, {1}}, std::vector<double>{5});
  CHECK(made.encoded().start == Shape{3});
  CHECK(made.encoded().variables == expected.encoded().variables);
}

TEST_CASE("the checksum is HDF5's") {
  // From H5_checksum_fletcher32 of HDF5 1.10.8 over the bytes 0, 1, 2, ... (mod 251).
  const std::vector<std::pair<std::size_t, std::uint32_t>> known = {{1, 0x00000000},   {2, 0x00010001},
                                                                    {3, 0x02020201},   {720, 0x308434a1},
                                                                    {721, 0x3f260ea2}, {4001, 0x94bea3b1}};
  for (const auto& [size, checksum] : known) {
    Bytes data(size);
    for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<std::byte>(i % 251);
    INFO(size << " bytes");
    CHECK(fletcher32(data) == checksum);
  }
  // The largest sums: every byte 255.
  CHECK(fletcher32(Bytes(720, std::byte{255})) == 0xffffffff);
  CHECK(fletcher32(Bytes(721, std::byte{255})) == 0xff00ff00);
  CHECK(fletcher32(Bytes(4001, std::byte{255})) == 0xff00ff00);
}

TEST_CASE("a chunk that does not compress, and one that compresses to nothing, read back") {
  const TemporaryDirectory directory;
  const std::uint64_t size = 100'000;
  std::mt19937_64 random(1);
  std::vector<double> noise(size);
  for (double& value : noise) {
    const std::uint64_t bits = random() >> 2;  // no NaN
    std::memcpy(&value, &bits, sizeof value);
  }
  for (const std::vector<double>& values : {noise, std::vector<double>(size, 1.5)}) {
    hdf5::File file = hdf5::File::create(directory / "array.h5");
    hdf5::Group root = file.root();
    hdf5::Dataset array = root.create_dataset("x", {.type = Type::float64, .shape = {size}, .chunk = {size}});
    array.write_chunk(Shape{0}, encode_chunk(as_bytes(values), sizeof(double)));
    CHECK(root.dataset("x").read(Shape{0}, Shape{size}) == values);
  }
}

TEST_CASE("the same chunk is encoded to the same bytes whatever was encoded before") {
  std::vector<double> smooth(65536), other(65536);
  std::iota(smooth.begin(), smooth.end(), 1.0);
  std::iota(other.rbegin(), other.rend(), 7.0);
  const Bytes first = encode_chunk(as_bytes(smooth), sizeof(double));
  encode_chunk(as_bytes(other), sizeof(double));
  CHECK(encode_chunk(as_bytes(smooth), sizeof(double)) == first);
}

TEST_CASE("chunks encoded by several threads at once are those encoded by one") {
  constexpr std::size_t threads = 4, rounds = 20;
  std::vector<std::vector<double>> chunks(threads, std::vector<double>(4096));
  for (std::size_t t = 0; t < threads; ++t)
    std::iota(chunks[t].begin(), chunks[t].end(), 1000.0 * static_cast<double>(t));
  std::vector<std::size_t> same(threads, 0);
  std::vector<Bytes> alone;
  for (const std::vector<double>& values : chunks)
    alone.push_back(encode_chunk(as_bytes(values), sizeof(double)));
  {
    std::vector<std::jthread> team;
    for (std::size_t t = 0; t < threads; ++t) {
      team.emplace_back([&, t] {
        for (std::size_t k = 0; k < rounds; ++k)
          same[t] += encode_chunk(as_bytes(chunks[t]), sizeof(double)) == alone[t];
      });
    }
  }
  CHECK(same == std::vector<std::size_t>(threads, rounds));
}
}  // namespace test_chunks
