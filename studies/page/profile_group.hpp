#pragma once

#include <string>
#include <vector>

#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The profile of a study, /page/profile (results/FORMAT.md). Texts: `masses`, the lowest first; `springs`,
// for each mass the first spring that joins it to the one below, the lowest to ground or to a support, empty
// where none does; `owners`, all masses and elements, whose names begin those of quantities. Lists are
// separated by commas; `hint`, where the study has not chosen the masses. Column `height` along `place`,
// where heights are known.
results::GroupContent profile_group(const Study& study, const Profile& profile);

// The recorded quantities that it is drawn from: peaks of its masses, strokes of its springs.
std::vector<std::string> profile_quantities(const Study& study, const Profile& profile,
                                            const std::vector<results::Variable>& recorded);

}  // namespace frahm::studies
