#pragma once

#include <filesystem>
#include <string>

#include "engine/fingerprint.hpp"
#include "studies/map/known_points.hpp"
#include "studies/map/map_plan.hpp"

// `frahm run --from OLD.h5`: checks for a map that takes points over from an earlier result.
namespace frahm::studies {

// Whether the result replaces the one it grows from, which has another grid or is partial:
// the old one is then no obstacle and stays until the new one is complete.  from: empty: the run has no
// --from.
bool grows_in_place(const StudyPlan& plan, const std::filesystem::path& from,
                    const std::filesystem::path& output);

// Refuses a result that would replace the one it grows from but lacks some of its points: these would be
// lost. earlier: the points of `from`. Throws engine::ResumeRefused.
void refuse_loss(const MapPlan& plan, const KnownPoints& earlier, const std::filesystem::path& from,
                 const std::filesystem::path& output);

// Advice about logs next to the output that the run cannot resume; empty: the same as for logs of any other
// study.
std::string advice_about_logs(const engine::ResumeRefused& refused, const StudyPlan& plan,
                              const std::filesystem::path& output);

}  // namespace frahm::studies
