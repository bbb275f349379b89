#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "studies/reading/study/study.hpp"

// Elements that some kinds of study do not follow, or not next to others.
namespace frahm::studies {

// What makes an element's law smooth, where it is: its key, and the law's name, "arctan", or the key again.
struct SmoothKey {
  std::string where;
  Position position;
  const char *key, *law;
};
SmoothKey smooth_key(const Study& study, std::size_t element);

// Refuses elements that bend.
void refuse_bends(const Study& study, const std::string& why);
// Refuses smooth laws in a study whose solver follows the exact ones.
void refuse_smooth_laws(const Study& study, std::string_view what_is_exact);
// Refuses smooth laws beside contacts that are followed exactly, beside elements that bend, and beside
// joints.
void refuse_mixed_laws(const Study& study);
// Refuses elements with which several responses may exist; where they depend on numbers, element_problem()
// does.
void refuse_several_responses(const Study& study, const std::string& what_needs_one);
// The message where a choice between responses is made, but one response alone exists.
std::string only_one_response();
// What of the study needs that there is one response, "" if nothing does.
std::string needs_one_response(const Study& study);

}  // namespace frahm::studies
