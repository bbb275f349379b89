#!/bin/bash
# A map or a tuning on MPI ranks, which share its tiles as they go and leave the finished file. For 4 ranks of 8
# threads each:
#
#   sbatch --ntasks=4 --cpus-per-task=8 mpi.sh study.toml map.h5
#
# What follows map.h5 is given to `frahm run` as it stands. `frahm status map.h5` shows how much of it is done. A
# rank that dies ends the job; submitted again, it goes on from what all ranks have kept, on as many ranks as you
# like.
# Options of sbatch on the command line win over the lines below.
#SBATCH --job-name=frahm
#SBATCH --ntasks=2
#SBATCH --cpus-per-task=1
#SBATCH --time=60
#SBATCH --output=frahm-%j.log
#SBATCH --open-mode=append
# 90 s before the time is up Slurm sends USR1 to this script (B: to nothing else), which then submits itself again.
#SBATCH --signal=B:USR1@90
# Slurm itself starts the job again when a node fails or a more urgent job takes it.
#SBATCH --requeue

if [ $# -lt 2 ]; then
  echo "usage: sbatch --ntasks=<ranks> --cpus-per-task=<threads> mpi.sh STUDY OUTPUT.h5 [options of frahm run]" >&2
  exit 2
fi
study=$1 output=$2
shift 2

# mpirun learns the nodes from Slurm. Not bound to one core, or all threads of a rank would share it.
mpirun --bind-to none -np "$SLURM_NTASKS" \
  frahm run "$study" -o "$output" --threads "${SLURM_CPUS_PER_TASK:-1}" --progress plain "$@" &
run=$!
# mpirun hands USR1 on to all ranks.
trap 'signalled=yes; kill -USR1 "$run" 2>/dev/null' USR1
# A signal ends `wait` too, while the ranks are still putting away what there is: then wait again.
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
      echo "stopped before the end; the job goes back into the queue"
      scontrol requeue "$SLURM_JOB_ID"
    else
      echo "stopped before the end for the hundredth time; not put into the queue again" >&2
    fi
    ;;
  3)  # finished, some points failed; the file lists them
    code=0
    ;;
esac
exit "$code"
