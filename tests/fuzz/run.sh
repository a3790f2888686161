#!/usr/bin/env bash
# Builds the fuzz targets and runs each for some minutes under AddressSanitizer and UndefinedBehaviorSanitizer,
# as many at once as there are cores. Ends at the first crash, hang (10 s) or 1 GiB of memory, and keeps the
# input in the build folder.
#   tests/fuzz/run.sh [MINUTES] [TARGET...]      MINUTES may be a fraction; 30 without
#   FUZZ_BUILD=FOLDER (build-fuzz), FUZZ_JOBS=N (cores), FUZZ_SEED=N (0: another one each time),
#   FUZZ_OPTIMIZE=N (1; 0 is built in half the time and tries half as many inputs)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
fail() { printf 'heliograph: error: %s\n' "$*" >&2; exit 1; }
minutes=${1:-30}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(gltf glb obj mtl ply stl image)
build=${FUZZ_BUILD:-build-fuzz}
jobs=${FUZZ_JOBS:-$(nproc)}
seconds=$(awk -v m="$minutes" 'BEGIN { s = int(m * 60 + 0.5); if (s < 1) exit 1; print s }') ||
    fail "'$minutes' is no number of minutes"

cmake/install-packages.sh build test
cmake -S tests/fuzz -B "$build" -G Ninja --log-level=WARNING -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 -DFUZZ_OPTIMIZE="${FUZZ_OPTIMIZE:-1}" -DCMAKE_CXX_COMPILER=clang++-14 >/dev/null ||
    fail "CMake could not configure $build; its messages are above"
cmake --build "$build" --parallel "$jobs" || fail "the build in $build failed; the messages are above"
rm -rf "$build/seeds"
python3 tests/fuzz/seeds.py "$build/seeds"

run() {  # run TARGET
    local name=$1 folder=$build/corpus/$1
    mkdir -p "$folder" "$build/found"
    if "$build/fuzz_$name" "$folder" "$build/seeds/$name" -dict="$build/seeds/$name.dict" -seed="${FUZZ_SEED:-0}" \
        -max_total_time="$seconds" -max_len=16384 -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=512 \
        -artifact_prefix="$build/found/$name-" -print_final_stats=1 -print_funcs=0 >"$build/$name.log" 2>&1; then
        printf '%-6s clean, %s inputs in %s s\n' "$name" \
            "$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$name.log")" "$seconds"
    else
        printf '%-6s FAILED: %s\n' "$name" "$(grep -m 1 -E 'ERROR|runtime error|does not|names no|more than one' "$build/$name.log" || tail -n 1 "$build/$name.log")"
        printf '       the input is %s, the log %s\n' "$(sed -n 's/.*Test unit written to //p' "$build/$name.log" | tail -n 1)" "$build/$name.log"
        return 1
    fi
}
status=0
pids=()
for target in "${targets[@]}"; do
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || status=1; done
    run "$target" &
    pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid" || status=1; done
exit $status
