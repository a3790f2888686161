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
    if [ -n "$pattern" ] && ! grep -qE -- "$pattern" out.txt err.txt; then
        miss "$name: nothing matches '$pattern': $(cat out.txt err.txt | head -c 300)"; return
    fi
    if [ "$code" -eq 1 ] || [ "$code" -eq 2 ]; then
        if [ "$(grep -c '^heliograph: error: ' err.txt)" -ne 1 ]; then miss "$name: not one error line: $(head -c 300 err.txt)"; return; fi
    fi
    pass
}
check() { local name=$1; shift; if "$@"; then pass; else miss "$name"; fi; }
# bash -c with a redirection that fails: the program's messages are lost, its work is not.
shell() { bash -c "\"$program\" $1"; }
# Every channel of two images has the same values.
same() { oiiotool --fail 0 --hardfail 0 --diff "$1" "$2" >/dev/null 2>&1; }
# interrupt_at PATTERN command...: sends SIGINT once standard error holds the pattern; leaves the exit code.
interrupt_at() {
    local pattern=$1; shift
    : >err.txt  # what an earlier command left there is no sign
    "$@" >out.txt 2>err.txt &
    local child=$!
    for ((tick = 0; tick < 3000; ++tick)); do
        grep -q "$pattern" err.txt && break
        kill -0 $child 2>/dev/null || break
        sleep 0.01
    done
    kill -INT $child 2>/dev/null
    wait $child
}
# listens PID: whether the process catches SIGINT. Starts no process itself: it must be quick.
listens() {
    local key value
    while read -r key value; do
        if [ "$key" = SigCgt: ]; then [[ $value == *[2367abef] ]]; return; fi
    done </proc/$1/status
} 2>/dev/null
render() { "$program" render sample:cornell --size 64x48 --spp 4 --quiet "$@"; }

expect 'help' 0 'render' "$program" --help
expect 'version' 0 '^[0-9]+\.[0-9]+\.[0-9]+$' "$program" --version
expect 'no command' 2 'see heliograph --help' "$program"
expect 'unknown command' 2 "there is no command 'paint'; there are render" "$program" paint
expect 'unknown options, the first is named' 2 'error: --threads is not known here' "$program" render sample:cornell --threads 2 --denoise
expect 'unknown option before any command' 2 'error: --fast is not known here' "$program" --fast
expect 'unknown option is refused' 2 'denoise' "$program" render sample:cornell --denoise
expect 'unknown choice is refused' 2 'not one of' "$program" render sample:cornell --sampler dice
expect 'ao refuses an environment' 2 'environment: has no effect' "$program" render sample:cornell --integrator ao --environment 1,1,1
expect 'hemisphere refuses a choice of lights' 2 'lights: is there for integrators' "$program" render sample:cornell --integrator hemisphere --lights power
expect 'radiosity refuses a depth' 2 'max-depth: is there for' "$program" render sample:cornell --integrator radiosity --max-depth 2
expect 'patches without radiosity' 2 'patches: is there for' "$program" render sample:cornell --patches 99
expect 'radiosity of what is not diffuse' 1 'not Lambertian' "$program" render sample:plates --size 8x8 --integrator radiosity
expect 'radiosity compares its two solutions' 0 'from the dense solution' "$program" render sample:cornell --size 16x16 --spp 1 --integrator radiosity --patches 64
echo '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"extensionsUsed":["KHR_lights_punctual"],
    "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":4}]}},
    "nodes":[{"name":"cell","extras":{"heliograph":{"meter":{"quantity":"irradiance"}}}},
    {"translation":[0,0,-2],"extensions":{"KHR_lights_punctual":{"light":0}}}]}' >meter.gltf
