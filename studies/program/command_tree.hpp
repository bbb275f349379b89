#pragma once

#include <string>
#include <vector>

namespace frahm::studies {

// An option or a positional argument of a command.
struct CommandOption {
  std::vector<std::string> names{};  // "-o", "--output"; of a positional its one name, "STUDY"
  std::string value{};  // what stands after it, "FILE"; "auto|plain" for one of these; "": nothing
  std::string what;
  bool is_positional = false;
  bool is_required = false;
  bool is_list = false;  // of a positional: several may be given
};

// A command with its options and, of the program itself, its commands: what help, completion and manual pages
// are made of.
struct Command {
  std::string name;  // as it is called: "frahm run"
  std::string what;
  std::string foot;  // examples
  std::vector<CommandOption> options{};
  std::vector<Command> commands{};

  std::string last_word() const { return name.substr(name.rfind(' ') + 1); }
};

// The choices of an option whose value is one of a few words; otherwise none.
std::vector<std::string> choices_of(const CommandOption& option);

}  // namespace frahm::studies
