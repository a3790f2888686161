#!/usr/bin/env bash
# Checks the command line against the contract.
#   tests/cli/cli.sh BUILD
set -uo pipefail
program=$(cd "$1" && pwd)/samples/heliograph/heliograph
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
passed=0 failed=0

pass() { passed=$((passed + 1)); }
miss() { failed=$((failed + 1)); printf 'FAILED %s\n' "$*"; }
# expect NAME EXIT PATTERN command...: exit code, and a pattern standard error or output must hold.
expect() {
    local name=$1 code=$2 pattern=$3; shift 3
    "$@" >out.txt 2>err.txt
    local got=$?
    if [ "$got" -ne "$code" ]; then miss "$name: exit $got, not $code: $(head -c 300 err.txt)"; return; fi
    if [ -n "$pattern" ] && ! cat out.txt err.txt | grep -qE -- "$pattern"; then
        miss "$name: nothing matches '$pattern': $(cat out.txt err.txt | head -c 300)"; return
    fi
    if [ "$code" -eq 1 ] || [ "$code" -eq 2 ]; then
        if [ "$(grep -c '^heliograph: error: ' err.txt)" -ne 1 ]; then miss "$name: not one error line: $(head -c 300 err.txt)"; return; fi
    fi
    pass
}
check() { local name=$1; shift; if "$@"; then pass; else miss "$name"; fi; }
render() { "$program" render sample:cornell --size 64x48 --spp 4 --quiet "$@"; }

expect 'help' 0 'render' "$program" --help
expect 'version' 0 '^[0-9]+\.[0-9]+\.[0-9]+$' "$program" --version
expect 'no command' 2 'see heliograph --help' "$program"
expect 'unknown option is refused' 2 'denoise' "$program" render sample:cornell --denoise
expect 'unknown choice is refused' 2 'not one of' "$program" render sample:cornell --sampler halton
expect 'bad size' 2 'not a size' "$program" render sample:cornell --size 10by10
expect 'zero size' 2 'outside' "$program" render sample:cornell --size 0x10
expect 'bad samples' 2 'spp' "$program" render sample:cornell --spp 0
expect 'bad environment' 2 'R,G,B' "$program" render sample:cornell --environment sky.exr
expect 'missing file' 1 'nothere.gltf' "$program" render nothere.gltf
expect 'unknown sample' 1 'cornell' "$program" render sample:nothere
expect 'unknown file type' 1 'scene.xyz' "$program" render scene.xyz
echo 'not json' >bad.gltf
expect 'malformed file' 1 'bad.gltf' "$program" render bad.gltf
head -c 100 /dev/urandom >bad.glb
expect 'malformed binary' 1 'bad.glb' "$program" render bad.glb
expect 'unknown image type' 1 'unknown image type' render -o a.tif
expect 'missing folder' 1 'folder' render -o nofolder/a.exr
expect 'missing device' 1 'nosuchdevice' render --device nosuchdevice
expect 'missing device by environment' 1 'nosuchdevice' env HELIOGRAPH_DEVICE=nosuchdevice "$program" render sample:cornell --size 8x8
expect 'unknown camera' 1 'camera' render --camera nosuchcamera
expect 'info' 0 'Vulkan' "$program" info
expect 'info json' 0 '"capabilities"' "$program" info --json
expect 'info scene' 0 'triangles' "$program" info sample:cornell

for pipeline in path raster; do
    expect "$pipeline with validation" 0 '' render --pipeline $pipeline --validate -o $pipeline.exr -o $pipeline.png --stats $pipeline.json --graph $pipeline.dot
    for file in $pipeline.exr $pipeline.png $pipeline.json $pipeline.dot; do check "$file is written" test -s $file; done
done
for key in version device scene seed spp setup_seconds setup_cpu_seconds render_seconds render_cpu_seconds rays \
    camera bounce shadow error relmse low high reliable nan_count truncated_paths memory host_bytes device_bytes \
    passes features skipped; do
    check "statistics have $key" grep -q "\"$key\"" path.json
done
expect 'compare equal' 0 'rmse 0$' "$program" compare path.exr path.exr
expect 'compare json' 0 'mean_ratio' "$program" compare path.exr raster.exr --json -o difference.png
check 'difference is written' test -s difference.png
expect 'compare fails above' 1 'relmse' "$program" compare path.exr raster.exr --fail-above relmse=1e-9
expect 'compare unknown metric' 2 'no metric' "$program" compare path.exr path.exr --fail-above x=1

render -o second.exr
expect 'second run is bit-identical' 0 'worst 0 ' "$program" compare path.exr second.exr
LP_NUM_THREADS=1 render -o one.exr
expect 'one driver thread is bit-identical' 0 'worst 0 ' "$program" compare path.exr one.exr

"$program" render sample:cornell --size 64x48 --spp 1000000 --quiet -o cancelled.exr &
child=$!
sleep 3
kill -INT $child
wait $child
check 'Ctrl-C exits 130' test $? -eq 130
check 'Ctrl-C writes what is done' test -s cancelled.exr

finished=0
for delay in 1 2 3 4 5 6 8 10 100; do  # tenths of a second
    "$program" render sample:cornell --size 256x256 --spp 1 --quiet -o killed.exr &
    child=$!
    for ((tick = 0; tick < delay; ++tick)); do sleep 0.1; kill -0 $child 2>/dev/null || break; done
    kill -9 $child 2>/dev/null
    wait $child 2>/dev/null && finished=1
    if [ -e killed.exr ]; then expect "killed after $delay tenths of a second: whole file" 0 'nan 0' "$program" compare killed.exr killed.exr; else pass; fi
done

check 'one of the killed renders had time to finish' test $finished -eq 1

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