expect 'a meter is read' 0 'meter    cell: irradiance 1 1 1 W/m\^2 .*, 683 lx' "$program" render meter.gltf --size 8x8 --spp 4 --stats meter.json
check 'its reading is in the statistics' grep -q '"quantity": "irradiance"' meter.json
expect 'whitted refuses --no-nee' 2 'no-nee: leaves' "$program" render sample:cornell --integrator whitted --no-nee
expect 'a size of lights without pcss is refused' 2 'light-size: is there for' "$program" render sample:cornell --pipeline raster --light-size 1
expect 'a checkpoint in no folder is refused before rendering' 1 'no-such-folder' "$program" render sample:cornell --checkpoint no-such-folder/x
expect 'a tone curve without an image to show' 2 'tonemap: has no effect' "$program" render sample:cornell --tonemap aces -o a.exr
expect 'an unknown tone curve' 2 'none, reinhard, filmic, aces' "$program" render sample:cornell --tonemap acid -o a.png
expect 'bounces without an image that holds them' 2 'bounces: has no effect' "$program" render sample:cornell --bounces 1 -o a.png
expect 'bad size' 2 'not a size' "$program" render sample:cornell --size 10by10
expect 'zero size' 2 'outside' "$program" render sample:cornell --size 0x10
expect 'bad samples' 2 'spp' "$program" render sample:cornell --spp 0
expect 'too many samples' 2 '16777215' "$program" render sample:cornell --spp 16777216
expect 'a path render has no rates of shading' 2 'shading: is there for --pipeline raster only' "$program" render sample:cornell --shading flat
expect 'a path render culls nothing' 2 'raster only' render --cull back
for option in '--time 1' '--max-error 0.1' '--max-depth 2' '--filter tent' '--sampler sobol' --no-nee --adaptive --denoise '--error-map map.png' '--bounces 1'; do
    # shellcheck disable=SC2086
    expect "raster refuses $option" 2 "${option%% *}: is there for --pipeline path only" render --pipeline raster $option
