// random_invariants: draws networks and checks what must hold of their periodic responses.
//
//   random_invariants [--first K] [--count N] [--seed K] [--study] [--shrink] [--only INVARIANT] [--seconds
//   T]
//
// --seed replays one network; --study prints it, or each that violates; --shrink makes those small first.
// Exit code 1 where an answer with status ok violates an invariant.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <cstring>

#include "tests/invariants/changes.hpp"
#include "tests/invariants/shrinking.hpp"
#include "tests/invariants/study_text.hpp"

namespace frahm::invariants {
namespace {

struct Options {
  std::uint64_t first = 1, count = 1000;
  bool study = false, shrink = false, replay = false;
  double seconds = 1e9;  // no new network after so long [s]
  std::string only;      // this invariant; empty: all
};

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string key = argv[i];
    const auto value = [&] { return i + 1 < argc ? argv[++i] : "0"; };
    if (key == "--first") {
      options.first = std::strtoull(value(), nullptr, 10);
    } else if (key == "--count") {
      options.count = std::strtoull(value(), nullptr, 10);
    } else if (key == "--seed") {
      options.first = std::strtoull(value(), nullptr, 10);
      options.count = 1;
      options.replay = true;
    } else if (key == "--seconds") {
      options.seconds = std::strtod(value(), nullptr);
    } else if (key == "--only") {
      options.only = value();
    } else if (key == "--study") {
      options.study = true;
    } else if (key == "--shrink") {
      options.shrink = true;
    } else {
      fmt::print(stderr, "unknown option {}\n", key);
      std::exit(2);
    }
  }
  return options;
}

std::string in_short(const Case& c) {
  std::string orders;
  for (const auto& excitation : c.network.excitations) orders += fmt::format("{} ", excitation.order);
  int contacts = 0;
  for (const auto& element : c.network.elements) contacts += element.type == mechanics::ElementType::coulomb;
  return fmt::format("{} masses, {} elements, {} contacts, orders {}omega {}", c.network.masses.size(),
                     c.network.elements.size(), contacts, orders, c.values.omega);
}

const char* name_of(Standing standing) {
  if (standing == Standing::ok) return "";
  return standing == Standing::grazing ? " (grazing)" : " (neutral)";
}

// The network and the changed one that answers otherwise.
void print_studies(const Case& small, const Violation& v) {
  fmt::print("{}\n", study_text(small, fmt::format("seed {}: {}", small.seed, v.invariant)));
  for (const Change& change : changes_of(small)) {
    if (change.name != v.invariant) continue;
    fmt::print("# changed\n{}\n",
               study_text(change.changed, fmt::format("seed {}: {}, changed", small.seed, v.invariant)));
  }
}

void show(const Case& violating, const Violation& v, const Options& options) {
  fmt::print("seed {}{} | {} | {} = {:.12g}, expected {:.12g}, off by {:.2g}, allowed {:.2g} | {}\n",
             violating.seed, name_of(v.standing), v.invariant, v.figure, v.found, v.expected,
             std::abs(v.found - v.expected), v.allowed, in_short(violating));
  if (!options.shrink) return;
  const Case small = shrunk(violating, v);
  fmt::print("  shrunk: {}\n", in_short(small));
  if (options.study) print_studies(small, v);
}

void print_counts(const char* heading, const std::map<std::string, int>& counts) {
  fmt::print("{}\n", heading);
  for (const auto& [name, number] : counts) fmt::print("  {:6} {}\n", number, name);
}

int check(const Options& options) {
  Tally tally;
  const auto start = std::chrono::steady_clock::now();
  std::map<Standing, std::map<std::string, int>> found;
  for (std::uint64_t seed = options.first; seed < options.first + options.count; ++seed) {
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > options.seconds)
      break;
    const Case drawn = draw(seed);
    if (options.replay && options.study && !options.shrink)
      fmt::print("{}", study_text(drawn, fmt::format("seed {}", seed)));
    for (const Violation& violation : violations_of(drawn, &tally, options.only)) {
      if (!options.only.empty() && violation.invariant != options.only) continue;
      ++found[violation.standing][violation.invariant];
      show(drawn, violation, options);
    }
  }
  fmt::print("\n{} networks\n", tally.networks);
  print_counts("by status", tally.statuses);
  print_counts("refused or failed, by reason", tally.reasons);
  fmt::print("  {:6} ok without an error bound\n", tally.without_error_bound);
  print_counts("violations at status ok", found[Standing::ok]);
  print_counts("violations at status ok, Floquet radius 1", found[Standing::neutral]);
  print_counts("violations where an answer is grazing", found[Standing::grazing]);
  return found[Standing::ok].empty() ? 0 : 1;
}

}  // namespace
}  // namespace frahm::invariants

int main(int argc, char** argv) {
  setvbuf(stdout, nullptr, _IOLBF, 4096);
  return frahm::invariants::check(frahm::invariants::options_of(argc, argv));
}
