#pragma once

#include <filesystem>
#include <string>

#include "engine/fingerprint.hpp"
#include "studies/map/known_points.hpp"
#include "studies/map/map_plan.hpp"

// `frahm run --from OLD.h5`: what has to be seen to when a map takes points over from an earlier result.
namespace frahm::studies {

// Whether the result takes the place of the one it grows from, which is that of another grid or a part: it is
// then no obstacle, and stays there until the new one is complete.  from: empty: the run has no --from.
bool grows_in_place(const StudyPlan& plan, const std::filesystem::path& from,
                    const std::filesystem::path& output);

// Refuses a result that would take the place of the one it grows from and has not all of its points: these
// would be lost. earlier: those of `from`. Throws engine::ResumeRefused.
void refuse_loss(const MapPlan& plan, const KnownPoints& earlier, const std::filesystem::path& from,
                 const std::filesystem::path& output);

// What to do about logs beside the output that the run may not go on with; empty: no more than about those of
// any other study.
std::string advice_about_logs(const engine::ResumeRefused& refused, const StudyPlan& plan,
                              const std::filesystem::path& output);

}  // namespace frahm::studies
