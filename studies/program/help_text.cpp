#include "studies/program/help_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "studies/program/starter_studies.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t width = 100;       // of a line of help
constexpr std::size_t widest_name = 28;  // a longer one has a line of its own

// `-o, --output FILE`
std::string spoken(const CommandOption& option) {
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
  if (!option.is_positional && !option.value.empty()) text += " " + option.value;
  return text;
}

// A name and what it means, broken into lines of the given width, the later ones indented.
std::string entry(const std::string& name, const std::string& what) {
  std::string text = "  " + name;
  const std::size_t indent = widest_name + 2;
  std::size_t column = text.size();
  if (column + 2 > indent) {
    text += "\n";
    column = 0;
  }
  text += std::string(indent - column, ' ');
  column = indent;
  std::istringstream words(what);
  bool is_first = true;
  for (std::string word; words >> word;) {
    if (!is_first && column + 1 + word.size() > width) {
      text += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!is_first) {
      text += " ";
      ++column;
    }
    text += word;
    column += word.size();
    is_first = false;
  }
  return text + "\n";
}

std::string usage(const Command& command) {
  std::string text = fmt::format("Usage: {} [OPTION]...", command.name);
  if (!command.commands.empty()) return text + " COMMAND";
  for (const CommandOption& option : command.options) {
    if (!option.is_positional) continue;
    const std::string name = option.names.front() + (option.is_list ? "..." : "");
    text += option.is_required ? " " + name : " [" + name + "]";
  }
  return text;
}

std::string entries(const Command& command, bool positional) {
  std::string text;
  for (const CommandOption& option : command.options) {
    if (option.is_positional == positional) text += entry(spoken(option), option.what);
  }
  return text;
}

std::string help_of_kind(const std::string& kind, const Command& run) {
  return fmt::format(
      "frahm has no command \"{0}\": frahm run computes a study of any kind, also one with kind = "
      "\"{0}\".\n\n  frahm new {0} {0}.toml    writes such a study to start from, with comments\n  frahm "
      "check {0}.toml\n  frahm run {0}.toml\n\n{1}",
      kind, help_text(run));
}

bool is_kind(const std::string& word) {
  const std::vector<std::string> kinds = starter_kinds();
  return std::ranges::find(kinds, word) != kinds.end();
}

}  // namespace

std::string help_text(const Command& command) {
  std::string text = fmt::format("{}\n\n{}\n", usage(command), command.what);
  const std::string arguments = entries(command, true);
  if (!arguments.empty()) text += "\nArguments:\n" + arguments;
  text += "\nOptions:\n" + entries(command, false);
  if (!command.commands.empty()) text += "\nCommands:\n";
  for (const Command& each : command.commands) {
    // One line a command: the manual is made of these.
    text += fmt::format("  {:<{}}{}\n", each.last_word(), widest_name, each.what);
  }
  return text + command.foot + "\n";
}

std::string help_for(const Command& tree, const std::string& name) {
  if (name.empty()) return help_text(tree);
  const auto command = [&](const std::string& word) {
    return std::ranges::find(tree.commands, word, &Command::last_word);
  };
  if (const auto found = command(name); found != tree.commands.end()) return help_text(*found);
  if (is_kind(name)) return help_of_kind(name, *command("run"));
  throw StudyError(rules::wrong_option, "help: {}", unknown_command(tree, name));
}

std::string unknown_command(const Command& tree, const std::string& name) {
  if (is_kind(name))
    return fmt::format("unknown command \"{}\"; frahm run computes a study of any kind", name);
  std::vector<std::string> names = starter_kinds();
  for (const Command& each : tree.commands) names.push_back(each.last_word());
  return fmt::format("unknown command \"{}\"{}", name, suggestion(name, names));
}

}  // namespace frahm::studies
