#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace frahm::engine {

// Two hashes, made by the caller, of all that a result depends on (hex text, 1 to 64 characters each).
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

// Tiles or a result of another study are already at the output. They are neither mixed with those of this
// study nor deleted unasked.
class ResumeRefused : public std::runtime_error {
 public:
  ResumeRefused(const std::filesystem::path& log, const LogHeader& kept, const LogHeader& wanted);
  // For a finished result.
  ResumeRefused(const std::filesystem::path& result, const Fingerprint& kept, const Fingerprint& wanted,
                std::string advice = "");
  // The same refusal with advice for the user.
  ResumeRefused(const ResumeRefused& refused, std::string advice);

  const std::filesystem::path& log() const { return log_; }
  const LogHeader& kept() const { return kept_; }      // in the log
  const LogHeader& wanted() const { return wanted_; }  // of the run that was refused
  // Advice for the user; empty: what() says enough.
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
