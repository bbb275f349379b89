#include "engine/fingerprint.hpp"

#include <fmt/format.h>

namespace frahm::engine {
namespace {

std::string difference(const LogHeader& kept, const LogHeader& wanted) {
  if (kept.fingerprint.physics != wanted.fingerprint.physics) {
    return fmt::format("keeps tiles of another physics ({}, this study has {})", kept.fingerprint.physics,
                       wanted.fingerprint.physics);
  }
  return fmt::format(
      "keeps tiles of the same physics on another grid ({} of {} tiles, this study has {} of {} tiles)",
      kept.fingerprint.grid, kept.tiles, wanted.fingerprint.grid, wanted.tiles);
}

}  // namespace

ResumeRefused::ResumeRefused(const std::filesystem::path& log, const LogHeader& kept, const LogHeader& wanted)
    : std::runtime_error(fmt::format("{} {}; results of different studies are never mixed", log.string(),
                                     difference(kept, wanted))),
      log_(log),
      kept_(kept),
      wanted_(wanted) {}

}  // namespace frahm::engine
