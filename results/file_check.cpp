#include "results/file_check.hpp"

#include <stdexcept>

#include "results/data_check.hpp"
#include "results/data_reader.hpp"
#include "results/map_reader.hpp"

namespace frahm::results {

FileCheck result_check(const std::filesystem::path& path) {
  return {[=] { check_result(path); }, {"result", path.string()}};
}

FileCheck scales_check(const std::filesystem::path& path) {
  return {[=] { check_scales(hdf5::File::open(path).root()); }, {"scales", path.string()}};
}

FileCheck opening_check(const std::filesystem::path& path) {
  return {[=] { check_opening(path); }, {"file", path.string()}};
}

FileCheck dataset_check(const std::filesystem::path& path, const std::string& dataset,
                        std::size_t dimensions) {
  return {[=] { check_dataset(path, dataset, dimensions); },
          {"dataset", path.string(), dataset, std::to_string(dimensions)}};
}

FileCheck check_called(const std::vector<std::string>& words) {
  if (words.size() == 2 && words[0] == "result") return result_check(words[1]);
  if (words.size() == 2 && words[0] == "scales") return scales_check(words[1]);
  if (words.size() == 2 && words[0] == "file") return opening_check(words[1]);
  if (words.size() == 4 && words[0] == "dataset")
    return dataset_check(words[1], words[2], words[3] == "2" ? 2 : 1);
  throw std::invalid_argument(
      "the check of a file is one of: result FILE, scales FILE, file FILE, dataset FILE NAME 1|2");
}

}  // namespace frahm::results
