#include "studies/reading/text/plain_text.hpp"

#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "studies/program/plain_output.hpp"

namespace plain_text_test {
using namespace frahm::studies;

TEST_CASE("Control characters and bytes that are no text become question marks") {
  CHECK(plain_text("a\x1b[31mb") == "a?[31mb");
  CHECK(plain_text("C1: \xc2\x9b"
                   "31m") == "C1: ?31m");
  CHECK(plain_text("line\n\ttab\r\x7f") == "line\n\ttab??");
  CHECK(plain_text("left \u202Eright\u2069") == "left ?right?");  // turned round by a terminal
  CHECK(plain_text("Dämpfung ζ – 1") == "Dämpfung ζ – 1");
  CHECK(plain_text("\xff\xc3") == "??");
  CHECK(plain_text(std::string("a\0b", 3)) == "a?b");
}

TEST_CASE("A line is plain if it is text without control characters") {
  CHECK(is_plain_line("ordner/größe.h5"));
  for (const char* text : {"a\nb", "a\tb", "a\x1b", "\xff", "\xc2\x85"}) CHECK_FALSE(is_plain_line(text));
}

TEST_CASE("A character that is written in pieces reaches the stream whole") {
  const std::string text = "ζ–ä plain \xc2\x9b!\n";
  std::string expected = "ζ–ä plain ?!\n";
  for (const std::size_t piece : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    std::ostringstream to;
    {
      PlainOutput out(to);
      for (int times = 0; times < 1000; ++times) {
        for (std::size_t at = 0; at < text.size(); at += piece) out << text.substr(at, piece);
      }
    }
    std::string all;
    for (int times = 0; times < 1000; ++times) all += expected;
    CHECK(to.str() == all);
  }
}
}  // namespace plain_text_test
