#!/usr/bin/env bash
# Start-up on an empty and on a warm shader cache: sample:cornell at 256x256, 1 and 64 samples per pixel.
# Prints a Markdown table of medians over RUNS (default 7) fresh processes.
#   tests/bench/startup.sh [BUILD]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-build}/samples/heliograph/heliograph
runs=${RUNS:-7}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export MESA_SHADER_CACHE_DIR="$scratch/mesa" XDG_CACHE_HOME="$scratch/cache"

field() { sed -n "s/.*\"$1\": *\([0-9.eE+-]*\).*/\1/p" "$scratch/stats.json" | head -n 1; }
median() { sort -g | sed -n "$(((runs + 1) / 2))p"; }
render() {  # render SPP: one process; appends wall, set-up and render seconds
    local start end
    start=$(date +%s%N)
    "$program" render sample:cornell --size 256x256 --spp "$1" -o "$scratch/out.png" --stats "$scratch/stats.json" --quiet
    end=$(date +%s%N)
    echo "$(((end - start) / 1000000))" >>"$scratch/wall"
    field setup_seconds >>"$scratch/setup"
    field render_seconds >>"$scratch/render"
}

echo "| shader cache | samples | process, s | set-up, s | rendering, s |"
echo "|---|---|---|---|---|"
for cache in empty warm; do
    for spp in 1 64; do
        rm -f "$scratch/wall" "$scratch/setup" "$scratch/render"
        [ "$cache" = empty ] || render "$spp"
        [ "$cache" = empty ] || rm -f "$scratch/wall" "$scratch/setup" "$scratch/render"
        for ((run = 0; run < runs; ++run)); do
            [ "$cache" = warm ] || rm -rf "$scratch/mesa" "$scratch/cache"
            render "$spp"
        done
        printf '| %s | %s | %s | %.3f | %.3f |\n' "$cache" "$spp" \
            "$(median <"$scratch/wall" | awk '{printf "%.3f", $1 / 1000}')" "$(median <"$scratch/setup")" "$(median <"$scratch/render")"
    done
done
