#pragma once

#include <span>
#include <string>

#include "engine/fingerprint.hpp"
#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// How the points of a map are cut into tiles: order of its dimensions, points of a tile along each.
struct Tiling {
  std::span<const std::size_t> order;
  std::span<const std::uint64_t> tile;
};

// A hash of all that the results of a study depend on (XXH3, 128 bits, as hex): what its document says key by
// key (document_facts.hpp), by the use that the table of keys gives each of them, and what files and draws
// give.
// quantities: names of those recorded.
// physics: Use::physics, the values of the parameters (of those on an axis only that they are on one), contents
// of files, version of the solver. grid: Use::grid and Use::shown, the SI values along the axes and the tiles.
// Titles and what is said on pages (Use::label), comments, names of files, the order of keys and parameters,
// defaults that are written out, and the unit in which one and the same number is given change neither.
engine::Fingerprint fingerprint(const Study& study, Tiling tiling = {},
                                std::span<const std::string> quantities = {});

// The fingerprint of the shard logs of a map that grows from the result with this identity.
engine::Fingerprint grown_fingerprint(const engine::Fingerprint& study, const std::string& identity);

// The fingerprint of one branch of a sweep.  course: the parameter followed, its range, all that a branch
// depends on in addition to the physics of the study.
engine::Fingerprint branch_fingerprint(const engine::Fingerprint& study, const std::string& course);

// A hash that identifies one result, made from its texts: among them the study, who computed it and when, and
// the result from which it grew.
std::string identity_of(std::span<const results::Text> provenance);

}  // namespace frahm::studies
