#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Where the points of a study's map lie along one dimension of an earlier map.
struct EarlierDimension {
  static constexpr std::uint64_t nowhere = std::numeric_limits<std::uint64_t>::max();

  std::size_t along = 0;             // the dimension of the study that determines it
  std::vector<std::uint64_t> index;  // for each index of that: the index in the earlier map, or `nowhere`
  std::uint64_t places = 0;          // number of different ones along it in the earlier map
};

// How many points of an earlier map, equal ones counted once, are not in the study's map.
std::uint64_t points_off_grid(const std::vector<EarlierDimension>& dimensions);

// Matches each dimension of an earlier map of the same physics. Parameters are compared by their SI values
// (value_match.hpp), so that the axes may have other values, steps, units and order.
// file: the earlier map, for messages.  Throws StudyError where an axis has no value in common, and where
// parameters that advanced together have dimensions of their own now.
std::vector<EarlierDimension> match_axes(const Study& study, const results::MapLayout& earlier,
                                         const std::string& file);

// Throws results::StoreError where the axes of a map made of the study are others than the study's: their
// names, order, sizes or values (in any unit), which a checksum would not show in files of earlier versions.
// advice: what to do, for the message.
void refuse_other_axes(const Study& study, const results::MapLayout& map, const std::string& file,
                       const std::string& advice);

}  // namespace frahm::studies
