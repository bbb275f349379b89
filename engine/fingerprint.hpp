#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace frahm::engine {

// What a result depends on, as two hashes made by the caller (hex text, 1 to 64 characters each).
struct Fingerprint {
  std::string physics;  // inputs, solver version, precision
  std::string grid;     // which points, and how they are cut into tiles

  friend bool operator==(const Fingerprint&, const Fingerprint&) = default;
};

// The study a log belongs to.
struct LogHeader {
  Fingerprint fingerprint;
  std::uint64_t tiles = 0;  // of the whole study, numbered from 0

  friend bool operator==(const LogHeader&, const LogHeader&) = default;
};

// Tiles of another study are kept beside the output, or its result stands there; they are neither mixed with
// this one's nor discarded unasked.
class ResumeRefused : public std::runtime_error {
 public:
  ResumeRefused(const std::filesystem::path& log, const LogHeader& kept, const LogHeader& wanted);
  // Of a finished result.
  ResumeRefused(const std::filesystem::path& result, const Fingerprint& kept, const Fingerprint& wanted,
                std::string advice = "");
  // The same refusal with advice for whoever meets it.
  ResumeRefused(const ResumeRefused& refused, std::string advice);

  const std::filesystem::path& log() const { return log_; }
  const LogHeader& kept() const { return kept_; }      // in the log
  const LogHeader& wanted() const { return wanted_; }  // of the run that was refused
  // What to do about it; empty: no more than is plain from what().
  const std::string& advice() const { return advice_; }
  // false: the same physics on another grid, so that points could be reused by content.
  bool physics_differs() const { return kept_.fingerprint.physics != wanted_.fingerprint.physics; }

 private:
  std::filesystem::path log_;
  LogHeader kept_;
  LogHeader wanted_;
  std::string advice_;
};

}  // namespace frahm::engine