done
expect 'frames are for mixing' 2 'frames: is there for --aa taa' "$program" render sample:cornell --pipeline raster --frames 4
expect 'a size that frames do not fill' 1 '33x32 pixels upscaled by 2' "$program" render sample:cornell --pipeline raster --aa taau2 --size 33x32
expect 'frames are mixed and upscaled' 0 'samples  5 per pixel, 16x16 pixels' "$program" render sample:cornell --pipeline raster --aa taau2 --frames 5 --frame-rate 30 --size 16x16
expect 'raster takes --spp and --seed' 0 'left out samples' "$program" render sample:cornell --size 16x16 --pipeline raster --spp 64 --seed 3
check 'raster says that its error is not measured' grep -q '^error    not measured' out.txt
expect 'bad environment' 2 'R,G,B' "$program" render sample:cornell --environment 1,2
render -o sky.exr
expect 'lat-long to cube' 0 'wrote cube.exr, 16x96; mean radiance' "$program" convert-environment sky.exr -o cube.exr --to cube
expect 'cube to ball' 0 'wrote ball.exr, 20x20' "$program" convert-environment cube.exr -o ball.exr --to sphere --size 20
expect 'a cube as environment' 0 '' "$program" render sample:materials --size 8x8 --spp 1 --environment cube.exr --environment-map cube
expect 'no cube' 1 'no six faces' "$program" convert-environment sky.exr -o x.exr --from cube --to latlong
expect 'no such mapping' 2 'cubic' "$program" convert-environment sky.exr -o x.exr --to cubic
expect 'mapping of no image' 2 'environment-map' "$program" render sample:cornell --environment 1,1,1 --environment-map cube
expect 'bake' 0 'wrote ao.png, 8x8 texels, 4 rays each; ambient occlusion' "$program" bake sample:carved --node floor -o ao.png --size 8 --spp 4
expect 'bake irradiance' 0 'wrote light.exr, 8x8 texels, 4 paths each; irradiance' "$program" bake sample:carved --node floor -o light.exr --size 8 --spp 4 --quantity irradiance
expect 'a lightmap' 0 '' "$program" render sample:carved --pipeline raster --lightmap floor=light.exr --size 32x18 -o lit.png --quiet
expect 'a lightmap of nothing' 1 "no node 'nobody'" "$program" render sample:carved --pipeline raster --lightmap nobody=light.exr --size 32x18 -o lit.png
expect 'a lightmap without its node' 2 'is not NODE=FILE' "$program" render sample:carved --pipeline raster --lightmap light.exr --size 32x18 -o lit.png
expect 'a lightmap for paths' 2 'for --pipeline raster only' "$program" render sample:carved --lightmap floor=light.exr --size 32x18 -o lit.png
expect 'irradiance in 8 bits' 2 'name an .exr file' "$program" bake sample:carved --node floor -o light.png --quantity irradiance
expect 'bake irradiance without coordinates' 1 'no texture coordinates 0' "$program" bake sample:cornell -o light.exr --quantity irradiance
expect 'ripmaps' 0 '' "$program" render sample:carved --pipeline raster --texture-filter ripmap --size 32x18 -o rip.png --quiet
expect 'bake without coordinates' 1 'no texture coordinates 0' "$program" bake sample:cornell -o ao.png
expect 'bake of nothing' 1 "no node 'nobody'" "$program" bake sample:cornell --node nobody -o ao.png
expect 'missing environment' 1 'nosky.exr' "$program" render sample:cornell --environment nosky.exr
expect 'missing file' 1 'nothere.gltf' "$program" render nothere.gltf
expect 'unknown sample' 1 'cornell' "$program" render sample:nothere
expect 'unknown file type' 1 'scene.xyz' "$program" render scene.xyz
echo 'not json' >bad.gltf
expect 'malformed file' 1 'bad.gltf' "$program" render bad.gltf
head -c 100 /dev/urandom >bad.glb
expect 'malformed binary' 1 'bad.glb' "$program" render bad.glb
expect 'control characters are not printed' 1 'a[?].2Jb' "$program" render $'a\e[2Jb.gltf'
check 'no escape character' test -z "$(tr -cd '\033' <err.txt)"
expect 'unknown image type' 2 'unknown image type' render -o a.tif
mkfifo pipe.png
expect 'an image is not written into a pipe' 1 'not a regular file' render -o pipe.png
mkdir readonly && chmod 555 readonly
drop=()  # root may write anywhere, unless it gives that up
[ "$(id -u)" -ne 0 ] || drop=(setpriv --bounding-set=-all --inh-caps=-all)
expect 'a folder that cannot be written to' 1 'the folder cannot be written' "${drop[@]}" "$program" render sample:cornell -o readonly/a.exr
expect 'a folder that cannot be written to, for statistics' 1 'the folder cannot be written' "${drop[@]}" "$program" render sample:cornell --stats readonly/a.json
expect 'missing folder' 1 'folder' render -o nofolder/a.exr
expect 'missing device' 1 'nosuchdevice' render --device nosuchdevice
expect 'missing device by environment' 1 'nosuchdevice' env HELIOGRAPH_DEVICE=nosuchdevice "$program" render sample:cornell --size 8x8
expect 'unknown camera' 1 'camera' render --camera nosuchcamera
cat >unnamed.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"camera": 0}, {"camera": 0}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]}
END
expect 'unnamed cameras' 1 "give an index from 0 to 1$" "$program" render unnamed.gltf --camera nosuchcamera
cp unnamed.gltf $'not\xffutf8.gltf'
expect 'info json of a name that is not UTF-8' 0 '"scene"' "$program" info --json $'not\xffutf8.gltf'
expect 'info' 0 'Vulkan' "$program" info
expect 'a device to measure, and nothing to measure' 2 'requires --measure' "$program" info --device 0
expect 'info json' 0 '"capabilities"' "$program" info --json
expect 'info scene' 0 'triangles' "$program" info sample:cornell
expect 'info of the materials' 0 'emission: 1' "$program" info sample:cornell
expect 'info of the images' 0 '"format": "8 bits"' "$program" info --json sample:terrain
expect 'info of what is left out' 0 '"skipped"' "$program" info --json sample:materials

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
expect 'compare decodes PNG against EXR' 0 'decoded from sRGB' "$program" compare path.png path.exr --fail-above nan=0
check 'only what is linear is decoded' test "$("$program" compare path.png path.png | head -n 1)" = 'mse 0'
oiiotool path.exr --ch R,G,B --clamp:min=0:max=1 -d float -o clamped.exr
expect 'a decoded PNG is its EXR, rounded' 0 '' "$program" compare path.png clamped.exr --fail-above worst=0.01
expect 'compare -o of an unknown type' 2 'unknown image type' "$program" compare path.exr path.exr -o d.tif
expect 'limits are read before images' 2 'no metric' "$program" compare nothere.exr nothere.exr --fail-above x=1
expect 'compare fails above' 1 'relmse' "$program" compare path.exr raster.exr --fail-above relmse=1e-9
expect 'compare unknown metric' 2 'no metric' "$program" compare path.exr path.exr --fail-above x=1

