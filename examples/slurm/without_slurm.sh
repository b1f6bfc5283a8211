#!/bin/bash
# What Slurm does with lives.sh, one job after the other on this machine: the merged life has the bytes of the undivided one.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${LINKWEAR:-target/release/linkwear}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

export LINKWEAR=$program MECHANISM=mechanisms/rssr.toml TRAJECTORIES=300 SEED=7 OUT=$scratch/lives SLURM_CPUS_PER_TASK=1
export SLURM_ARRAY_TASK_COUNT=3
# In any order; one of them is run again, as after a requeue.
for SLURM_ARRAY_TASK_ID in 3 1 2 1; do
    SLURM_ARRAY_TASK_ID=$SLURM_ARRAY_TASK_ID bash examples/slurm/lives.sh > "$scratch/said.txt"
done
"$program" merge "$OUT"/* --out "$scratch/merged" > "$scratch/said.txt"
"$program" life "$MECHANISM" --trajectories "$TRAJECTORIES" --seed "$SEED" --out "$scratch/undivided" > "$scratch/said.txt"
for file in life.json lives.csv cycles.csv; do
    cmp "$scratch/merged/$file" "$scratch/undivided/$file"
done
echo "3 jobs merged: the bytes of the undivided life"
