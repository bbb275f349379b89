#include "sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "results/map_chunk.hpp"
#include "results/map_writer.hpp"

namespace sample {
namespace {

using namespace frahm::results;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool is_missing(std::size_t i, std::size_t j) {
  return i == missing_design && j >= missing_from && j < missing_from + tile_width;
}

// The tiles of one chunk, without the missing one.
void put_tiles(MapChunk& chunk, std::size_t first_design, std::size_t first_frequency) {
  for (std::size_t i = first_design; i < std::min(first_design + chunk_designs, designs); ++i) {
    const std::size_t end = std::min(first_frequency + chunk_frequencies, frequencies);
    for (std::size_t from = first_frequency; from < end; from += tile_width) {
      if (is_missing(i, from)) continue;
      const std::size_t width = std::min(tile_width, end - from);
      for (std::size_t v = peak; v <= status; ++v) {
        std::vector<double> values(width);
        for (std::size_t j = 0; j < width; ++j) values[j] = value(v, i, from + j);
        chunk.put(v, {{i, from}, {1, width}}, values);
      }
    }
  }
}

void write_map(MapWriter& writer) {
  const MapLayout map = layout();
  MapChunk chunk(map);
  for (std::size_t i = 0; i < designs; i += chunk_designs) {
    for (std::size_t j = 0; j < frequencies; j += chunk_frequencies) {
      chunk.begin({i, j});
      put_tiles(chunk, i, j);
      writer.write_chunk(chunk.encoded());
    }
  }
}

void write_groups(MapWriter& writer) {
  writer.write_texts("provenance",
                     {{"study", study_text()}, {"version", "0.1.0"}, {"note", "Dämpfung ζ"}, {"empty", ""}});

  const std::size_t orbits = writer.create_ragged(
      {.group = "orbits",
       .row = "orbit",
       .row_variables = {{.name = "omega", .unit = "rpm", .long_name = "excitation frequency"}},
       .sample = "sample",
       .sample_variables = {
           {.name = "time", .unit = "s", .long_name = "time"},
           {.name = "main_displacement", .unit = "m", .long_name = "displacement of main"}}});
  for (std::size_t orbit = 0; orbit < 3; ++orbit) {
    std::vector<double> time, displacement;
    for (std::size_t s = 0; s < 3000 * orbit; ++s) {  // the first orbit has no samples
      time.push_back(1e-3 * static_cast<double>(s));
      displacement.push_back(std::ldexp(static_cast<double>(s), -10));
    }
    writer.append_ragged(orbits, std::vector<double>{100.0 + static_cast<double>(orbit)},
                         std::vector<std::vector<double>>{time, displacement});
  }

  const std::size_t borders = writer.create_ragged(
      {.group = "borders",
       .row = "border",
       .row_variables = {{.name = "omega", .unit = "rpm", .long_name = "excitation frequency"}}});
  for (int k = 0; k < 3; ++k) writer.append_ragged(borders, std::vector<double>{160.5 + k});
  writer.create_ragged(
      {.group = "no_borders",
       .row = "border",
       .row_variables = {{.name = "omega", .unit = "rpm", .long_name = "excitation frequency"}}});

  writer.write_columns(
      "optimum",
      {{.variable = {.name = "objective", .unit = "m", .long_name = "largest peak"}, .values = {0.0125}},
       {.variable = {.name = "knot", .unit = "rad s-1", .long_name = "knot"},
        .dimension = "knot",
        .values = {15, 25, 35}},
       {.variable = {.name = "inertance", .unit = "kg", .long_name = "inertance"},
        .dimension = "knot",
        .values = {4.72, nan, 12.9}},
       {.variable = {.name = "iterations", .unit = "1", .long_name = "iterations", .type = Type::int32},
        .values = {17}},
       {.variable = {.name = "active", .unit = "rad s-1", .long_name = "active peak"},
        .dimension = "peak",
        .values = {}}});

  writer.write_group({.path = "page", .texts = {{"parameters", "k,c"}, {"samples", "design"}, {"none", ""}}});
  writer.write_group({.path = "page/crank",
                      .columns = {{.variable = {.name = "angle", .unit = "rad", .long_name = "angle"},
                                   .dimension = "angle",
                                   .values = {0.0, 1.0}}},
                      .texts = {{"of", "main"}}});
}

}  // namespace

double value(std::size_t v, std::size_t i, std::size_t j) {
  const auto x = static_cast<double>(i), y = static_cast<double>(j);
  switch (v) {
    case peak:
      return is_missing(i, j) ? nan : (x + 1.0) / (y + 1.0);
    case phase:
      return is_missing(i, j) ? nan : (x - y) / 8.0;  // exact in float32
    case stops:
      return is_missing(i, j) ? -1.0 : static_cast<double>(i * j % 7);
    case regime:
      return is_missing(i, j) ? 0.0 : static_cast<double>((i + j) % 5 + 1);
    default:
      return is_missing(i, j) ? 0.0 : 1.0;
  }
}

MapLayout layout() {
  Axis design{.name = "design", .size = designs};
  Coordinate stiffness{"k", "N m-1", "stiffness", {}}, damping{"c", "N s m-1", "damping", {}};
  for (std::size_t i = 0; i < designs; ++i) {
    stiffness.values.push_back(1000.0 + static_cast<double>(i));
    damping.values.push_back(0.5 * static_cast<double>(i));
  }
  design.coordinates = {stiffness, damping};

  Axis omega{.name = "omega", .size = frequencies};
  Coordinate frequency{"omega", "rpm", "excitation frequency", {}},
      ratio{"frequency_ratio", "1", "ω/ω_n", {}};
  for (std::size_t j = 0; j < frequencies; ++j) {
    frequency.values.push_back(150.0 + 2.0 * static_cast<double>(j));
    ratio.values.push_back(frequency.values.back() / 200.0);
  }
  omega.coordinates = {frequency, ratio};

  const std::vector<Flag> regimes = {{"not_computed", 0}, {"no_friction", 1}, {"non_stop", 2},
                                     {"one_stop", 3},     {"multi_stop", 4},  {"stuck", 5}};
  const std::vector<Flag> statuses = {
      {"not_computed", 0}, {"ok", 1}, {"grazing", 2}, {"unbounded", 3}, {"failed", 4}};
  return {.title = "Sample",
          .source = "frahm 0.1.0",
          .history = "written by a test",
          .axes = {design, omega},
          .variables =
              {{.name = "main_peak", .unit = "m", .long_name = "peak of main"},
               {.name = "main_phase", .unit = "rad", .long_name = "phase of main", .type = Type::float32},
               {.name = "guide_stops", .unit = "1", .long_name = "stops of guide", .type = Type::int32},
               {.name = "guide_regime", .long_name = "regime of guide", .type = Type::flag, .flags = regimes},
               {.name = "status", .long_name = "status", .type = Type::flag, .flags = statuses}},
          .chunk = {chunk_designs, chunk_frequencies}};
}

std::string study_text() {
  std::string text = "[study]\ntitle = \"ζ and ω\"\n";
  while (text.size() < 200'000) text += "# a long study\n";
  return text;
}

void write(const std::filesystem::path& path) {
  MapWriter writer(path, layout());
  write_map(writer);
  write_groups(writer);
  writer.finish();
}

}  // namespace sample
