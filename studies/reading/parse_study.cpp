#include "studies/reading/parse_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "studies/reading/further_mistakes.hpp"
#include "studies/reading/keys/repetition.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/identify_check.hpp"
#include "studies/reading/kinds/identify_reading.hpp"
#include "studies/reading/kinds/motion_reading.hpp"
#include "studies/reading/kinds/tune_check.hpp"
#include "studies/reading/kinds/tune_over_records.hpp"
#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/map/axis_reading.hpp"
#include "studies/reading/map/comparison_reading.hpp"
#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/map/orbits_reading.hpp"
#include "studies/reading/map/output_reading.hpp"
#include "studies/reading/map/record_axis.hpp"
#include "studies/reading/study/dimension_check.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/system/characteristic_reading.hpp"
#include "studies/reading/system/direction_reading.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/system/signal_reading.hpp"
#include "studies/reading/system/unfit_elements.hpp"
#include "studies/reading/text/readable_file.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

constexpr std::string_view hdf5_signature = "\x89HDF\r\n";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // some editors begin a UTF-8 file with it

void check_top_keys(const StudySource& source, const TomlValue& root) {
  const std::vector<std::string> known = keys_of("");
  for (const TomlEntry& entry : *root.as<TomlTable>()) {
    if (std::ranges::find(known, entry.key) != known.end()) continue;
    throw source.error_at(rules::unknown_section, entry.position, "unknown section \"{}\"{}", entry.key,
                          suggestion(entry.key, known));
  }
}

// What to say of a section that this kind of study does without.
std::string why_without(StudyKind kind, const std::string& section) {
  const bool is_output = section == "output";
  const bool of_a_map = section == "axis" || section == "coordinate" || is_output || section == "orbits";
  const bool one_motion = kind == StudyKind::decay;
  if (kind == StudyKind::tune && is_output)
    return ": it records its optimum, with the numbers of [[column]]; use an [[output.signal]] for what lies "
           "between masses, and for other quantities the study of the optimum that frahm export --sweep "
           "writes";
  if (one_motion && is_output)
    return ": it computes one motion, not a map, and records all of it: give `samples` in [decay] for its "
           "history, an [[output.signal]] for what lies between masses";
  if (kind == StudyKind::tune && of_a_map)
    return ": the band of [tune] and the bounds of [[design]] are its ranges";
  if (one_motion && of_a_map) return ": it computes one motion, not a map";
  if (one_motion && section == "excitation")
    return ": a free vibration starts from [[initial]] values and is not driven";
  std::vector<std::string> owners;
  for (const std::string& each : separated(study_key("", section).owners.of))
    owners.push_back(fmt::format("\"{}\"", each));
  return "; it is for kind = " + listed(owners, " or ");
}

// Refuses sections of other kinds of study, which would have no effect here.
void check_sections_of_kind(const Study& study, const TomlValue& root) {
  for (const TomlEntry& entry : *root.as<TomlTable>()) {
    const std::string_view kind = kind_name(study.kind());
    const bool is_part = has(study_key("", entry.key), kind);
    const bool has_signals_alone = entry.key == "output" && !has(study_key("output", "quantities"), kind);
    if (is_part && has_signals_alone && entry.value.as<TomlTable>()) {
      check_output_has_signals_alone(study, entry, why_without(study.kind(), entry.key));
      continue;
    }
    if (is_part && !has_signals_alone) continue;
    throw study.source.error_at(rules::other_kind, entry.position, "the section \"{}\" is not part of {}{}",
                                entry.key, kind_noun(study.kind()), why_without(study.kind(), entry.key));
  }
}

// Refuses a study without a section that its kind needs.
void require_sections_of_kind(const Study& study, const TomlValue& root) {
  for (const StudyKey& section : study_keys()) {
    if (*section.section || !needs(section, kind_name(study.kind())) || is_given(section, root)) continue;
    throw study.source.error_at(rules::missing_section, root.position,
                                "the study has no {}: {} needs it ({})", written_section(section.key),
                                kind_noun(study.kind()), section.meaning);
  }
}

// The alternatives of Study::choice are in the order of StudyKind.
void set_kind(StudyKind kind, Study& study) {
  const auto set = [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((static_cast<StudyKind>(i) == kind ? void(study.choice.emplace<i>()) : void()), ...);
  };
  set(std::make_index_sequence<std::variant_size_v<decltype(study.choice)>>());
}

void read_heading(const TomlValue& root, Study& study) {
  const TomlEntry* heading = find_entry(root, "study");
  if (!heading)
    throw study.source.error_at(rules::missing_section, root.position,
                                "[study] with schema and kind is missing");
  const TomlSection section(study.source, heading->value, "[study]", "study");
  section.integer("schema");
  set_kind(section.choice_as<StudyKind>("kind"), study);
  study.title = section.text_or("title", "");
  if (study.title.find('\n') != std::string::npos)
    section.fail(rules::not_text, "title", "has more than one line; a title must be one line");
  study.dimensionless = section.choice("units") == "dimensionless";
}

// The parameters that the system reads, compared with another law too.
std::vector<std::size_t> read_by_matrices(const Study& study) {
  std::vector<std::size_t> reads = study.values.read_by_system(study.network);
  if (study.sweep()->comparison) {
    const std::vector<std::size_t>& of_slope = study.sweep()->comparison->slope.expression.reads();
    reads.insert(reads.end(), of_slope.begin(), of_slope.end());
  }
  return reads;
}

