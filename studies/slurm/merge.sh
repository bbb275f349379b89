#!/bin/bash
# Makes one file of the shards that the tasks of array.sh have left beside it, when all of them have ended well:
#
#   sbatch --dependency=afterok:<job id of the array> merge.sh map.h5
#
# Merging twice does no harm. With --partial behind map.h5 it makes a file of what there is; the rest is marked as not
# computed, and the shards are kept.
#SBATCH --job-name=frahm-merge
#SBATCH --cpus-per-task=1
#SBATCH --time=60
#SBATCH --output=frahm-merge-%j.log
#SBATCH --requeue

if [ $# -lt 1 ]; then
  echo "usage: sbatch --dependency=afterok:<job> merge.sh OUTPUT.h5 [--partial]" >&2
  exit 2
fi
frahm merge "$@"
code=$?
# Made, though some points failed, which the file lists.
[ "$code" -eq 3 ] && code=0
exit "$code"
