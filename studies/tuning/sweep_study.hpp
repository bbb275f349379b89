#pragma once

#include <string>
#include <utility>
#include <vector>

#include "studies/tuning/stored_tuning.hpp"

namespace frahm::studies {

// A study of kind "sweep" that maps the response at the optimum over the band, where the tuning sampled it:
// its text, and the tables of its schedules (name of the file, CSV), which belong next to it.
struct SweepStudy {
  std::string text;
  std::vector<std::pair<std::string, std::string>> tables;
};

// The first line of each such study.
inline constexpr const char* sweep_mark =
    "# Made by frahm export from a tuning: the response at its optimum.";

// stem: of the names of the tables. Throws StudyError for a tuning without a band.
SweepStudy sweep_study(const StoredTuning& stored, const std::string& stem);

// A study of kind "transient" that runs up through the band at the optimum, from rest, through the jump of a
// schedule too: the scheduled elements follow the frequency.
inline constexpr const char* run_up_mark = "# Made by frahm export from a tuning: a run-up at its optimum.";

// Throws StudyError for a tuning whose band is not one of the excitation's frequency itself.
SweepStudy run_up_study(const StoredTuning& stored, const std::string& stem);

}  // namespace frahm::studies