// A transient without axes is one motion, of whose [output] the signals alone have a meaning.
void check_motion_without_axes(const Study& study, const TomlValue& root) {
  const std::string why = ": without an [[axis]] it computes one motion, not a map";
  const std::string way =
      "; the whole motion is recorded; use an [[output.signal]] for what lies between masses, or an [[axis]] "
      "with one value for a map of one point";
  for (const TomlEntry& entry : *root.as<TomlTable>()) {
    if (entry.key == "output" && entry.value.as<TomlTable>())
      check_output_has_signals_alone(study, entry, why + way);
    if (entry.key == "coordinate" || entry.key == "report")
      throw study.source.error_at(rules::beyond_schema(rules::other_kind), entry.position,
                                  "the section \"{}\" is not part of {}{}", entry.key,
                                  kind_noun(study.kind()), why + (entry.key == "report" ? way : ""));
  }
}

// The axes of a transient and what is recorded along them.
void read_map_of_motions(const StudyContext& context, const TomlValue& root,
                         const std::filesystem::path& folder, DataFiles data, Study& study) {
  if (!find_entry(root, "axis")) return check_motion_without_axes(study, root);
  study.transient()->map.emplace();
  read_axes(context, root, folder, data, study);
  read_coordinates(context, root, study);
  read_motion_output(context, root, study);
  read_report(context, root, study);
}

void find_frequency_dimension(Study& study) {
  auto moving = dimensions_moving(study, study.values.omega.expression.reads());
  if (moving.empty()) return;
  // Samples lie in no order: a row goes along them only if it goes along nothing else.
  const auto& samples = study.map()->samples;
  if (samples && moving.size() > 1) std::erase(moving, samples->dimension);
  const auto matrices = dimensions_moving(study, read_by_matrices(study));
  const auto moves_matrices = [&](std::size_t d) {
    return std::find(matrices.begin(), matrices.end(), d) != matrices.end();
  };
  const auto still = std::find_if_not(moving.rbegin(), moving.rend(), moves_matrices);
  study.sweep()->frequency_dimension = still == moving.rend() ? moving.back() : *still;
}

// An identification by a formula needs no system.
bool has_system(const TomlValue& root) {
  return find_entry(root, "mass") || find_entry(root, "matrices") || find_entry(root, "element") ||
         find_entry(root, "damping") || find_entry(root, "excitation") || find_entry(root, "initial");
}

// Checks that every value is valid wherever the study goes.
void check_whole(Study& study) {
  set_directions(study);
  set_signals(study);
  set_characteristics(study);
  check_grid(study);
  set_crank_orders(study);
  if (study.tune()) check_tuning(study);
  if (study.identify()) check_identification(study);
}

// is_whole: nothing is left out of it (further_mistakes.hpp).
Study read_document(const StudySource& source, const TomlValue& root, const std::filesystem::path& folder,
                    DataFiles data, bool is_whole) {
  Study study;
  study.source = source;
  check_top_keys(study.source, root);
  read_heading(root, study);
  check_sections_of_kind(study, root);
  require_sections_of_kind(study, root);

  const UnitSystem units;
  std::vector<WrittenExpression> written;
  const StudyContext context{study.source, units, study.dimensionless, written, is_whole};
  study.parameters = read_parameters(context, root, folder);
  std::vector<DrivingRecord> driving;
  if (study.kind() != StudyKind::identify || has_system(root)) {
    auto [network, values, corners] = read_network(context, root, folder, study.parameters, study.kind());
    study.network = std::move(network);
    study.values = std::move(values);
    refuse_mixed_laws(study);
    driving = std::move(corners);
  }
  if (study.sweep()) read_comparison(context, root, study);
  if (study.motion() || study.identify()) read_motion(context, root, study);
  if (study.transient())
    study.transient()->records =
        read_driving_records(context, root, folder, data, study.network, std::move(driving),
                             read_record_axis(context, root), "an [[axis]]");
  if (study.kind() == StudyKind::identify) read_identification(context, root, study);
  convert_parameters(context, study.parameters);
  if (study.kind() == StudyKind::sweep) {
    read_axes(context, root, folder, data, study);
    read_coordinates(context, root, study);
    find_frequency_dimension(study);
    read_output(context, root, study);
    study.sweep()->orbits = read_orbits_wanted(context, root, study);
    check_compared_show(context, root, study);
    read_report(context, root, study);
  } else if (study.kind() == StudyKind::transient) {
    read_map_of_motions(context, root, folder, data, study);
  } else if (study.kind() == StudyKind::tune) {
    if (mechanics::has_records(study.network))
      read_tuning_over_records(context, root, folder, data, std::move(driving), study);
    else
      read_tuning(context, root, study);
  } else if (study.kind() == StudyKind::identify) {
    read_measurements(context, root, folder, data, study);
  }
  check_dimensions(context, study.parameters);
  if (is_whole) check_whole(study);
  return study;
}

}  // namespace

Study read_study(const std::filesystem::path& path) {
  std::string text = read_file(path, path.string(), FileKind::any);
  if (text.starts_with(hdf5_signature))
    throw StudyError(
        rules::wrong_file,
        "{}: is a result; name the study it was made from (frahm status, report and export take results)",
        path.string());
  return parse_study(std::move(text), path);
}

Study parse_study(std::string text, const std::filesystem::path& name, DataFiles data) {
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  const StudySource source{name.string(), std::move(text)};
  TomlValue root = with_repetitions(source, read_toml(source));
  try {
    return read_document(source, root, name.parent_path(), data, true);
  } catch (const StudyError& first) {
    throw with_further_mistakes(first, std::move(root), [&](const TomlValue& rest) {
      read_document(source, rest, name.parent_path(), DataFiles::leave, false);
    });
  }
}

Study with_parameters(Study study, std::span<const Assignment> assignments) {
  for (const Assignment& assignment : assignments) {
    study.parameters.list[assignment.parameter].definition = assignment.value;
  }
  check_whole(study);
  return study;
}

}  // namespace frahm::studies
