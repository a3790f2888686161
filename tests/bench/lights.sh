#!/bin/sh
# Error at equal time of the choices among lights on sample:lights500. Usage: lights.sh BUILD
# Renders a reference (adaptive, another seed), then each choice for TIME seconds, RUNS times interleaved; prints the
# relMSE and its product with the CPU seconds of rendering: efficiency is inverse to that.
set -eu
program=$1/samples/heliograph/heliograph
runs=${RUNS:-3} seconds=${TIME:-8} size=${SIZE:-128x128} scene=${SCENE:-sample:lights500}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$program" render "$scene" --size "$size" --spp "${REFERENCE:-4096}" --seed 77 --quiet -o "$folder/reference.exr"
number() { sed -n "s/.*\"$2\": \([-+0-9.e]*\).*/\1/p" "$1" | head -1; }
for run in $(seq "$runs"); do
    for lights in adaptive power uniform; do
        "$program" render "$scene" --size "$size" --spp 65536 --time "$seconds" --seed "$run" --lights $lights --quiet \
            -o "$folder/image.exr" --stats "$folder/stats.json"
        "$program" compare "$folder/image.exr" "$folder/reference.exr" --json > "$folder/difference.json"
        cpu=$(number "$folder/stats.json" render_cpu_seconds)
        error=$(number "$folder/difference.json" relmse)
        echo "$lights $(number "$folder/stats.json" spp) samples, $cpu CPU s, relMSE $error," \
            "product $(echo "$cpu $error" | awk '{print $1 * $2}')"
    done
done
