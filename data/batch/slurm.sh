#!/bin/bash
# An array of jobs for Slurm, a row of the table each:
#     sbatch --array="$(meshwind study merge cases.csv -o cases --left)" slurm.sh cases.csv cases
# The same line again runs what failed or is missing; meshwind study merge cases.csv -o cases makes one table of all.
#SBATCH --job-name=meshwind
#SBATCH --cpus-per-task=1
#SBATCH --output=/dev/null
#SBATCH --requeue
exec "${MESHWIND:-meshwind}" --threads 1 --quiet study cases "$1" --row "$SLURM_ARRAY_TASK_ID" -o "$2"
