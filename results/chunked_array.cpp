#include "results/chunked_array.hpp"

#include <algorithm>
#include <utility>

#include "results/chunk_codec.hpp"

namespace frahm::results {

ChunkedArray::ChunkedArray(hdf5::Dataset dataset, std::size_t max_open)
    : dataset_(std::move(dataset)),
      element_size_(element_size(dataset_.type())),
      shape_(dataset_.shape()),
      chunk_(dataset_.chunk()),
      blank_(missing_elements(dataset_.type(), product(chunk_))),
      max_open_(max_open) {}

void ChunkedArray::write(const Box& block, std::span<const std::byte> elements) {
  Shape first(chunk_.size()), last(chunk_.size());  // chunks the block touches
  for (std::size_t k = 0; k < chunk_.size(); ++k) {
    first[k] = block.start[k] / chunk_[k];
    last[k] = (block.start[k] + block.count[k] - 1) / chunk_[k];
  }
  Shape chunk = first;
  do {
    write_part(chunk, block, elements);
  } while (next_index(chunk, first, last));
}

void ChunkedArray::write_part(const Shape& chunk, const Box& block, std::span<const std::byte> elements) {
  const Box within = box_within(chunk);
  const Box part = common(block, within);
  if (part.count == within.count) {
    Bytes whole = blank_;
    copy_box(part, elements, block, whole, box_of(chunk), element_size_);
    write_chunk(chunk, whole);
    open_.erase(chunk);
    return;
  }
  OpenChunk& partial = open(chunk);
  copy_box(part, elements, block, partial.elements, box_of(chunk), element_size_);
  // Points that come twice count twice: the chunk is then written early and read back for the rest.
  partial.awaited -= std::min(partial.awaited, product(part.count));
  if (partial.awaited == 0) close(chunk);
}

void ChunkedArray::flush() {
  while (!open_.empty()) close(open_.begin()->first);
}

Box ChunkedArray::box_of(const Shape& chunk) const {
  Box box{chunk, chunk_};
  for (std::size_t k = 0; k < chunk.size(); ++k) box.start[k] *= chunk_[k];
  return box;
}

Box ChunkedArray::box_within(const Shape& chunk) const {
  return common(box_of(chunk), Box{Shape(shape_.size(), 0), shape_});
}

ChunkedArray::OpenChunk& ChunkedArray::open(const Shape& chunk) {
  if (const auto found = open_.find(chunk); found != open_.end()) return found->second;
  if (open_.size() >= max_open_) {
    const auto oldest = std::min_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
      return a.second.sequence < b.second.sequence;
    });
    close(oldest->first);
  }
  Bytes elements;
  if (!spare_.empty()) {
    elements = std::move(spare_.back());
    spare_.pop_back();
  }
  elements = blank_;
  // What the file has of the chunk: missing values if it was never written.
  const Box within = box_within(chunk);
  dataset_.read_elements(within, elements, chunk_);
  return open_.emplace(chunk, OpenChunk{std::move(elements), product(within.count), opened_++}).first->second;
}

void ChunkedArray::close(const Shape& chunk) {
  auto closed = open_.extract(chunk);
  write_chunk(chunk, closed.mapped().elements);
  spare_.push_back(std::move(closed.mapped().elements));
}

void ChunkedArray::write_chunk(const Shape& chunk, std::span<const std::byte> elements) {
  dataset_.write_chunk(box_of(chunk).start, encode_chunk(elements, element_size_));
}

}  // namespace frahm::results
