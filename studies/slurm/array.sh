#!/bin/bash
# A map or a tuning as an array of tasks, each of which computes one shard of it. For 16 tasks:
#
#   job=$(sbatch --parsable --array=0-15 array.sh 16 study.toml map.h5)
#   sbatch --dependency=afterok:$job merge.sh map.h5
#
# `frahm check study.toml` tells how many tasks are worth it, `frahm status map.h5` how far they are and which are
# missing; those alone are submitted again with the same 16:  sbatch --array=3,7 array.sh 16 study.toml map.h5
# What follows map.h5 is given to `frahm run` as it stands, for example --set K=8200.
#
# Nothing is lost by a kill: each finished tile is on the disk, and a task that starts again goes on from there.
# Options of sbatch on the command line win over the lines below.
#SBATCH --job-name=frahm
#SBATCH --cpus-per-task=1
#SBATCH --time=60
#SBATCH --output=frahm-%A_%a.log
#SBATCH --open-mode=append
# 90 s before the time is up Slurm sends USR1 to this script (B: to nothing else), which then submits itself again.
#SBATCH --signal=B:USR1@90
# Slurm itself starts the task again when its node fails or a more urgent job takes it.
#SBATCH --requeue

if [ $# -lt 3 ]; then
  echo "usage: sbatch --array=0-<n-1> array.sh n STUDY OUTPUT.h5 [options of frahm run]" >&2
  exit 2
fi
shards=$1 study=$2 output=$3
shift 3

# In the background, as bash would not look at a signal before a program in the foreground has ended.
frahm run "$study" -o "$output" --shard "$SLURM_ARRAY_TASK_ID/$shards" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" --progress plain "$@" &
run=$!
trap 'signalled=yes; kill -USR1 "$run" 2>/dev/null' USR1
# A signal ends `wait` too, while frahm is still putting away what there is: then wait again.
signalled=yes
while [ "$signalled" ]; do
  signalled=
  wait "$run"
  code=$?
done

case $code in
  4)  # stopped, everything kept
    # A hundred times in vain is a mistake, such as a time limit shorter than a single tile.
    if [ "${SLURM_RESTART_COUNT:-0}" -lt 100 ]; then
      echo "stopped before the end; task $SLURM_ARRAY_TASK_ID goes back into the queue"
      scontrol requeue "$SLURM_JOB_ID"
    else
      echo "stopped before the end for the hundredth time; not put into the queue again" >&2
    fi
    ;;
  3)  # finished, some points failed; the merged file lists them, and afterok should not wait for ever
    code=0
    ;;
esac
exit "$code"
