#pragma once

// How often a fuzzer's inputs were read, and how often refused with a message. Any other end is a finding: an
// exception that the program would call an internal error ends the fuzzer.
namespace frahm::fuzz {

enum class Outcome { read, refused };

// Counts it; the counts are printed when the process exits: `outcomes: 12 read, 30 refused`.
void count(Outcome outcome);

}  // namespace frahm::fuzz
