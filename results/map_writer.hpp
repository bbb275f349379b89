#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "results/columns.hpp"
#include "results/hdf5.hpp"
#include "results/layout.hpp"
#include "results/map_chunk.hpp"
#include "results/part_file.hpp"

namespace frahm::results {

// Writes one result file (FORMAT.md) as <path>.part; finish() renames it to <path> in one step. A writer
// destroyed before that leaves no file. The caller must prevent two writers of one path.
//
// The chunks of the map arrive encoded, in any order; their offsets in the file depend on that order only. No
// chunk stays in memory.
//
// Errors: StoreError where the file cannot be written; std::invalid_argument, naming the item, its value and
// the rule, for wrong contents. Not thread-safe, but write_chunk() and append_ragged() may be called
// from one thread after the other.
class MapWriter {
 public:
  MapWriter(const std::filesystem::path& path, const MapLayout& layout);

  // Writes one chunk of every variable (MapChunk::encoded). A chunk never written is missing.
  void write_chunk(const EncodedChunk& chunk);

  // A map of its own in a group, created if missing: of the statistics of the map over one of its axes.
  // Returns its number, for the other write_chunk(). Title, source and history of the layout are not written.
  std::size_t create_map(const std::string& group, const MapLayout& layout);
  void write_chunk(std::size_t map, const EncodedChunk& chunk);

  // Texts, UTF-8 of any length, as attributes of a group, created if missing: /provenance.
  void write_texts(const std::string& group, const std::vector<Text>& texts);

  // Numbers and columns of a group, created if missing, once for each group: /optimum, /identification,
  // /decay, /transient.
  void write_columns(const std::string& group, const std::vector<Column>& columns);

  // All of a group that is not in the file yet; the groups above it are.
  void write_group(const GroupContent& content);

  // A group of rows that arrive one by one: /orbits, /borders. Returns its number, for append_ragged().
  std::size_t create_ragged(const RaggedLayout& layout);

  // row: one number for each of RaggedLayout::row_variables.  samples: for each of ::sample_variables the
  // row's stretch of values, all of one length.
  void append_ragged(std::size_t table, std::span<const double> row,
                     std::span<const std::vector<double>> samples = {});

  void finish();  // the file is complete, on the disk and at its path; nothing is written after

 private:
  hdf5::Group group(const std::string& name);

  PartFile part_;
  hdf5::File file_;
  std::vector<std::vector<hdf5::Dataset>> maps_;  // of each map the variables, of the root's first
  std::vector<RaggedTable> tables_;
};

}  // namespace frahm::results
