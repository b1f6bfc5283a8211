#!/bin/bash
#SBATCH --array=1-200
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=2
#SBATCH --time=02:00:00
#SBATCH --requeue
# A shard of the lives of a mechanism for each job of the array; after the last one:
#   linkwear merge lives/* --out life
# A job that was killed, or is queued again, goes on from where it was.
set -euo pipefail

mechanism=${MECHANISM:-mechanisms/rssr.toml}
shard=$(printf %06d "$SLURM_ARRAY_TASK_ID")

exec "${LINKWEAR:-linkwear}" life "$mechanism" --trajectories "${TRAJECTORIES:-1000000}" --seed "${SEED:-1}" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --out "${OUT:-lives}/$shard" --resume \
    --threads "${SLURM_CPUS_PER_TASK:-1}"
