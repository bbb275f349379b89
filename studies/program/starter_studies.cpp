#include "studies/program/starter_studies.hpp"

#include <algorithm>

namespace frahm::studies {
namespace {

// One machine in all of them: on a mount, in a guide with friction, with an absorber where it is tuned.
constexpr std::string_view machine = R"(
[[mass]]
name = "machine"
mass = "M"

[[element]]
name = "mount"
type = "spring"                           # also: damper, inerter, coulomb, maxwell, jenkins, gap ...
between = ["ground", "machine"]
stiffness = "k"

[[element]]
name = "mount_damper"
type = "damper"
between = ["ground", "machine"]
damping = 250                             # N s/m: a bare number is SI

[[element]]
name = "guide"
type = "coulomb"                          # dry friction; without static_force it sticks up to this force
between = ["ground", "machine"]
force = "F"
)";

constexpr std::string_view absorber = R"(
[[mass]]
name = "absorber"
mass = "m"

[[element]]
name = "absorber_spring"
type = "spring"
between = ["machine", "absorber"]
stiffness = "k_a"

[[element]]
name = "absorber_damper"
type = "damper"
between = ["machine", "absorber"]
damping = "c_a"
)";

constexpr std::string_view drive = R"(
[excitation]
frequency = "speed"

[[excitation.force]]                      # amplitude cos(order omega t + phase); also: [[excitation.motion]]
on = "machine"
amplitude = 100                           # N
)";

struct Starter {
  std::string_view kind;
  std::string_view head;  // title and parameters
  bool has_absorber, is_driven;
  std::string_view tail;  // what the kind asks for
};

constexpr Starter starters[] = {
    {"sweep",
     R"(# A map: every point of a grid of parameters, solved. Next: frahm check, frahm run, frahm report.

[study]
schema = 1
kind   = "sweep"
title  = "A machine in a guide with friction"
units  = "SI"                             # or "dimensionless"

[parameters]                              # numbers that elements, axes and expressions use
speed = { value = 600, unit = "rpm" }
M     = { value = 80, unit = "kg" }
k     = { value = 320, unit = "kN/m" }
F     = { value = 40, unit = "N" }
)",
     false, true, R"(
[[axis]]                                  # the outermost axis first
parameter = "F"
values = [0, 20, 40, 80]

[[axis]]
parameter = "speed"
unit = "rpm"
from = 300
to = 1200
points = 181

[output]
quantities = "standard"                   # or "all", or names: ["machine_peak", "guide_regime"]
)"},
    {"decay", R"(# Free vibration: from initial values until the machine rests. Next: frahm run, frahm report.

[study]
schema = 1
kind   = "decay"
title  = "A machine comes to rest in a guide with friction"
units  = "SI"

[parameters]
M = { value = 80, unit = "kg" }
k = { value = 320, unit = "kN/m" }
F = { value = 40, unit = "N" }
)",
     false, false, R"(
[decay]
samples = 501                             # of the history; without `duration` until it rests

[[initial]]
node = "machine"
displacement = { value = 5, unit = "mm" }
)"},
    {"transient", R"(# Forced motion from rest: a run-up through the resonance. Next: frahm run, frahm report.

[study]
schema = 1
kind   = "transient"
title  = "A machine with a rotating unbalance runs up"
units  = "SI"

[parameters]
speed = { value = 300, unit = "rpm" }     # runs from here to sweep_to
M     = { value = 80, unit = "kg" }
k     = { value = 320, unit = "kN/m" }
F     = { value = 40, unit = "N" }
)",
     false, true, R"(
[transient]
sweep_to   = { value = 1200, unit = "rpm" }
sweep_rate = { value = 100, unit = "rpm/s" }   # without both: constant speed for `duration`
samples    = 2001
)"},
    {"tune",
     R"(# An optimum: the absorber for which the machine's worst peak in a band is least. Next: frahm run, frahm report.

[study]
schema = 1
kind   = "tune"
title  = "An absorber for a machine in a guide with friction"
units  = "SI"

[parameters]
speed = { value = 600, unit = "rpm" }
M     = { value = 80, unit = "kg" }
k     = { value = 320, unit = "kN/m" }
F     = { value = 10, unit = "N" }
m     = { value = 6, unit = "kg" }
k_a   = { value = 22, unit = "kN/m" }     # the values here are where the search starts
c_a   = { value = 60, unit = "N s/m" }
)",
     true, true, R"(
[tune]
objective = "minimax"                     # the least worst value in the band
quantity  = "machine_peak"
band      = { parameter = "speed", from = 300, to = 1200, unit = "rpm" }

[[design]]                                # what may change, and its bounds
parameter = "k_a"
lower = 5
upper = 50
unit = "kN/m"

[[design]]
parameter = "c_a"
lower = 1
upper = 500
)"},
    {"identify",
     R"(# A model from measurements: stiffness and friction from a free decay. Next: frahm run, frahm report.
# Measurements to try it on: frahm new decay && frahm export decay.toml --data measured.csv --noise 0.5%

[study]
schema = 1
kind   = "identify"
title  = "The guide's friction, from a free decay"
units  = "SI"

[parameters]
M  = { value = 80, unit = "kg" }
k  = { value = 300, unit = "kN/m" }       # a guess, from which the fit starts
F  = { value = 30, unit = "N" }
x0 = { value = 5, unit = "mm" }
)",
     false, false, R"(
[[initial]]                               # at the first row of each record
node = "machine"
displacement = "x0"

[identify]
method = "grey_box"                       # or a formula: half_power, log_decrement, free_decay ...

[[identify.record]]
file = "measured.csv"                     # columns: time [s], machine_displacement [m]

[[identify.parameter]]
parameter = "k"
lower = 100
upper = 1000
unit = "kN/m"

[[identify.parameter]]
parameter = "F"
lower = 0
upper = 200

[[identify.parameter]]
parameter = "x0"
lower = 1
upper = 10
unit = "mm"
)"}};

}  // namespace

std::vector<std::string> starter_kinds() {
  std::vector<std::string> kinds;
  for (const Starter& each : starters) kinds.emplace_back(each.kind);
  return kinds;
}

std::string starter_study(std::string_view kind) {
  const auto* const found = std::ranges::find(starters, kind, &Starter::kind);
  if (found == std::end(starters)) return "";
  std::string text(found->head);
  text += machine;
  if (found->has_absorber) text += absorber;
  if (found->is_driven) text += drive;
  text += found->tail;
  return text;
}

}  // namespace frahm::studies
