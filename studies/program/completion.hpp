#pragma once

#include <string>

#include "studies/program/command_tree.hpp"

namespace frahm::studies {

// A script that completes commands, options and their values in a shell: "bash", "zsh" or "fish".
std::string completion_script(const Command& program, const std::string& shell);

}  // namespace frahm::studies
