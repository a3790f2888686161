#!/usr/bin/env bash
# What --time does to the mean, which quick paths reach first: renders RUNS pictures (default 8) of each scene with
# each limit, and compares their means with that of 1024 samples. Usage: time_limit.sh [BUILD]
# Prints a Markdown table: samples per pixel on average, and mean / truth - 1 with its standard
# error over the runs. Which samples a limit allows depends on the machine: SCENES, TIMES (seconds) and SIZE choose.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-build}/samples/heliograph/heliograph
runs=${RUNS:-8} size=${SIZE:-192x192}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
field() { sed -n "s/.*\"$2\": *\([-0-9.eE+]*\).*/\1/p" "$1" | head -n 1; }

echo "| scene | seconds | samples | mean / truth - 1, % |"
echo "|---|---|---|---|"
for scene in ${SCENES:-glass cornell}; do
    "$program" render "sample:$scene" --size "$size" --spp 1024 --seed 4711 --quiet -o "$scratch/truth.exr"
    for time in ${TIMES:-0.05 0.4}; do
        rm -f "$scratch/rows"
        for ((run = 1; run <= runs; ++run)); do
            "$program" render "sample:$scene" --size "$size" --spp 65536 --time "$time" --seed "$run" --quiet \
                -o "$scratch/image.exr" --stats "$scratch/stats.json" 2>/dev/null
            "$program" compare "$scratch/image.exr" "$scratch/truth.exr" --json >"$scratch/difference.json"
            echo "$(field "$scratch/stats.json" spp) $(field "$scratch/difference.json" mean_ratio)" >>"$scratch/rows"
        done
        awk -v scene="$scene" -v time="$time" '
            { n++; spp += $1; x = 100 * ($2 - 1); sum += x; squares += x * x }
            END { mean = sum / n; error = sqrt((squares / n - mean * mean) / (n - 1))
                  printf "| %s | %s | %.1f | %+.2f ± %.2f |\n", scene, time, spp / n, mean, error }' "$scratch/rows"
    done
done
