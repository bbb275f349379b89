#include "studies/map/finished_file.hpp"

namespace frahm::studies {

std::optional<engine::Fingerprint> fingerprint_of_file(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const results::MapReader map(path);
  return engine::Fingerprint{.physics = provenance_text(map, "fingerprint_physics"),
                             .grid = provenance_text(map, "fingerprint_grid")};
}

std::string provenance_text(const results::MapReader& map, const std::string& name) {
  if (!map.has_group("provenance")) return "";
  for (const auto& [key, text] : map.texts("provenance")) {
    if (key == name) return text;
  }
  return "";
}

}  // namespace frahm::studies
