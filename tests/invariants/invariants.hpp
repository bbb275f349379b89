#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/invariants/answers.hpp"

// What must hold of the answers to a network and to changed networks with the same motion.
namespace frahm::invariants {

// How sharply the answers are meant: an orbit that is grazing, or that all but does not attract, is hardly
// determined by the data.
enum class Standing { ok, neutral, grazing };

struct Violation {
  std::string invariant, figure;
  double found = 0.0, expected = 0.0, allowed = 0.0;
  Standing standing = Standing::ok;

  // The kind that a smaller network must show too.
  bool same_kind(const Violation& other) const {
    return invariant == other.invariant && standing == other.standing;
  }
};

// What happened to how many networks.
struct Tally {
  int networks = 0;
  std::map<std::string, int> statuses;  // of the networks themselves
  std::map<std::string, int> reasons;   // of refusals and failures
  std::map<std::string, int> compared;  // by invariant
  int without_error_bound = 0;          // of those that are ok
};

// All violations by the network, one for each invariant: that of the figure furthest off. `only`: of this
// invariant; empty: of all.
std::vector<Violation> violations_of(const Case& original, Tally* tally = nullptr,
                                     const std::string& only = "");

}  // namespace frahm::invariants
