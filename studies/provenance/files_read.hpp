#pragma once

#include <string>

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The text of /provenance with the files from which a study reads its system, so that another content is
// noticed when the result is read again.
inline constexpr const char* files_read_text = "files_read";

// That text: a line for each table of a parameter and each part of the system that matrices give, with a
// digest of its numbers; "" where there are none.
std::string files_read(const Study& study);

// stored: that text of a result, "" where it has none.  Throws StudyError, naming the first of them, if the
// study read other numbers now.  file: of the result, for the message.
void refuse_changed_files(const Study& study, const std::string& stored, const std::string& file);

}  // namespace frahm::studies
