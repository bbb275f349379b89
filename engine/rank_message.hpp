#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/bytes.hpp"

namespace frahm::engine {

// The work that a rank has finished in this run.
struct Finished {
  std::uint64_t tiles = 0, points = 0;
  std::uint64_t reused = 0;            // of the points: not computed but found in an earlier result
  std::uint64_t failed = 0;            // of the points
  std::uint64_t cpu_milliseconds = 0;  // its process has used

  Finished& operator+=(const Finished& other);
};

// The messages between rank 0, which deals out the tiles, and the other ranks.
struct RankMessage {
  enum class Kind : std::uint64_t {
    ready,  // to rank 0: may I begin?  threads, study; text: the process
    ask,    // for tiles, as its queue is empty; finished
    tell,   // finished
    leave,  // its work is over and its log closed; finished; text: why it was stopped, empty if it was not
    fail,   // it cannot go on; text and code of the error
    begin,  // from rank 0: open your log and ask
    deal,   // tiles to compute
    close,  // there are no more tiles
    stop,   // drop the tiles not in hand
    end,    // of the program; code
  };

  Kind kind = Kind::tell;
  std::uint64_t threads = 0;
  std::uint64_t study = 0;  // study_mark()
  std::uint64_t code = 0;   // exit code of the program
  Finished finished = {};
  std::vector<std::uint64_t> tiles = {};
  std::string text = {};
};

Bytes encode(const RankMessage& message);
// bytes: from encode().
RankMessage decode(std::span<const std::byte> bytes);

}  // namespace frahm::engine
