#pragma once

// What the program and its commands say of themselves, at the head and the foot of their help. Each command
// has at least two examples.
namespace frahm::studies::help {

inline constexpr const char* overview =
    "Periodic responses of vibrating systems with dry friction and inerters, over whole maps of parameters.";

inline constexpr const char* first_steps = R"(
A study file describes a system and the axes of a map. From there:
  frahm new sweep study.toml                  a study to start from, with comments
  frahm check study.toml                      check that it is right, and how long it will take
  frahm point study.toml --at r=0.9,f=0.1     the full report of one response
  frahm run study.toml                        the whole map, into study.h5; run again to resume
  frahm status study.h5                       what a file holds, or how much of its run is done
  frahm report study.h5                       its page: maps, curves and numbers to look at
Every command has its own help: frahm run --help. A word of a study or of its results: frahm explain WORD

Exit codes: 0 done, 1 internal error, 2 wrong usage or study, 3 some points failed or have no periodic
response, 4 stopped (run again to resume), 5 refused to mix results of different studies, 6 input or output
failed, 7 a tuning or fit did not converge, 8 self-check failed)";

inline constexpr const char* run_examples = R"(
Examples:
  frahm run rig_atlas.toml                    into rig_atlas.h5, on all processors
  frahm run rig_atlas.toml --set "K=8200 N/m" -o stiffer.h5
  frahm run rig_atlas.toml --time-budget 50m  stops in time; the same command resumes
  mpirun -np 16 frahm run rig_atlas.toml      on the ranks of an MPI job
  frahm run rig_atlas.toml --from rig_atlas.h5    after axes have grown: computes the new points only
  frahm run rig_decay_main.toml               one motion: a free decay, or a transient
  frahm run tune_classical.toml               a tuning: an optimum from each of its starts
  frahm run identify_rig_tmd.toml             an identification: a model from measurements
  sbatch --array=0-15 --wrap 'frahm run rig_atlas.toml --shard $SLURM_ARRAY_TASK_ID/16'
                                              then: frahm merge rig_atlas.h5)";

inline constexpr const char* check_examples = R"(
Examples:
  frahm check rig_atlas.toml --set "A=20 mm"
  frahm check rig_atlas.toml --max-array 201  tasks of an array, for the cluster's MaxArraySize
  frahm check rig_atlas.toml --simulate-ranks 1000 --threads 4)";

inline constexpr const char* point_examples = R"(
Examples (a bare number is in the unit that the study gives the parameter):
  frahm point den_hartog.toml --at r=0.9,f=0.1
  frahm point rig_atlas.toml --at "omega=250 rpm,I=6.36 kg" --history orbit.csv
  frahm point rig_atlas.toml --at omega=250 --json
  frahm point rig_atlas.toml --at omega=250 --gradient)";

inline constexpr const char* branch_examples = R"(
Examples:
  frahm branch den_hartog.toml --along r --at f=0.4 -o branch.csv
  frahm branch stops.toml --along r -o branch.h5    a result: frahm report, frahm export
  frahm branch stops.toml --along omega --from "10 Hz" --to "40 Hz"
  frahm branch stops.toml --along r --at r=3.2 --multiple 2    a subharmonic, from where it is stable)";

inline constexpr const char* merge_examples = R"(
Examples:
  frahm merge rig_atlas.h5                    all shard logs next to it
  frahm merge rig_atlas.h5 node1/rig_atlas.h5.*.frahm-log node2/rig_atlas.h5.*.frahm-log
  frahm merge rig_atlas.h5 --partial          what there is; the logs are kept)";

inline constexpr const char* export_examples = R"(
Examples:
  frahm export rig_atlas.h5                   into rig_atlas.csv, one row per point
  frahm export rig_atlas.h5 -o - | head
  frahm export curves.h5 --group resonance    the resonances the study asked for
  frahm export tuned.h5 --schedule            a tuning's schedule for a controller, in steps of 1 rpm
  frahm export tuned.h5 --sweep optimum.toml  a study of the response at its optimum; then frahm run it
  frahm export found.h5 --study model.toml    a study that contains the estimates of an identification
  frahm export rig_decay_main.toml --data decay.csv --rate "500 Hz" --noise "0.05 mm" --seed 7
                                              measurements as a sensor would take them, to try an experiment)";

inline constexpr const char* report_examples = R"(
Examples:
  frahm report rig_atlas.h5                   the page rig_atlas.html: opens in any browser, alone and offline
  frahm report rig_atlas.h5 -o for_client.html --quantities main_peak,tmd_peak,guide_regime
  frahm report tuned.h5 --figures figures     its figures for a paper: SVG, CSV, and PDF with rsvg-convert or
                                              inkscape)";

inline constexpr const char* status_examples = R"(
Examples:
  frahm status rig_atlas.h5                   axes, quantities, how it was made, the points that failed
  frahm status running.h5                     how much of a run in progress is done, from its logs)";

inline constexpr const char* verify_examples = R"(
Examples:
  frahm verify                                one line per case: worst deviation, limit, pass or FAIL
  frahm verify || echo "do not trust this machine"    its exit code is 8 if a case fails)";

inline constexpr const char* new_examples = R"(
Examples:
  frahm new sweep machine.toml                a map over two parameters; then: frahm check machine.toml
  frahm new tune -                            to standard output
  frahm new decay measured.toml && frahm export measured.toml --data measured.csv && frahm new identify
                                              an identification, and measurements to try it on)";

inline constexpr const char* explain_examples = R"(
Examples:
  frahm explain stiffness                     a key of a study, and its sections
  frahm explain spring                        a type of element: its force, its values, units and ranges
  frahm explain main_peak                     a quantity, for any mass or element
  frahm explain kN/mm                         a unit: what it measures, and its value in SI
  frahm explain grazing                       a status of a point
  frahm explain 7                             an exit code)";

inline constexpr const char* schema_examples = R"(
Examples:
  frahm schema >frahm.schema.json             then, as the first line of a study: #:schema frahm.schema.json
  frahm schema | jq .properties.element.items.properties.type.enum)";

inline constexpr const char* help_examples = R"(
Examples:
  frahm help run                              the same as frahm run --help
  frahm help tune                             a kind of study: how it is computed)";

inline constexpr const char* completion_examples = R"(
Examples:
  frahm completion bash >~/.local/share/bash-completion/completions/frahm
  frahm completion fish >~/.config/fish/completions/frahm.fish
  frahm completion zsh >~/.zfunc/_frahm       a folder of fpath)";

}  // namespace frahm::studies::help
