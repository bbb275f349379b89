#pragma once

#include <string>

namespace frahm::studies {

// "12.5 MB"
std::string readable_size(double bytes);

}  // namespace frahm::studies
