#include "studies/provenance/provenance_checksum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "results/chunk_codec.hpp"
#include "results/store_error.hpp"

namespace frahm::studies {

std::string checksum_of(std::vector<results::Text> texts) {
  std::ranges::sort(texts);
  std::string all;
  for (const auto& [name, text] : texts) {
    if (name != checksum_text) all += fmt::format("{}={}\n", name, text);
  }
  return fmt::format("{:08x}", results::fletcher32(std::as_bytes(std::span(all))));
}

void refuse_changed_provenance(const results::MapReader& result) {
  if (!result.has_group("provenance")) return;
  const std::vector<results::Text> texts = result.texts("provenance");
  const auto stated = std::ranges::find(texts, checksum_text, &results::Text::first);
  if (stated == texts.end()) return;
  if (const std::string found = checksum_of(texts); found != stated->second)
    throw results::StoreError(
        result.path().string() + ":/provenance",
        fmt::format("its texts, such as the study, were changed after they were written: "
                    "their checksum is {}, not {}",
                    found, stated->second),
        "");
}

}  // namespace frahm::studies
