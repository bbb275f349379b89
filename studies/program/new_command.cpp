#include "studies/program/new_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "engine/io_error.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/starter_studies.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

int new_command(const NewOptions& options, std::ostream& out) {
  const std::string text = starter_study(options.kind);
  if (text.empty())
    throw StudyError(rules::wrong_option, "new: there is no kind of study \"{}\"{}", options.kind,
                     suggestion(options.kind, starter_kinds()));
  if (options.file == "-") {
    out << text;
    return exit_code::done;
  }
  const std::filesystem::path file =
      options.file.empty() ? std::filesystem::path(options.kind + ".toml") : options.file;
  if (file.extension() == ".h5")
    throw StudyError(rules::wrong_file, "{}: has the name of a result; name this study .toml", file.string());
  if (std::filesystem::exists(std::filesystem::symlink_status(file)))
    throw engine::IoError(file, "exists already and is not replaced; name another file");
  write_whole_file(file, text);
  fmt::print(out, "{}\nnext: frahm check {}\n", file.string(), file.string());
  return exit_code::done;
}

}  // namespace frahm::studies
