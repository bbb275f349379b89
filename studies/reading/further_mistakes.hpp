#pragma once

#include <functional>

#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// Reads a document as a study. Throws StudyError for the first mistake it meets.
using ReadDocument = std::function<void(const TomlValue& root)>;

// The first mistake and those that the document has besides, in the order of the file, with their count: what
// is wrong is left out and the rest is read again. Mistakes that may only follow from what was left out are
// not told. The error has the rule and the position of the first.
StudyError with_further_mistakes(const StudyError& first, TomlValue root, const ReadDocument& read);

}  // namespace frahm::studies
