#include "studies/tuning/tuning_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "studies/provenance/provenance.hpp"
#include "studies/tuning/tuning_about.hpp"

namespace frahm::studies {
namespace {

using Columns = std::vector<results::Column>;

// By what numbers in one unit are multiplied to be in another, as the record itself converts them: each
// number of an example, the same in SI, is written in both.
class Factors {
 public:
  void add(const Columns& kept, const Columns& now) {
    for (std::size_t i = 0; i < kept.size(); ++i)
      for (std::size_t k = 0; k < std::min(kept[i].values.size(), now[i].values.size()); ++k) {
        const double factor = now[i].values[k] / kept[i].values[k];
        if (!std::isfinite(factor) || factor <= 0.0) continue;  // nothing, or 0 in any unit
        factors_.emplace(std::pair(kept[i].variable.unit, now[i].variable.unit), factor);
      }
  }
  double of(const results::Variable& kept, const results::Variable& now) const {
    if (kept.unit == now.unit) return 1.0;
    const auto found = factors_.find({kept.unit, now.unit});
    if (found == factors_.end())
      throw std::logic_error(fmt::format("{}: no factor converts {} to {}", kept.name, kept.unit, now.unit));
    return found->second;
  }

 private:
  std::map<std::pair<std::string, std::string>, double> factors_;
};

bool is_of(const ColumnChoice& column, const std::string& name) {
  return name == column.name || name == column.name + "_range_lower" || name == column.name + "_range_upper";
}

// The column of the study that a variable is, or is a limit of; null for any other.
const ColumnChoice* column_of(const Study& study, const std::string& name) {
  for (const ColumnChoice& column : study.tune()->columns)
    if (is_of(column, name)) return &column;
  return nullptr;
}

// The columns of the study are left out: an expression is written as it is, in whatever unit.
Columns without_columns_of(const Study& study, Columns all) {
  std::erase_if(all, [&](const results::Column& each) { return column_of(study, each.variable.name); });
  return all;
}

class TuningWords {
 public:
  TuningWords(const Study& kept, const Study& now) {
    const TuningResult kept_example = example_of(kept), example = example_of(now);
    add(optimum_group, kept, now, optimum_columns(kept, kept_example), optimum_columns(now, example));
    add(front_group, kept, now, front_columns(kept, kept_example), front_columns(now, example));
  }

  std::optional<results::Words> operator()(const std::string& group,
                                           const results::Variable& variable) const {
    const auto found = words_.find({group, variable.name});
    return found == words_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  void add(const std::string& group, const Study& kept_study, const Study& study, const Columns& kept,
           const Columns& now) {
    if (kept.size() != now.size())
      throw std::logic_error("two tunings with the same fingerprint have different records");
    Factors factors;
    factors.add(without_columns_of(kept_study, kept), without_columns_of(study, now));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const results::Variable &before = kept[i].variable, &after = now[i].variable;
      const ColumnChoice *column_before = column_of(kept_study, before.name),
                         *column = column_of(study, after.name);
      const double factor =
          column_before && column ? column_before->si_factor / column->si_factor : factors.of(before, after);
      if (before.unit == after.unit && before.long_name == after.long_name && factor == 1.0) continue;
      words_[{group, before.name}] = {.unit = after.unit, .long_name = after.long_name, .factor = factor};
    }
  }

  std::map<std::pair<std::string, std::string>, results::Words> words_;
};

}  // namespace

results::Rewording words_of_tuning(const StudyPlan& plan, const Study& kept) {
  results::Rewording words{
      .title = file_layout(plan, {}).title, .texts = {}, .words_of = TuningWords(kept, plan.study)};
  // Such as the names of records: of an example, as all that comes of the work itself is the same in both.
  std::vector<results::Text> texts = optimum_texts(plan.study, example_of(plan.study));
  const std::vector<results::Text> before = optimum_texts(kept, example_of(kept));
  std::erase_if(texts,
                [&](const results::Text& each) { return std::ranges::find(before, each) != before.end(); });
  if (!texts.empty()) words.texts.emplace_back(optimum_group, std::move(texts));
  return words;
}

}  // namespace frahm::studies
