#include "studies/program/growing.hpp"

#include <fmt/format.h>

#include <optional>
#include <system_error>

#include "engine/io_error.hpp"
#include "studies/program/refusal_advice.hpp"
#include "studies/program/study_note.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/study_changes.hpp"

namespace frahm::studies {

bool grows_in_place(const StudyPlan& plan, const std::filesystem::path& from,
                    const std::filesystem::path& output) {
  std::error_code ignored;  // one that is not there is not the other
  if (from.empty() || !std::filesystem::equivalent(from, output, ignored)) return false;
  const results::MapReader standing(output);
  return fingerprint_of(standing) != plan.fingerprint || is_part(standing);
}

void refuse_loss(const MapPlan& plan, const KnownPoints& earlier, const std::filesystem::path& from,
                 const std::filesystem::path& output) {
  std::error_code ignored;  // one that is not there is not the other
  const std::uint64_t lost = earlier.off_grid();
  if (lost == 0 || !std::filesystem::equivalent(from, output, ignored)) return;
  throw engine::ResumeRefused(
      output, fingerprint_of(results::MapReader(output)), plan.fingerprint,
      fmt::format("it holds {} points that this grid does not have, which would be lost: name another file "
                  "with -o; --from {} reuses its points there too",
                  lost, from.string()));
}

std::string advice_about_logs(const engine::ResumeRefused& refused, const StudyPlan& plan,
                              const std::filesystem::path& output) {
  if (refused.physics_differs() || !plan.study.map())
    return refusal_advice(changes_since_logs(refused, plan.study, output));
  constexpr const char* otherwise = "name another file with -o, or discard what is there with --fresh";
  if (refused.kept() == plan.header_of_logs(""))
    return fmt::format("it was begun without --from: leave out --from to resume, {}", otherwise);
  const auto source = source_of_logs(output, refused.kept());
  if (source && refused.kept() == plan.header_of_logs(source->identity)) {
    if (!plan.grown_from)
      return fmt::format("it was begun with --from {0}: add --from {0} to resume, {1}", source->file,
                         otherwise);
    return fmt::format(
        "it was begun with --from {}, which has changed since: give the same file to resume, {}",
        source->file, otherwise);
  }
  return refusal_advice(
      changes_since_logs(refused, plan.study, output),
      fmt::format("finish that run first, or make a map of the finished points with \"frahm merge {0} "
                  "--partial\"; then add --from {0} -o ANOTHER.h5 to reuse its points; or {1}",
                  output.string(), otherwise));
}

}  // namespace frahm::studies
