#!/usr/bin/env bash
# Loading time and peak memory for 10^4 to 10^7 triangles, beside assimp's for the same file. Prints a Markdown
# table; fails where the peak is above three times the file's geometry.
#   tests/bench/loading/loading.sh [BUILD] [TRIANGLES...]
# Each figure is the median of RUNS (default 3) fresh processes, with the file in the page cache. Memory is what
# loading adds to the process.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
build=${1:-build}
shift || true
counts=("$@")
[ ${#counts[@]} -gt 0 ] || counts=(10000 100000 1000000 10000000)
runs=${RUNS:-3}
cmake --build "$build" --target bench_loading >/dev/null
program=$build/tests/bench/loading/bench_loading
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
median() { sort -g | sed -n "$(((runs + 1) / 2))p"; }
measure() {  # measure LOADER FILE: triangles seconds MiB geometry-MiB
    for ((run = 0; run < runs; ++run)); do "$program" "$1" "$2"; done >"$scratch/runs"
    for column in 1 2 3 4; do cut -d ' ' -f $column "$scratch/runs" | median; done | paste -sd ' '
}
status=0
echo "| file | triangles | file, MiB | geometry, MiB | s | peak, MiB | peak / geometry | assimp, s | assimp, MiB |"
echo "|---|---|---|---|---|---|---|---|---|"
for kind in glb ply stl obj; do
    for count in "${counts[@]}"; do
        file=$scratch/mesh.$kind
        "$program" write $kind "$count" "$file"
        size=$(stat -c %s "$file")
        read -r triangles seconds peak geometry < <(measure heliograph "$file")
        read -r _ other_seconds other_peak _ < <(measure assimp "$file" || echo "0 - - 0")
        awk -v kind=$kind -v n="$triangles" -v size="$size" -v g="$geometry" -v s="$seconds" -v p="$peak" \
            -v os="$other_seconds" -v op="$other_peak" 'BEGIN {
                printf "| %s | %d | %.1f | %.1f | %.3f | %.1f | %.2f | %s | %s |\n", kind, n, size / 1048576, g, s, p, p / g, os, op
                # The constant covers threads and buffers, which small files do not hide.
                exit !(p <= 3 * g + 32) }' || status=1
        rm -f "$file"
    done
done
[ $status -eq 0 ] || echo "FAILED: a peak is above three times the geometry"
exit $status
