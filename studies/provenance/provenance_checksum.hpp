#pragma once

#include <string>
#include <vector>

#include "results/map_reader.hpp"

namespace frahm::studies {

// The text of /provenance with the checksum of its other texts, which HDF5 keeps without one.
inline constexpr const char* checksum_text = "checksum";

// For all texts but that of the checksum itself, whatever their order: eight hexadecimal digits.
std::string checksum_of(std::vector<results::Text> texts);

// Throws results::StoreError where the texts of /provenance, among them that of the study, are not those that
// were written. A file without a checksum, of an earlier version, has nothing to tell.
void refuse_changed_provenance(const results::MapReader& result);

}  // namespace frahm::studies
