#include "engine/fingerprint.hpp"

#include <fmt/format.h>

#include <utility>

namespace frahm::engine {
namespace {

std::string difference(const LogHeader& kept, const LogHeader& wanted) {
  if (kept.fingerprint.physics != wanted.fingerprint.physics) {
    return fmt::format("holds tiles of another system ({}, this study has {})", kept.fingerprint.physics,
                       wanted.fingerprint.physics);
  }
  return fmt::format(
      "holds tiles of the same physics on another grid ({} of {} tiles, this study has {} of {} tiles)",
      kept.fingerprint.grid, kept.tiles, wanted.fingerprint.grid, wanted.tiles);
}

std::string difference(const Fingerprint& kept, const Fingerprint& wanted) {
  if (kept.physics != wanted.physics) {
    return fmt::format("is the result of another system ({}, this study has {})", kept.physics,
                       wanted.physics);
  }
  return fmt::format(
      "is the result of the same physics for other points, coordinates, samples or another duration ({}, "
      "this study has "
      "{})",
      kept.grid, wanted.grid);
}

}  // namespace

ResumeRefused::ResumeRefused(const std::filesystem::path& log, const LogHeader& kept, const LogHeader& wanted)
    : std::runtime_error(fmt::format("{} {}; results of different studies are never mixed", log.string(),
                                     difference(kept, wanted))),
      log_(log),
      kept_(kept),
      wanted_(wanted) {}

ResumeRefused::ResumeRefused(const std::filesystem::path& result, const Fingerprint& kept,
                             const Fingerprint& wanted, std::string advice)
    : std::runtime_error(fmt::format("{} {}", result.string(), difference(kept, wanted))),
      log_(result),
      kept_({kept, 1}),
      wanted_({wanted, 1}),
      advice_(std::move(advice)) {}

ResumeRefused::ResumeRefused(const ResumeRefused& refused, std::string advice) : ResumeRefused(refused) {
  advice_ = std::move(advice);
}

}  // namespace frahm::engine
