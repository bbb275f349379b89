#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/fingerprint.hpp"
#include "results/map_reader.hpp"

namespace frahm::studies {

// The fingerprint of the study that a result was made from.
engine::Fingerprint fingerprint_of(const results::MapReader& map);

// What a result holds: told by its axes and groups (FORMAT.md).
enum class ResultKind { map, branch, tuning, identification, motion };
ResultKind kind_of(const results::MapReader& result);
std::string noun_of(const results::MapReader& result);  // "a tuning"

// The group that holds a result that is no map: "decay", "optimum"; "" of a map.
std::string own_group(const results::MapReader& result);

// The text of /provenance with the number of tiles missing from a file made by merge --partial.
inline constexpr const char* missing_tiles_text = "missing_tiles";
// The text of /provenance with the identity of the result from which this one grew.
inline constexpr const char* grown_from_identity = "grown_from_identity";
// The text of /provenance with the course of a branch.
inline constexpr const char* branch_course_text = "branch";

// Refuses a study where the name of a result is needed. Throws StudyError.
void refuse_study(const std::filesystem::path& result);

// Throws engine::IoError for a folder where the name of a result is needed.
void refuse_folder(const std::filesystem::path& result);

// Throws engine::IoError if there is no such result: an unfinished run, a wrong name or a folder; StudyError
// for a study.
void require_result(const std::filesystem::path& path);

// Whether a result was made by merge --partial.
bool is_part(const results::MapReader& map);

// A file takes the place of another of its name in one step, which would leave of a link nothing. Throws
// engine::IoError for a link, wherever it points.
void refuse_link(const std::filesystem::path& output);

// Throws engine::IoError if the folder in which an output is to be made does not exist.
void require_folder_of(const std::filesystem::path& output);

// A result may be a new file or replace another result; it never replaces a study, a table, any other file, a
// folder, a device or a link, nor has it the name of a study.  study: the study's own file; empty: not known.
// fresh: of a command with --fresh, whether it is given, and a result that is damaged replaced.
// Throws engine::IoError, StudyError for the name of a study.
void check_result_place(const std::filesystem::path& output, const std::filesystem::path& study,
                        std::optional<bool> fresh = std::nullopt);

// Reads all of a result, of a part of one what there is. Throws results::StoreError if it is damaged.
// advice: what to do, for the message.
void refuse_damage(const results::MapReader& result, const std::string& advice);

// A result that a command reads and that agrees with its checksums. Throws as require_result and
// refuse_damage do.
results::MapReader undamaged_result(const std::filesystem::path& path);

// A text of /provenance; empty if there is none of this name.
std::string provenance_text(const results::MapReader& map, const std::string& name);

}  // namespace frahm::studies