render -o second.exr
check 'second run is bit-identical in every channel' same path.exr second.exr
LP_NUM_THREADS=1 render -o one.exr
check 'one driver thread is bit-identical in every channel' same path.exr one.exr
oiiotool path.exr --addc 0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1e-3 -d float -o other.exr
check 'one changed channel is seen' test "$(same path.exr other.exr; echo $?)" -ne 0

# Streams that fail: the render is written all the same.
small='render sample:cornell --size 16x16 --spp 1'
expect 'full standard error' 0 '' shell "$small -o full.exr 2>/dev/full"
check 'full standard error: image' test -s full.exr
expect 'closed standard error' 0 '' shell "$small -o closed.exr 2>&-"
check 'closed standard error: image' same full.exr closed.exr
expect 'full standard output' 1 'standard output cannot be written' shell "$small -o full2.exr >/dev/full"
check 'full standard output: image' same full.exr full2.exr
expect 'closed standard output' 1 'standard output cannot be written' shell "$small -o closed2.exr >&-"
check 'closed standard output: image' same full.exr closed2.exr
expect 'closed standard output, nothing to say' 0 '' shell "$small --quiet -o closed3.exr >&-"
expect 'full standard output of info' 1 'standard output cannot be written' shell "info >/dev/full"
expect 'full standard output of help' 1 'standard output cannot be written' shell "--help >/dev/full"
"$program" $small -o broken.exr 2>err.txt | true
check 'broken pipe: no signal' test "${PIPESTATUS[0]}" -eq 1
check 'broken pipe: image' same full.exr broken.exr

# Statistics and graphs: into what is no file, through links, one failure does not stop the rest.
expect 'statistics to standard output, a pipe' 0 '^  "spp": 1,' shell "$small --quiet --stats /dev/stdout | cat"
expect 'statistics to standard output, a file' 0 '^  "spp": 1,' shell "$small --stats /dev/stdout"
check 'with the summary behind them' grep -q '^device ' out.txt
expect 'statistics to nowhere' 0 '' shell "$small --quiet --stats /dev/null"
check 'the device is still there' test -c /dev/null
expect 'statistics to a full device' 1 'No space left' shell "$small --quiet -o kept.exr --stats /dev/full"
check 'statistics to a full device: image' test -s kept.exr
mkdir folder && ln -s folder/real.json link.json && ln -s folder/real.exr link.exr
expect 'outputs through links' 0 '' shell "$small --quiet -o link.exr --stats link.json"
check 'links stay links' test -L link.json -a -L link.exr -a -s folder/real.json -a -s folder/real.exr
long=$(printf 'x%.0s' {1..260})
expect 'one of several outputs fails' 1 'too long' shell "$small -o $long.png -o after.png"
check 'the one after it is written' test -s after.png
check 'no temporary is left' test -z "$(find . -name '*.partial')"

for pipeline in path raster; do
    echo precious >before.exr; echo precious >before.json
    interrupt_at 'compiling kernels' "$program" render sample:cornell --size 64x48 --spp 1000000 --pipeline $pipeline -o before.exr --stats before.json
    check "$pipeline, Ctrl-C in set-up exits 130" test $? -eq 130
    check "$pipeline, Ctrl-C in set-up says so" grep -q 'interrupted before the first sample: nothing was written' err.txt
    check "$pipeline, Ctrl-C in set-up leaves the files" test "$(cat before.exr before.json | sort -u)" = precious
done

