#pragma once

#include <string>

#include "studies/program/command_tree.hpp"

namespace frahm::studies {

// The help of the program or of one of its commands. help2man makes the manual pages of it.
std::string help_text(const Command& command);

}  // namespace frahm::studies
