#include "engine/checksum.hpp"

#include <catch2/catch.hpp>
#include <string_view>

#include "engine/bytes.hpp"

namespace checksum_test {
using namespace frahm::engine;

TEST_CASE("checksums have their published check values") {
  const auto check = std::as_bytes(std::span(std::string_view("123456789")));
  CHECK(crc32c(check) == 0xE3069283U);
  CHECK(crc64(check) == 0x995DC9BBDF1939FAU);
  CHECK(crc32c({}) == 0);
}

TEST_CASE("numbers are stored least significant byte first") {
  Bytes bytes(8);
  put_little_endian(bytes.data(), std::uint64_t{0x0102030405060708});
  CHECK(bytes.front() == std::byte{8});
  CHECK(bytes.back() == std::byte{1});
  CHECK(get_little_endian<std::uint64_t>(bytes.data()) == 0x0102030405060708);
}
}  // namespace checksum_test