yes 'v 0.123456 0.5 0.25' | head -n 6000000 >large.obj
echo 'f 1 2 3' >>large.obj
for command in info render; do
    "$program" $command large.obj >out.txt 2>err.txt &
    child=$!
    # The moment the program listens: sooner the signal meets a shell's background job, which takes no notice of it;
    # later a fast machine has loaded the file.
    until [ /proc/$child/exe -ef "$program" ] && listens $child; do
        kill -0 $child 2>/dev/null || break
    done
    kill -INT $child 2>/dev/null
    wait $child
    check "Ctrl-C while $command loads exits 130" test $? -eq 130
    check "Ctrl-C while $command loads says so" grep -q interrupted err.txt
done
rm large.obj

"$program" render sample:cornell --size 64x48 --spp 1000000 --quiet -o cancelled.exr &
child=$!
sleep 3
kill -INT $child
wait $child
check 'Ctrl-C exits 130' test $? -eq 130
check 'Ctrl-C writes what is done' test -s cancelled.exr

# A warm process compiles nothing: no cache, the driver's or Heliograph's, gains or rewrites a file.
caches() { find warm -type f -printf '%P %s %T@\n' | sort; }
warm_render() { MESA_SHADER_CACHE_DIR=$PWD/warm/mesa XDG_CACHE_HOME=$PWD/warm/cache render -o warm.exr "$@"; }
mkdir -p warm
warm_render
caches >cold.txt
check 'a cold process fills the caches' test -s cold.txt
warm_render --seed 7
check 'a warm process compiles nothing' cmp -s cold.txt <(caches)

# The benchmark: what is not known is refused before any work; a run killed anywhere goes on and measures the rest.
bench() { "$program" bench irradiance/independent --quick --json bench.json "$@"; }
expect 'bench refuses what it does not measure' 1 "teapot: is nothing that is measured; name a group" "$program" bench teapot
expect 'bench refuses a folder that is not there' 1 'folder does not exist' "$program" bench furnace --json nowhere/x.json
expect 'bench says before any work what a page needs' 1 'install the package python3-matplotlib' env PATH=/nowhere "$program" bench furnace --json page.json --html page.html
check 'and has done none' test ! -e page.json
echo '{"what": "a shopping list"}' >list.json
expect 'bench keeps a file that is not its own' 1 'is no record of a benchmark' "$program" bench furnace --json list.json
check 'and leaves it as it is' grep -q shopping list.json
expect 'bench keeps its files apart' 1 'is the name of what comes beside the record' "$program" bench furnace --json x.csv
echo '{"what": "heliograph bench", "truths": {}, "settings": {}, "series": [{"group": "samplers"}]}' >half.json
expect 'bench refuses half a record' 1 'is no record of a benchmark' "$program" bench furnace --json half.json
bench --quiet &
child=$!
for ((tick = 0; tick < 6000; ++tick)); do grep -qs cpu_seconds bench.json && break; sleep 0.01; done
kill -9 $child 2>/dev/null
wait $child 2>/dev/null
cp bench.json first.json
check 'a killed bench has kept what it measured' grep -q cpu_seconds first.json
expect 'a killed bench goes on' 0 'irradiance +samplers +independent' bench
check 'all its points are there once' test "$(tail -n +2 bench.csv | cut -d, -f 1-5 | sort | uniq | wc -l) $(tail -n +2 bench.csv | wc -l)" = '14 14'
check 'and what was measured before the kill was kept' cmp -s <(grep cpu_seconds first.json) <(grep cpu_seconds bench.json | head -n "$(grep -c cpu_seconds first.json)")
before=$(cat bench.json)
expect 'a complete bench measures nothing' 0 'wrote bench.json' bench
check 'and changes nothing' test "$before" = "$(cat bench.json)"
expect 'and says whether theory is right' 0 'samples\^-[01.0-9]+ .* by theory -1.05 to -0.95: holds' bench
expect 'a record of other settings is refused' 1 'settings: the record is of' "$program" bench irradiance/independent --json bench.json
expect 'levels and rays are held to double precision' 0 'mips bytes/passes/mip: .* holds' "$program" bench bytes --quick --json sizes.json

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
