#!/usr/bin/env bash
# From a fresh clone to a picture: installs what is missing, builds Release into build/, renders the Cornell
# box with both pipelines.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
fail() { printf 'heliograph: error: %s\n' "$*" >&2; exit 1; }

cmake/install-packages.sh build
jobs=$(nproc)
echo "Configuring and building in build/ with $jobs jobs (a first build takes some minutes)"
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DHELIOGRAPH_TESTS=OFF --log-level=WARNING >/dev/null ||
    fail "CMake could not configure the build; its messages are above"
cmake --build build --parallel "$jobs" || fail "the build failed; the compiler's messages are above"

out=build/quickstart
mkdir -p "$out"
for pipeline in raster path; do
    echo
    echo "== Cornell box, $pipeline pipeline"
    build/samples/heliograph/heliograph render sample:cornell --pipeline "$pipeline" --size 512x512 \
        -o "$out/cornell-$pipeline.exr" -o "$out/cornell-$pipeline.png" --stats "$out/cornell-$pipeline.json" ||
        fail "rendering with the $pipeline pipeline failed; its message is above"
done
echo
echo "Look at $out/cornell-path.png and $out/cornell-raster.png."
