#include "engine/rank_message.hpp"

#include <algorithm>
#include <array>

namespace frahm::engine {
namespace {

constexpr std::size_t word = sizeof(std::uint64_t);
constexpr std::size_t head_words = 10;

}  // namespace

Finished& Finished::operator+=(const Finished& other) {
  tiles += other.tiles;
  points += other.points;
  reused += other.reused;
  failed += other.failed;
  cpu_milliseconds += other.cpu_milliseconds;
  return *this;
}

// Words: the head, the tiles; then the text.
Bytes encode(const RankMessage& message) {
  const Finished& finished = message.finished;
  const std::array<std::uint64_t, head_words> head{static_cast<std::uint64_t>(message.kind),
                                                   message.threads,
                                                   message.study,
                                                   message.code,
                                                   finished.tiles,
                                                   finished.points,
                                                   finished.reused,
                                                   finished.failed,
                                                   finished.cpu_milliseconds,
                                                   message.tiles.size()};
  Bytes bytes(word * (head.size() + message.tiles.size()));
  std::byte* to = bytes.data();
  for (const auto& words :
       {std::span<const std::uint64_t>(head), std::span<const std::uint64_t>(message.tiles)}) {
    for (const std::uint64_t each : words) {
      put_little_endian(to, each);
      to += word;
    }
  }
  const auto text = std::as_bytes(std::span(message.text));
  bytes.insert(bytes.end(), text.begin(), text.end());
  return bytes;
}

RankMessage decode(std::span<const std::byte> bytes) {
  const auto number = [&](std::size_t i) { return get_little_endian<std::uint64_t>(&bytes[word * i]); };
  RankMessage message{.kind = static_cast<RankMessage::Kind>(number(0)),
                      .threads = number(1),
                      .study = number(2),
                      .code = number(3),
                      .finished = {number(4), number(5), number(6), number(7), number(8)}};
  message.tiles.resize(number(9));
  for (std::size_t i = 0; i < message.tiles.size(); ++i) message.tiles[i] = number(head_words + i);
  const auto text = bytes.subspan(word * (head_words + message.tiles.size()));
  message.text.assign(reinterpret_cast<const char*>(text.data()), text.size());
  return message;
}

}  // namespace frahm::engine
