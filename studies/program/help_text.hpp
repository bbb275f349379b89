#pragma once

#include <string>

#include "studies/program/command_tree.hpp"

namespace frahm::studies {

// The help of the program or of one of its commands. help2man makes the manual pages of it.
std::string help_text(const Command& command);

// The help of the command of this name, "" for that of the program; of a kind of study, which has no command
// of its own, how it is computed.  tree: of the program.  Throws StudyError for another name.
std::string help_for(const Command& tree, const std::string& name);

// What to say of a command that there is not.
std::string unknown_command(const Command& tree, const std::string& name);

}  // namespace frahm::studies
