#include "studies/reading/study/series_text.hpp"

#include <fmt/format.h>

namespace frahm::studies {
namespace {

constexpr double share_rounding = 1e-7;  // of a share that is the square root of a difference

std::string left_out_text(double share) {
  return share < share_rounding ? "nothing" : fmt::format("{:.2g} %", 100.0 * share);
}

}  // namespace

std::vector<std::string> series_texts(const StudyValues& values) {
  std::vector<std::string> texts;
  for (const PeriodSeries& series : values.series)
    texts.push_back(
        fmt::format("{}: Fourier series to order {}, {} of them not zero; {} of its root mean "
                    "square is left out{}",
                    series.what, series.orders, series.harmonics, left_out_text(series.left_out), series.note));
  return texts;
}

}  // namespace frahm::studies
