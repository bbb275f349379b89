#include "studies/program/figure_mark.hpp"

#include <fmt/format.h>

#include "studies/provenance/fingerprint.hpp"

namespace frahm::studies {
namespace {

std::string mark_of(std::string_view figure, std::string_view extension) {
  const bool is_pdf = extension == ".pdf";
  const results::Text text("figure", figure);
  return fmt::format("\n{} a figure of frahm report, {}{}\n", is_pdf ? "%" : "<!--", identity_of({&text, 1}),
                     is_pdf ? "" : " -->");
}

}  // namespace

std::string with_figure_mark(std::string figure, std::string_view extension) {
  figure += mark_of(figure, extension);
  return figure;
}

bool has_figure_mark(std::string_view figure, std::string_view extension) {
  const std::size_t length = mark_of("", extension).size();
  if (figure.size() < length) return false;
  const std::string_view above = figure.substr(0, figure.size() - length);
  return figure.substr(above.size()) == mark_of(above, extension);
}

}  // namespace frahm::studies
