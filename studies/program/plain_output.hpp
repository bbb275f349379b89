#pragma once

#include <ostream>
#include <streambuf>
#include <string>

namespace frahm::studies {

// A stream that hands plain_text() on to another: what a file, a log or a note says never reaches a terminal
// raw.
class PlainOutput : public std::ostream {
 public:
  // to: must outlive it.
  explicit PlainOutput(std::ostream& to) : std::ostream(nullptr), buffer_(to) { rdbuf(&buffer_); }
  ~PlainOutput() override { flush(); }
  PlainOutput(const PlainOutput&) = delete;
  PlainOutput& operator=(const PlainOutput&) = delete;

 private:
  class Buffer : public std::streambuf {
   public:
    explicit Buffer(std::ostream& to) : to_(to) {}

   protected:
    int_type overflow(int_type c) override;
    std::streamsize xsputn(const char* text, std::streamsize size) override;
    int sync() override;

   private:
    void hand_on(std::size_t size);

    std::ostream& to_;
    std::string waiting_;  // not yet handed on: a character may be cut off at its end
  };

  Buffer buffer_;
};

}  // namespace frahm::studies
