#pragma once

#include <string>
#include <vector>

#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/tuning/tuning_result.hpp"

// The record of a tuning in a result file: group /optimum, and /optimum/front along a trade-off
// (results/FORMAT.md).
namespace frahm::studies {

inline constexpr const char* optimum_group = "optimum";
inline constexpr const char* front_group = "optimum/front";

std::vector<results::Column> optimum_columns(const Study& study, const TuningResult& result);
std::vector<results::Column> front_columns(const Study& study, const TuningResult& result);
std::vector<results::Text> optimum_texts(const Study& study, const TuningResult& result);

// Throws StudyError if a name chosen in the study is already another name in the record.
void check_names_in_file(const Study& study);

// The limits of a tuning with that of the trade-off after them: names in the record, units.
struct NamedLimit {
  std::string name;  // of the quantity; with _2, _3 where it has several limits
  UsualUnit unit;
  double lower = 0.0, upper = 0.0;  // SI; infinite: none
};
std::vector<NamedLimit> named_limits(const Study& study, double trade_off);

// Unit of the quantity that is tuned, and of the objective: its square of a mean square or a variance.
std::string quantity_unit(const Study& study);
std::string objective_unit(const Study& study);

// What the worst of several responses does not prove, as a sentence without its full stop; "" where there is
// one response at each frequency.
std::string not_proved(const Study& study);

// The white noise of a variance: "a force on main", "the acceleration of base".
std::string noise_words(const Study& study);

}  // namespace frahm::studies
