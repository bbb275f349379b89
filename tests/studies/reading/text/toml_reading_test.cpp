#include "studies/reading/text/toml_reading.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace toml_reading_test {
namespace {

using namespace frahm::studies;

std::string complaint_about(const std::string& text) {
  try {
    read_toml({"study.toml", text});
  } catch (const StudyError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("a document keeps the order of the file and the place of every value") {
  const TomlValue root =
      read_toml({"study.toml", "b = 1\na = \"ζ\" # ζ\n[t]\nx = { z = 2.5, y = [true] }\n"});
  const auto& entries = *root.as<TomlTable>();
  REQUIRE(entries.size() == 3);
  CHECK(entries[0].key == "b");
  CHECK(entries[1].key == "a");
  CHECK(entries[1].value.position == Position{2, 5});
  CHECK(*entries[1].value.as<std::string>() == "ζ");
  const auto& x = entries[2].value.as<TomlTable>()->front();
  CHECK(x.position == Position{4, 1});
  CHECK(x.value.as<TomlTable>()->front().key == "z");
  CHECK(x.value.as<TomlTable>()->front().value.position == Position{4, 11});
}

TEST_CASE("an error shows the line and a mark under the column") {
  CHECK(complaint_about("a = 1\nb = @\n") ==
        "study.toml:2:5: not valid TOML: " + complaint_about("a = 1\nb = @\n").substr(32));
  CHECK_THAT(complaint_about("a = 1\nb = @\n"), Catch::EndsWith("\n    2 | b = @\n      |     ^"));
}

TEST_CASE("texts that toml++ must not see are refused with their place") {
  CHECK_THAT(complaint_about(std::string("a = 1\n[\0]", 9)),
             Catch::StartsWith("study.toml:2:2: the control character 0x00"));
  CHECK_THAT(complaint_about("a = \"\x1b[31m\""),
             Catch::StartsWith("study.toml:1:6: the control character 0x1B"));
  CHECK_THAT(complaint_about("a\xEF\xBB\xBB = 1"), Catch::StartsWith("study.toml:1:2: letters beyond ASCII"));
  CHECK_THAT(complaint_about("a = 1\rb = 2"), Catch::Contains("0x0D"));
  CHECK_THAT(complaint_about("a = " + std::string(100'000, '[')),
             Catch::Contains("nested deeper than 16 levels"));
  std::string dotted = "a";
  for (int i = 0; i < 100'000; ++i) dotted += ".a";
  CHECK_THAT(complaint_about(dotted + " = 1"), Catch::Contains("nested deeper than 16 levels"));
  CHECK_THAT(complaint_about(std::string((1 << 20) + 1, '#')), Catch::Contains("too long for a study"));
}

TEST_CASE("what makes toml++ 3.3 assert is a located error") {
  for (const char* text :
       {"[.model]", "[.4x.3]", "[.x]", "[[.x]]", "[", "[[", "a = [", "\"", "'''", "a = \"\\", "= 1",
        "a = { b = 1", "a = 1e400", "a = \"\xff\xfe\"", "a = 1\na = 2", "[a]\n[a]"}) {
    INFO(text);
    CHECK_THAT(complaint_about(text), Catch::StartsWith("study.toml:"));
  }
}

TEST_CASE("strings and comments may hold any letter, and end where they should") {
  CHECK(complaint_about("a = \"ζ\" # ζ\nb = 'é'\nc = \"\"\"ω\n\"\"\"\nd = \"\\\"ζ\"\ne = 'C:\\'\nf = [0.1, "
                        "0.2, 0.3]\r\n") == "none");
}

TEST_CASE("a position inside a text is found where the text is written plainly") {
  const StudySource source{"s", "a = \"2*x\"\nb = \"\\t2*x\"\nc = \"\"\"\nx\"\"\"\n"};
  CHECK(source.inside_string({1, 5}, 2) == Position{1, 8});
  CHECK(source.inside_string({2, 5}, 2) == Position{2, 5});
  CHECK(source.inside_string({3, 5}, 1) == Position{3, 5});
}

TEST_CASE("a long line is cut around the column of the error") {
  const StudySource source{"s", "a = [" + std::string(5000, '1') + "]"};
  const std::string message = source.error_at(frahm::studies::rules::not_text, {1, 3000}, "here").what();
  CHECK(message.size() < 400);
}

}  // namespace
}  // namespace toml_reading_test
