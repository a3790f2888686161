#!/usr/bin/env bash
# Usage: run.sh BUILD [SAMPLES]: the table of bench_materials, every kernel compiled anew.
set -eu
cache=$(mktemp -d)
trap 'rm -rf "$cache"' EXIT
MESA_SHADER_CACHE_DISABLE=true XDG_CACHE_HOME=$cache "$1/tests/bench/materials/bench_materials" "${2:-64}"
