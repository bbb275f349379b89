#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/reading/study/study_context.hpp"
#include "studies/reading/system/recorded_excitation.hpp"

// The samples of records that drive a transient, from their files.
namespace frahm::studies {

struct RecordFile {
  std::string name;   // as the study writes it
  Position position;  // of the name
};

// Two columns of a file in SI, by the section's `time`, `column` and `unit`.
struct Samples {
  std::vector<double> time;    // [s], ascending
  std::vector<double> values;  // as many
};
// of: what the values are of; an acceleration in g is one in standard gravity.  quantity: theirs.  folder: of
// the study. Throws StudyError for what is wrong with columns or units.
Samples read_samples(const StudyContext& context, const TomlSection& section, const RecordFile& file,
                     const std::filesystem::path& folder, transient::RecordOf of, Quantity quantity);

// The record of [[excitation.record]] from a file: its columns in SI, cut to the section's window, its time
// counted from the window's start.  folder: of the study.
// Throws StudyError for what is wrong with columns or units, for fewer samples than the interpolation needs,
// for a spline that strays from them or straight lines where an inerter hangs, and for a window that the
// record does not fill.
transient::Record read_driving_record(const StudyContext& context, const TomlSection& section,
                                      const RecordFile& file, const std::filesystem::path& folder,
                                      const mechanics::Network& network);

// The part of a record in the section's window, `from` and `to`.
transient::Record in_window(const StudyContext& context, const TomlSection& section, const RecordFile& file,
                            transient::Record record);

}  // namespace frahm::studies
