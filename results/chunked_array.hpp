#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "results/box.hpp"
#include "results/hdf5.hpp"
#include "results/storage.hpp"

namespace frahm::results {

// One chunked dataset being written, block by block, each chunk compressed once by encode_chunk().
//
// A chunk that a block covers is written at once. One that blocks cover in parts is kept open until all its
// points have come, or too many are open: then the one opened first is written as it stands, and read back if
// more of it comes.
class ChunkedArray {
 public:
  // dataset: rank >= 1, chunked.  max_open: chunks kept in memory, >= 1.
  ChunkedArray(hdf5::Dataset dataset, std::size_t max_open);

  // elements: the block's, as stored, row-major.  The block is not empty and lies within the array.
  void write(const Box& block, std::span<const std::byte> elements);
  void flush();  // writes the open chunks as they stand

 private:
  struct OpenChunk {
    Bytes elements;              // of the whole chunk; missing values beyond the array's edge
    std::uint64_t awaited = 0;   // points still to come
    std::uint64_t sequence = 0;  // order of opening
  };

  // A chunk is named by its position in the grid of chunks.
  Box box_of(const Shape& chunk) const;      // its points, also beyond the array's edge
  Box box_within(const Shape& chunk) const;  // its points within the array
  void write_part(const Shape& chunk, const Box& block, std::span<const std::byte> elements);
  OpenChunk& open(const Shape& chunk);
  void close(const Shape& chunk);
  void write_chunk(const Shape& chunk, std::span<const std::byte> elements);

  hdf5::Dataset dataset_;
  std::size_t element_size_;
  Shape shape_, chunk_;
  Bytes blank_;  // a chunk of missing values
  std::size_t max_open_;
  std::uint64_t opened_ = 0;
  std::map<Shape, OpenChunk> open_;
  std::vector<Bytes> spare_;  // memory of chunks closed, for the next ones
};

}  // namespace frahm::results
