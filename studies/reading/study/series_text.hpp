#pragma once

#include <string>
#include <vector>

#include "studies/reading/study/study_values.hpp"

namespace frahm::studies {

// What each period of a study became: `motion of "base": Fourier series to order 40, 20 of them not zero;
// 0.12 % of its root mean square is left out`.
std::vector<std::string> series_texts(const StudyValues& values);

}  // namespace frahm::studies
