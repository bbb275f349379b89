#include "results/rewording.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "results/columns.hpp"
#include "results/hdf5.hpp"
#include "results/part_file.hpp"
#include "results/storage.hpp"
#include "results/store_error.hpp"
#include "results/variable_io.hpp"

namespace frahm::results {
namespace {

void copy_into(PartFile& part, const std::filesystem::path& file) {
  constexpr std::size_t at_once = std::size_t{1} << 20;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw StoreError(file.string(), "cannot be read", std::strerror(errno));
  std::string bytes(at_once, '\0');
  while (stream) {
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    part.write(std::string_view(bytes).substr(0, static_cast<std::size_t>(stream.gcount())));
  }
  if (!stream.eof()) throw StoreError(file.string(), "cannot be read", std::strerror(errno));
}

void rewrite_numbers(hdf5::Dataset& dataset, const Variable& variable, const Words& words) {
  if (words.values.empty() && words.factor == 1.0) return;
  const Shape shape = dataset.shape();
  const std::vector<double> before = dataset.read_all();
  std::vector<double> numbers = words.values;
  if (numbers == before) return;
  if (numbers.empty()) {
    numbers = before;
    for (double& number : numbers) number *= words.factor;
  }
  if (numbers.size() != product(shape))
    throw StoreError(dataset.where(), fmt::format("has {} numbers, not {}", product(shape), numbers.size()),
                     "");
  if (!numbers.empty()) dataset.write(Shape(shape.size(), 0), shape, to_storage(variable, numbers));
}

// All are written again, which keeps their order.
void replace_texts(hdf5::Group& group, const std::vector<Text>& by) {
  for (const auto& [name, text] : group.texts()) {
    const auto found = std::ranges::find(by, name, &Text::first);
    group.replace_text(name, found == by.end() ? text : found->second);
  }
}

void reword_group(const hdf5::Group& group, const std::string& path, const WordsOf& words_of) {
  for (const std::string& name : group.dataset_names()) {
    hdf5::Dataset dataset = group.dataset(name);
    const Variable variable = described(dataset);
    const std::optional<Words> words = words_of(path, variable);
    if (!words) continue;
    rewrite_numbers(dataset, variable, *words);
    if (words->unit != variable.unit) dataset.replace_text("units", words->unit);
    if (words->long_name != variable.long_name) dataset.replace_text("long_name", words->long_name);
  }
  for (const std::string& name : group.group_names())
    reword_group(group.group(name), path.empty() ? name : path + "/" + name, words_of);
}

void write_anew(hdf5::Group& root, const std::vector<GroupContent>& groups) {
  for (const GroupContent& content : groups) {
    if (root.has(content.path)) root.remove(content.path);
    hdf5::Group group = root.create_group(content.path);
    write_content(group, content);
  }
}

}  // namespace

void reword(const std::filesystem::path& result, const Rewording& to) {
  PartFile part(result);
  copy_into(part, result);
  hdf5::File file = hdf5::File::open_to_change(part.part());
  {
    hdf5::Group root = file.root();
    root.replace_text("title", to.title);
    for (const auto& [group, texts] : to.texts) {
      hdf5::Group of = root.group(group);
      replace_texts(of, texts);
    }
    reword_group(root, "", to.words_of);
    write_anew(root, to.anew);
  }
  file.close();
  part.publish();
}

}  // namespace frahm::results
