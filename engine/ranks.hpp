#pragma once

#include <optional>

#include "engine/bytes.hpp"

namespace frahm::engine {

// The processes of one parallel program, numbered by rank, and the messages between them.
//
// Used by one thread at a time.
class Ranks {
 public:
  struct Message {
    int from = 0;
    Bytes bytes;
  };

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  virtual int rank() const = 0;  // 0 <= rank() < size()
  virtual int size() const = 0;  // > 1
  // Processors of this process: those it may use, shared evenly with ranks that may use the same ones. >= 1
  virtual int processors() const = 0;
  // Lets this process use the processors of all ranks on its machine, when the others have nothing more to
  // do. Returns the number of these ranks, itself among them.
  virtual int take_machine() = 0;

  // Neither function waits. Messages from one rank to another arrive whole and in the order of sending.
  virtual void send(int to, const Bytes& message) = 0;
  virtual std::optional<Message> receive() = 0;

  // A rank that is given up is not waited for at the end, until it is taken back.
  virtual void give_up(int rank) = 0;
  virtual void take_back(int rank) = 0;
  // If a rank is given up, ends the program in all ranks at once with this exit code; otherwise does nothing.
  virtual void end_without_given_up(int code) = 0;
};

}  // namespace frahm::engine
