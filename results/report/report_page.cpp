#include "results/report/report_page.hpp"

#include <stdexcept>

#include "results/report/page_parts.hpp"

namespace frahm::results {
namespace {

// Text between tags.
std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) {
    if (c == '&') {
      html += "&amp;";
    } else if (c == '<') {
      html += "&lt;";
    } else {
      html += c;
    }
  }
  return html;
}

void require_parts() {
  if (!has_report_page()) throw std::logic_error("the page's parts were not built in");
}

}  // namespace

bool has_report_page() {
  return !page_after_data.empty();
}

std::string report_page(const std::string& title, const std::string& data) {
  require_parts();
  std::string page(page_before_title);
  page += escaped(title);
  page += page_before_data;
  page += data;
  page += page_after_data;
  return page;
}

std::string figure_script() {
  require_parts();
  return std::string(figures_script);
}

}  // namespace frahm::results
