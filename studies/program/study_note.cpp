#include "studies/program/study_note.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <sstream>
#include <system_error>
#include <utility>

#include "engine/file.hpp"
#include "engine/io_error.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/reading/assignment.hpp"

namespace frahm::studies {
namespace {

constexpr std::string_view note_suffix = ".frahm-study";

std::filesystem::path note_path(const std::filesystem::path& output, const engine::Fingerprint& fingerprint) {
  return fmt::format("{}.{}-{}{}", output.string(), fingerprint.physics.substr(0, 16),
                     fingerprint.grid.substr(0, 16), note_suffix);
}

struct StudyNote {
  std::filesystem::path study;
  std::vector<std::string> set;
  std::optional<EarlierResult> grown_from;
  std::string text;
};

// Reads the line after the study's path, and that of the earlier result if there is one. Returns the number
// of overrides.
std::size_t read_numbers(std::istream& file, StudyNote& note) {
  std::string line;
  std::getline(file, line);
  std::istringstream numbers(line);
  std::size_t overrides = 0;
  if (!(numbers >> overrides)) file.setstate(std::ios::failbit);
  EarlierResult earlier;
  if (numbers >> earlier.identity && std::getline(file, earlier.file)) note.grown_from = earlier;
  return overrides;
}

std::optional<StudyNote> read_note(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  StudyNote note;
  std::string line;
  std::getline(file, line);
  note.study = line;
  const std::size_t overrides = read_numbers(file, note);
  for (std::size_t i = 0; i < overrides && std::getline(file, line); ++i) note.set.push_back(line);
  if (!file) throw engine::IoError(path, "this note of a study is damaged; run the study again to mend it");
  note.text.assign(std::istreambuf_iterator<char>(file), {});
  return note;
}

// The study of a note. If the note was moved with its tables and logs, the tables are beside the note and no
// longer at the study's old path.
Study study_of_note(const StudyNote& note, const std::filesystem::path& path) {
  try {
    return parse_study(note.text, note.study);
  } catch (const StudyError& as_kept) {
    try {
      return parse_study(note.text, path.parent_path() / note.study.filename());
    } catch (const StudyError&) {
      throw as_kept;
    }
  }
}

}  // namespace

bool write_study_note(const std::filesystem::path& output, const StudyPlan& plan) {
  std::string text =
      fmt::format("{}\n{}", std::filesystem::absolute(plan.study.source.name).string(), plan.set.size());
  if (plan.grown_from) text += fmt::format(" {}\n{}", plan.grown_from->identity, plan.grown_from->file);
  text += '\n';
  for (const std::string& set : plan.set) text += set + '\n';
  text += plan.study.source.text;
  const std::filesystem::path path = note_path(output, plan.log_header().fingerprint);
  // Other shards may be writing the same note at this moment: each renames its complete file.
  const std::filesystem::path own = fmt::format("{}-{:08x}", path.string(), std::random_device()());
  write_whole_file(own, text);
  std::error_code error;
  const bool is_new = !std::filesystem::exists(path, error);
  std::filesystem::rename(own, path, error);
  if (error) throw engine::IoError(path, "write", error.value());
  return is_new;
}

NotedStudy study_from_note(const std::vector<std::filesystem::path>& outputs,
                           const engine::LogHeader& header) {
  for (const auto& output : outputs) {
    const std::filesystem::path path = note_path(output, header.fingerprint);
    const auto note = read_note(path);
    if (!note) continue;
    Study study = study_of_note(*note, path);
    for (const std::string& set : note->set) {
      const std::vector<Assignment> assignments = parse_assignments(study, "--set", set);
      study = with_parameters(std::move(study), assignments);
    }
    return {std::move(study), note->set, note->grown_from, path};
  }
  throw engine::IoError(
      note_path(outputs.front(), header.fingerprint),
      fmt::format("the study of the shard logs is not kept here; frahm run STUDY -o {} writes it",
                  outputs.front().string()));
}

std::optional<EarlierResult> source_of_logs(const std::filesystem::path& output,
                                            const engine::LogHeader& header) {
  const auto note = read_note(note_path(output, header.fingerprint));
  return note ? note->grown_from : std::nullopt;
}

void check_note_gives(const StudyPlan& plan, const NotedStudy& noted, const engine::LogHeader& header) {
  if (plan.log_header() == header) return;
  throw engine::IoError(noted.note,
                        "the study kept here no longer gives what the logs were made from: a table it reads, "
                        "or this program, has changed");
}

void remove_study_note(const std::filesystem::path& output, const StudyPlan& plan) {
  std::error_code ignored;  // a note left behind is harmless
  std::filesystem::remove(note_path(output, plan.log_header().fingerprint), ignored);
}

void remove_study_notes(const std::filesystem::path& output) {
  const std::string prefix = output.filename().string() + ".";
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(engine::directory_of(output), error)) {
    const std::string name = entry.path().filename().string();
    // Names with more text behind the suffix are notes left half written by a kill.
    if (name.starts_with(prefix) && name.find(note_suffix) != std::string::npos) {
      std::filesystem::remove(entry.path(), error);
    }
  }
}

}  // namespace frahm::studies
