#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/fingerprint.hpp"
#include "studies/provenance/study_plan.hpp"

// The note next to an unfinished output that holds the study of its shard logs, so that these can be merged
// without the study's file: `<output>.<fingerprint>.frahm-study`. Its lines: the path of the study, the
// number of overrides, each override; then the text of the study. For a growing map, the identity of the
// result it grows from follows the number of overrides, and that result's file name is on the next line.
namespace frahm::studies {

// Returns whether there was no note before. Throws engine::IoError, also where another file has its name.
bool write_study_note(const std::filesystem::path& output, const StudyPlan& plan);

// Whether a log of this study is next to the output. Throws engine::IoError.
bool has_log_of(const std::filesystem::path& output, const StudyPlan& plan);

// A study read from its note.
struct NotedStudy {
  Study study;                   // with the overrides
  std::vector<std::string> set;  // the overrides, as given
  std::optional<EarlierResult> grown_from;
  std::filesystem::path note;
};

// The study that the logs with this header belong to. outputs: files next to which its note may lie. Throws
// engine::IoError if no note is next to them, StudyError if tables of the study are neither at their old path
// nor next to the note, or can no longer be read.
NotedStudy study_from_note(const std::vector<std::filesystem::path>& outputs,
                           const engine::LogHeader& header);

// The earlier result from which the map of these logs grows; nothing without one or without its note. Throws
// engine::IoError.
std::optional<EarlierResult> source_of_logs(const std::filesystem::path& output,
                                            const engine::LogHeader& header);

// Throws engine::IoError if the plan made from the study no longer matches the logs.
void check_note_gives(const StudyPlan& plan, const NotedStudy& noted, const engine::LogHeader& header);

// Removes the note of one study.
void remove_study_note(const std::filesystem::path& output, const StudyPlan& plan);

// Removes the notes of an output, for any study.
void remove_study_notes(const std::filesystem::path& output);

}  // namespace frahm::studies
