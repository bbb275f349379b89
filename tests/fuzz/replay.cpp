// The fuzzers without a fuzzer: each file given, and each file of each folder given, is one input.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using std::filesystem::path;

std::vector<path> inputs_of(int argc, char** argv) {
  std::vector<path> inputs;
  for (int i = 1; i < argc; ++i) {
    if (!std::filesystem::is_directory(argv[i])) {
      inputs.emplace_back(argv[i]);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) inputs.push_back(entry.path());
  }
  std::ranges::sort(inputs);
  return inputs;
}

void replay(const path& input) {
  fmt::print("{}\n", input.string());  // before: an input that ends the process is the last one named
  std::fflush(stdout);
  std::ifstream file(input, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<path> inputs = inputs_of(argc, argv);
  for (const path& input : inputs) replay(input);
  fmt::print("{} inputs\n", inputs.size());
  return inputs.empty() ? 2 : 0;
}
