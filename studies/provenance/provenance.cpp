#include "studies/provenance/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "solvers/mechanics/bends.hpp"
#include "studies/provenance/build_facts.hpp"
#include "studies/provenance/files_read.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/provenance_checksum.hpp"

namespace frahm::studies {

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(now));  // a time_point would be in local time
}

results::MapLayout file_layout(const StudyPlan& plan, const RunFacts& run) {
  const Study& study = plan.study;
  results::MapLayout layout{.title = study.title,
                            .source = fmt::format("frahm {}", build_facts().version),
                            .history = fmt::format("{} {}", run.started, run.command)};
  if (layout.title.empty()) layout.title = std::filesystem::path(study.source.name).stem().string();
  return layout;
}

namespace {

constexpr const char *study_text = "study", *study_file_text = "study_file", *overrides_name = "overrides";

std::string file_name(const Study& study) {
  return std::filesystem::path(study.source.name).filename().string();
}

std::string search_text(const Study& study, const periodic::OrbitsWanted& wanted) {
  using enum periodic::OrbitsWanted::Show;
  if (wanted.is_slow_sweep())
    return fmt::format(
        "a sweep of the frequency {}, from rest at the first point of a row; at each point the stable "
        "response of the point before is continued, and where it ends the motion is followed to another, "
        "with multiples of the period up to {}. Other responses were not searched for",
        wanted.show == up ? "up" : "down", wanted.most_multiple);
  return fmt::format(
      "{} starts and the responses of the points before and after on the row, within a tile, multiples of "
      "the period up to {}; the response with the {} peak of {} is reported. Others may have been missed",
      wanted.starts, wanted.most_multiple, wanted.show == largest ? "largest" : "smallest",
      study.network.masses.front());
}

// What was searched where there may be several responses, "" where there is one alone.
std::string searched_orbits(const Study& study) {
  periodic::OrbitsWanted wanted = study.orbits_wanted();
  if (study.tune() && tuning::may_take_several_orbits(study.network))
    return fmt::format(
        "at each frequency: {} starts and the responses found near it, with multiples of the period up to "
        "{}; the worst counts, and where none is stable and periodic, the worst of the motions over 64 "
        "periods. Others may have been missed",
        wanted.starts, wanted.most_multiple);
  if (!study.sweep() || !mechanics::may_have_several_responses(study.network)) return "";
  std::string text = "where the laws are not monotone: " + search_text(study, wanted);
  const auto& comparison = study.sweep()->comparison;
  if (!comparison || !comparison->show) return text;
  wanted.show = *comparison->show;
  return text + ". Compared: " + search_text(study, wanted);
}

}  // namespace

std::string overrides_text(const std::vector<std::string>& set) {
  return fmt::format("{}", fmt::join(set, ", "));
}

std::vector<results::Text> provenance_in_words(std::vector<results::Text> texts, const StudyPlan& plan,
                                               const std::vector<results::Text>& changed) {
  const auto put = [&](const std::string& name, const std::string& text) {
    const auto found = std::ranges::find(texts, name, &results::Text::first);
    if (found != texts.end()) found->second = text;
  };
  put(study_text, plan.study.source.text);
  put(study_file_text, file_name(plan.study));
  put(overrides_name, overrides_text(plan.set));
  for (const auto& [name, text] : changed) put(name, text);
  put(checksum_text, checksum_of(texts));
  return texts;
}

std::vector<results::Text> provenance(const StudyPlan& plan, const RunFacts& run,
                                      const std::vector<std::string>& failed, std::uint64_t missing) {
  const BuildFacts facts = build_facts();
  std::vector<results::Text> texts{{study_text, plan.study.source.text},
                                   {study_file_text, file_name(plan.study)},
                                   {overrides_name, overrides_text(plan.set)},
                                   {"fingerprint_physics", plan.fingerprint.physics},
                                   {"fingerprint_grid", plan.fingerprint.grid},
                                   {"program", "frahm " + facts.version},
                                   {"commit", facts.commit},
                                   {"compiler", facts.compiler},
                                   {"flags", facts.flags},
                                   {"libraries", fmt::format("{}", fmt::join(facts.libraries, ", "))},
                                   {"threads", fmt::format("{}", run.threads)},
                                   {"ranks", fmt::format("{}", run.ranks)},
                                   {"started", run.started},
                                   {"finished", utc_now()}};
  if (const std::string files = files_read(plan.study); !files.empty())
    texts.emplace_back(files_read_text, files);
  if (const std::string searched = searched_orbits(plan.study); !searched.empty())
    texts.emplace_back("orbits_searched", searched);
  if (plan.grown_from) {
    texts.emplace_back("grown_from", plan.grown_from->file);
    texts.emplace_back(grown_from_identity, plan.grown_from->identity);
  }
  if (!plan.course.empty()) texts.emplace_back(branch_course_text, plan.course);
  if (missing > 0) texts.emplace_back(missing_tiles_text, fmt::format("{}", missing));
  if (!failed.empty()) texts.emplace_back("failed_points", fmt::format("{}", fmt::join(failed, "\n")));
  texts.emplace_back(checksum_text, checksum_of(texts));
  return texts;
}

}  // namespace frahm::studies
