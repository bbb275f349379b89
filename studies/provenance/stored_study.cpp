#include "studies/provenance/stored_study.hpp"

#include "studies/provenance/files_read.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/provenance_checksum.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/assignment.hpp"

namespace frahm::studies {

StoredStudy read_stored_study(const results::MapReader& result, const std::filesystem::path& file) {
  refuse_changed_provenance(result);
  const std::filesystem::path study_file = provenance_text(result, "study_file");
  StoredStudy stored;
  stored.study =
      parse_study(provenance_text(result, "study"), file.parent_path() / study_file, DataFiles::leave);
  const std::string overrides = provenance_text(result, "overrides");
  if (!overrides.empty()) {
    stored.overrides = parse_assignments(stored.study, "--set", overrides);
    stored.study = with_parameters(std::move(stored.study), stored.overrides);
  }
  refuse_changed_files(stored.study, provenance_text(result, files_read_text), file.string());
  return stored;
}

}  // namespace frahm::studies
