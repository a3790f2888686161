#!/usr/bin/env bash
# Builds everything and runs every test through CTest: first the Release build with a Vulkan device, then the
# host tests under AddressSanitizer and UndefinedBehaviorSanitizer. A missing Vulkan device is a failure.
#   tests/run.sh [ctest arguments]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
fail() { printf 'heliograph: error: %s\n' "$*" >&2; exit 1; }

cmake/install-packages.sh build test
jobs=$(nproc)
build() {  # build FOLDER cmake-arguments...
    local folder=$1; shift
    cmake -S . -B "$folder" -G Ninja --log-level=WARNING -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 -DHELIOGRAPH_TESTS=ON "$@" >/dev/null ||
        fail "CMake could not configure $folder; its messages are above"
    cmake --build "$folder" --parallel "$jobs" || fail "the build in $folder failed; the messages are above"
}

echo "== Release build"
build build -DCMAKE_BUILD_TYPE=Release -DHELIOGRAPH_WERROR=ON
echo "== Sanitizer build of the host tests"
build build-sanitize -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS=-O1 -DCMAKE_CXX_FLAGS_DEBUG=-g1 -DHELIOGRAPH_SANITIZE=address,undefined -DHELIOGRAPH_SAMPLES=OFF -DHELIOGRAPH_HOST_TESTS_ONLY=ON

status=0
export ASAN_OPTIONS=detect_leaks=1:${ASAN_OPTIONS:-} UBSAN_OPTIONS=print_stacktrace=1
echo "== Host tests under AddressSanitizer and UndefinedBehaviorSanitizer"
ctest --test-dir build-sanitize --output-on-failure --no-tests=error --parallel "$jobs" "$@" || status=1
echo "== All tests, Release"
ctest --test-dir build --output-on-failure --no-tests=error --parallel "$jobs" "$@" || status=1

# The last lines: what was left out for want of third-party assets, and the count of test cases.
logs=(build*/Testing/Temporary/LastTest.log)
skipped=$(sed -n 's/^\[  SKIPPED \] \([^ ]*\) (.*/\1/p' "${logs[@]}" | sort)
if [ -n "$skipped" ]; then
    printf 'Left out, since ../shared/assets is not there: %s\n' "$(sort -u <<<"$skipped" | paste -sd ' ')"
fi
count() { grep -cE "$1" < <(cat "${logs[@]}") || true; }
printf 'cases: %d passed, %d failed, %d skipped\n' "$(count '^\[       OK \] ')" \
    "$(($(count '^\[  FAILED  \] .* \(') + status))" "$(grep -c . <<<"$skipped" || true)"
exit $status
