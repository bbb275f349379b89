#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/fingerprint.hpp"
#include "studies/record/study_plan.hpp"

// The note beside an unfinished output that keeps the study its shard logs belong to, so that they can be
// merged without it: `<output>.<fingerprint>.frahm-study`. Its lines: the path of the study, the number of
// overrides, each override; then the text of the study. Of a map that grows, behind the number of overrides
// the identity of the result it grows from, and on the next line that file's name.
namespace frahm::studies {

// Returns whether there was none before. Throws engine::IoError.
bool write_study_note(const std::filesystem::path& output, const StudyPlan& plan);

// A study as its note keeps it.
struct NotedStudy {
  Study study;                   // with the overrides
  std::vector<std::string> set;  // these, as given
  std::optional<EarlierResult> grown_from;
  std::filesystem::path note;
};

// The study that the logs with this header belong to. outputs: files beside which its note may lie. Throws
// engine::IoError if it is beside none, StudyError if tables it reads are neither where they
// were nor beside the note, or can no longer be read.
NotedStudy study_from_note(const std::vector<std::filesystem::path>& outputs,
                           const engine::LogHeader& header);

// The result from which the map grows that these logs belong to, if it does and its note is there. Throws
// engine::IoError.
std::optional<EarlierResult> source_of_logs(const std::filesystem::path& output,
                                            const engine::LogHeader& header);

// Throws engine::IoError if the plan made of the study is not that of the logs any more.
void check_note_gives(const StudyPlan& plan, const NotedStudy& noted, const engine::LogHeader& header);

// Removes the note of one study.
void remove_study_note(const std::filesystem::path& output, const StudyPlan& plan);

// Removes the notes of an output, whatever their study.
void remove_study_notes(const std::filesystem::path& output);

}  // namespace frahm::studies
