#include "studies/program/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace frahm::studies {
namespace {

bool is_folder(const CommandOption& option) {
  return option.value == "FOLDER";
}
// We know no values of what is not a file.
bool is_file(const CommandOption& option) {
  return option.is_positional || option.value == "FILE" || option.value == "RESULT";
}

// In single quotes of a shell.
std::string in_quotes(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'')
      safe += "'\\''";
    else
      safe += c;
  }
  return safe + "'";
}

std::vector<std::string> names_of_options(const Command& command) {
  std::vector<std::string> names;
  for (const CommandOption& option : command.options) {
    if (!option.is_positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

std::vector<std::string> names_of_commands(const Command& program) {
  std::vector<std::string> names;
  for (const Command& each : program.commands) names.push_back(each.last_word());
  return names;
}

// What an argument may be in bash: words, folders or files.
std::string bash_values(const CommandOption& option) {
  const auto words = choices_of(option);
  if (!words.empty()) return fmt::format("compgen -W '{}' -- \"$word\"", fmt::join(words, " "));
  if (is_folder(option)) return "compgen -d -- \"$word\"";
  return is_file(option) ? "compgen -f -- \"$word\"" : ":";
}

std::string bash_case(const Command& command) {
  std::string text = fmt::format("    {})\n      case $before in\n", command.last_word());
  std::string positional = "compgen -f -- \"$word\"";
  for (const CommandOption& option : command.options) {
    if (option.is_positional && !choices_of(option).empty()) positional = bash_values(option);
    if (option.is_positional || option.value.empty()) continue;
    text += fmt::format("        {}) _frahm_offer \"$({})\"; return ;;\n", fmt::join(option.names, "|"),
                        bash_values(option));
  }
  return text + fmt::format(
                    "      esac\n"
                    "      case $word in\n"
                    "        -*) _frahm_offer \"$(compgen -W '{}' -- \"$word\")\" ;;\n"
                    "        *) _frahm_offer \"$({})\" ;;\n"
                    "      esac ;;\n",
                    fmt::join(names_of_options(command), " "), positional);
}

std::string bash(const Command& program) {
  std::string text =
      "# Completion of frahm for bash, made by: frahm completion bash\n"
      "_frahm_offer() {\n"
      "  local IFS=$'\\n'\n"
      "  COMPREPLY=($1)\n"
      "}\n"
      "_frahm() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n";
  std::vector<std::string> first = names_of_commands(program);
  for (const std::string& name : names_of_options(program)) first.push_back(name);
  text += fmt::format("    _frahm_offer \"$(compgen -W '{}' -- \"$word\")\"\n    return\n  fi\n",
                      fmt::join(first, " "));
  text += "  case ${COMP_WORDS[1]} in\n";
  for (const Command& each : program.commands) text += bash_case(each);
  return text + "  esac\n}\ncomplete -o filenames -F _frahm frahm\n";
}

// Text within an option's specification of zsh: these characters would end it.
std::string zsh_safe(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string zsh_values(const CommandOption& option) {
  const auto words = choices_of(option);
  if (!words.empty()) return fmt::format("({})", fmt::join(words, " "));
  if (is_folder(option)) return "_files -/";
  return is_file(option) ? "_files" : " ";
}

std::string zsh_options(const Command& command) {
  std::string text;
  for (const CommandOption& option : command.options) {
    if (option.is_positional) {
      text += " " + in_quotes(fmt::format("{}:{}:{}", option.is_list ? "*" : "",
                                          zsh_safe(option.names.front()), zsh_values(option)));
      continue;
    }
    for (const std::string& name : option.names) {
      std::string form = fmt::format("{}[{}]", name, zsh_safe(option.what));
      if (!option.value.empty()) form += fmt::format(":{}:{}", zsh_safe(option.value), zsh_values(option));
      text += " " + in_quotes(form);
    }
  }
  return text;
}

std::string zsh(const Command& program) {
  std::string text =
      "#compdef frahm\n"
      "# Completion of frahm for zsh, made by: frahm completion zsh\n"
      "_frahm() {\n"
      "  local curcontext=\"$curcontext\" state line\n";
  text += fmt::format("  _arguments -C{} '1: :->command' '*:: :->arguments'\n", zsh_options(program));
  text += "  case $state in\n    command)\n      local -a commands=(";
  for (const Command& each : program.commands)
    text += " " + in_quotes(fmt::format("{}:{}", each.last_word(), zsh_safe(each.what)));
  text += " )\n      _describe command commands ;;\n    arguments)\n      case $line[1] in\n";
  for (const Command& each : program.commands)
    text += fmt::format("        {}) _arguments{} ;;\n", each.last_word(), zsh_options(each));
  return text + "      esac ;;\n  esac\n}\n_frahm \"$@\"\n";
}

std::string fish_option(const std::string& condition, const CommandOption& option) {
  std::string text = fmt::format("complete -c frahm -n {}", in_quotes(condition));
  for (const std::string& name : option.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  const auto words = choices_of(option);
  if (!words.empty())
    text += fmt::format(" -x -a {}", in_quotes(fmt::format("{}", fmt::join(words, " "))));
  else if (is_folder(option))
    text += " -x -a '(__fish_complete_directories)'";
  else if (is_file(option))
    text += " -r -F";
  else if (!option.value.empty())
    text += " -x";
  return text + fmt::format(" -d {}\n", in_quotes(option.what));
}

std::string fish(const Command& program) {
  std::string text = "# Completion of frahm for fish, made by: frahm completion fish\n";
  const std::string none = "__fish_use_subcommand";
  for (const Command& each : program.commands) {
    text +=
        fmt::format("complete -c frahm -f -n {} -a {} -d {}\n", none, each.last_word(), in_quotes(each.what));
  }
  for (const CommandOption& option : program.options) text += fish_option(none, option);
  for (const Command& each : program.commands) {
    const std::string condition = "__fish_seen_subcommand_from " + each.last_word();
    for (const CommandOption& option : each.options) {
      if (!option.is_positional) {
        text += fish_option(condition, option);
      } else if (const auto words = choices_of(option); !words.empty()) {
        text += fmt::format("complete -c frahm -f -n {} -a {}\n", in_quotes(condition),
                            in_quotes(fmt::format("{}", fmt::join(words, " "))));
      }
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> choices_of(const CommandOption& option) {
  std::vector<std::string> choices;
  if (option.value.find('|') == std::string::npos) return choices;
  for (std::size_t start = 0; start <= option.value.size();) {
    const std::size_t end = std::min(option.value.find('|', start), option.value.size());
    choices.push_back(option.value.substr(start, end - start));
    start = end + 1;
  }
  return choices;
}

std::string completion_script(const Command& program, const std::string& shell) {
  return shell == "bash" ? bash(program) : shell == "zsh" ? zsh(program) : fish(program);
}

}  // namespace frahm::studies
