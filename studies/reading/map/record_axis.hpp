#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "solvers/transient/generated_records.hpp"
#include "studies/reading/map/generated_record_reading.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/system/driving_record.hpp"

// An axis of records, [[axis]] records = [files] or { generate = ... }, and all records of a transient.
namespace frahm::studies {

inline constexpr const char* record_dimension = "record";  // its name in the map

struct WrittenRecordAxis {
  Position position;  // of the [[axis]], or of [tune]
  std::variant<std::vector<RecordFile>, GeneratedRecords> records;

  std::size_t size() const;
  std::vector<std::string> names() const;  // of each record
};

// The records at the key "records" of a section.
WrittenRecordAxis read_records(const StudyContext& context, const TomlSection& section);

// Whether an [[axis]] is of records.
bool is_record_axis(const TomlValue& table);

// The axis of records, if there is one. Throws StudyError for several.
std::optional<WrittenRecordAxis> read_record_axis(const StudyContext& context, const TomlValue& root);

// The dimension of the map that is the axis of records at a table. Throws StudyError for one in a study that
// nothing drives by records.
void add_record_axis(const StudyContext& context, const TomlValue& root, const TomlValue& table,
                     Study& study);

// What drives each recorded component of a study whose network is read: corners (NetworkOfStudy::driving),
// then records.  axis: of those that name no file. giver: what may give records, for messages.  folder: of
// their files.
std::vector<DrivingRecord> read_driving_records(const StudyContext& context, const TomlValue& root,
                                                const std::filesystem::path& folder, DataFiles data,
                                                const mechanics::Network& network,
                                                std::vector<DrivingRecord> corners,
                                                const std::optional<WrittenRecordAxis>& axis,
                                                const char* giver);

}  // namespace frahm::studies
