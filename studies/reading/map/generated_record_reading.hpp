#pragma once

#include <cstddef>
#include <string>

#include "solvers/transient/generated_records.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study_context.hpp"

namespace frahm::studies {

// Records that are made, one for each stream of the seed.
struct GeneratedRecords {
  std::string kind;  // white or kanai_tajimi
  std::size_t count = 0;
  transient::RandomSampling sampling;  // of the first
  transient::GroundNoise ground;       // of white only its intensity
};
GeneratedRecords read_generated(const StudyContext& context, const TomlSection& axis);

}  // namespace frahm::studies
