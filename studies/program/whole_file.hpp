#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace frahm::studies {

// What a file that is there already must be to be replaced: anything of ours that its caller has checked; a
// table with our columns, though there may be more or fewer of them; a page of a result; a figure for papers
// that nobody has changed (program/figure_mark.hpp); the very same text, of what is written to be changed by
// hand. Any file may be if it is empty.
enum class Replaces { anything, own_table, own_page, own_figure, own_text };

// Writes a file whole or not at all: under another name next to it, then renamed (results::PartFile). One
// process at a time writes to a path. A device or a pipe at the path is written to directly. Throws
// engine::IoError, also for a file that is not to be replaced; engine::Locked, results::StoreError.
void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write,
                      Replaces replaces = Replaces::anything);
void write_whole_file(const std::filesystem::path& path, std::string_view text,
                      Replaces replaces = Replaces::anything);

// Throws engine::IoError if a file that was made, of whatever name, could not be written to a path: a folder,
// link or device is there, or a file that is not to be replaced.
void require_place(const std::filesystem::path& path, const std::filesystem::path& made, Replaces replaces);

// Throws engine::IoError if there is a file that is not empty and holds another text.
void refuse_other_text(const std::filesystem::path& there, std::string_view text);

// Throws engine::IoError if an output would replace the file it is made from or another that this process has
// read, or if its folder does not exist; StudyError if it has the name of a study or a result. extension:
// that of such outputs.
void check_output_is_not_input(const std::filesystem::path& output, const std::filesystem::path& input,
                               std::string_view extension = ".csv");

}  // namespace frahm::studies
