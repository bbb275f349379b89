#include "studies/program/study_note.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>
#include <system_error>
#include <utility>

#include "engine/file.hpp"
#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "results/part_file.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/assignment.hpp"
#include "studies/reading/text/plain_text.hpp"

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
  std::error_code ignored;  // what is not there is no note
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  StudyNote note;
  std::string line;
  std::getline(file, line);
  note.study = line;
  const std::size_t overrides = read_numbers(file, note);
  for (std::size_t i = 0; i < overrides && std::getline(file, line); ++i) note.set.push_back(line);
  if (!file || !note.study.is_absolute())
    throw engine::IoError(path, "this note of a study is damaged; run the study again to mend it");
  try {
    note.text.assign(std::istreambuf_iterator<char>(file), {});
  } catch (const std::ios_base::failure& failure) {  // of the buffer itself: a disk that cannot read
    throw engine::IoError(path, fmt::format("cannot be read: {}", failure.code().message()));
  }
  return note;
}

// The note that a file's name is of: the note itself or a part of it; nothing for another file's.
std::optional<std::string> note_of_name(const std::string& name, const std::string& output) {
  if (!name.starts_with(output + ".")) return std::nullopt;
  static const std::regex form("([0-9a-f]{1,16}-[0-9a-f]{1,16}\\.frahm-study)(\\.part-[0-9a-f]{16})?");
  const std::string rest = name.substr(output.size() + 1);
  std::smatch part;
  if (!std::regex_match(rest, part, form)) return std::nullopt;
  return fmt::format("{}.{}", output, part[1].str());
}

// Whether a file has the form of a note, so that it is ours to remove.
bool is_note(const std::filesystem::path& path) {
  try {
    return read_note(path).has_value();
  } catch (const engine::IoError&) {
    return false;
  }
}

bool is_there(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
}

// A file of that name which is no note is somebody's work, unless a log of the study shows that a note was
// here, which is then damaged. One of nothing but zeros is what a power failure leaves.
void refuse_foreign_file(const std::filesystem::path& path, const std::filesystem::path& output,
                         const StudyPlan& plan) {
  refuse_link(path);
  const auto file = engine::File::open_if_present(path);
  if (!file || is_note(path) || file->holds_only_zeros() || has_log_of(output, plan)) return;
  throw engine::IoError(path, "exists already and is not a note of frahm; remove or rename it");
}

// Other shards may be writing the same note at this moment: each renames its complete file. Where two
// machines share no locks, each may take the other's part for one left by a killed process; then it is
// written again.
void write_whole(const std::filesystem::path& path, const std::string& text) {
  constexpr int most_attempts = 20;
  for (int attempt = 1;; ++attempt) {
    results::PartFile part(path);
    try {
      part.write(text);
      return part.publish();
    } catch (const results::PartTaken&) {
      if (attempt == most_attempts) throw;
    }
  }
}

// The study of a note. If the note was moved with its tables and logs, the tables are next to the note and no
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
  const std::string study = std::filesystem::absolute(plan.study.source.name).string();
  if (!is_plain_line(study))
    throw StudyError(rules::wrong_file, "\"{}\": a path must be UTF-8 without control characters", study);
  std::string text = fmt::format("{}\n{}", study, plan.set.size());
  if (plan.grown_from) text += fmt::format(" {}\n{}", plan.grown_from->identity, plan.grown_from->file);
  text += '\n';
  for (const std::string& set : plan.set) text += set + '\n';
  text += plan.study.source.text;
  const std::filesystem::path path = note_path(output, plan.log_header().fingerprint);
  const bool is_new = !is_there(path);
  if (!is_new) refuse_foreign_file(path, output, plan);
  write_whole(path, text);
  return is_new;
}

bool has_log_of(const std::filesystem::path& output, const StudyPlan& plan) {
  return std::ranges::any_of(engine::find_logs(output), [&](const std::filesystem::path& log) {
    try {
      return engine::study_of_log(log) == plan.log_header();
    } catch (const engine::IoError&) {  // somebody else's
      return false;
    }
  });
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
  throw engine::IoError(
      noted.note,
      "the study kept here no longer matches the logs: a table that it reads, or this program, has changed");
}

void remove_study_note(const std::filesystem::path& output, const StudyPlan& plan) {
  std::error_code ignored;  // a note that is left is harmless
  std::filesystem::remove(note_path(output, plan.log_header().fingerprint), ignored);
}

void remove_study_notes(const std::filesystem::path& output) {
  std::error_code error;
  std::vector<std::filesystem::path> notes;
  for (const auto& entry : std::filesystem::directory_iterator(engine::directory_of(output), error)) {
    const std::string name = entry.path().filename().string();
    if (const auto note = note_of_name(name, output.filename().string()))
      notes.push_back(entry.path().parent_path() / *note);
  }
  for (const std::filesystem::path& note : notes) {
    results::remove_dead_parts(note);
    if (is_note(note)) std::filesystem::remove(note, error);
  }
}

}  // namespace frahm::studies
