#!/usr/bin/env python3
"""Opens every malformed file with the program. Each must end in exit 1 with one line that names the file, the
fault and the remedy, or load: then both pipelines must render it with finite pixels and say in a warning, or in
what was left out, that something is wrong. With --turns (the test suite) every other file is rendered by one pipeline
alone, in turn. Memory stays within twice the file and 256 MiB, all told with info,
and with render beyond what it takes for a small good file (the device's compiler and kernels); 20 s is a hang.
Large good files are held to the same.
  tests/hostile/run.py BUILD [--keep FOLDER] [--only PART] [--list] [--turns]
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import good_files
import malformed

ALLOWANCE = 256 << 20
TIMEOUT = 20  # seconds of processor time
WALL = 300  # seconds for what waits, on a machine however busy
# Faults that have no place but the file.
WHOLE_FILE = ("is empty", "is no scene that can be read", "its JSON is no object", "is no regular file", "does not exist")

parser = argparse.ArgumentParser()
parser.add_argument("build")
parser.add_argument("--keep", help="leave the files in this folder")
parser.add_argument("--only", default="", help="cases whose name has this in it")
parser.add_argument("--list", action="store_true", help="print what becomes of each case")
parser.add_argument("--turns", action="store_true", help="every other file is rendered by one pipeline alone")
arguments = parser.parse_args()
program = str(pathlib.Path(arguments.build).resolve() / "samples/heliograph/heliograph")

Ended = collections.namedtuple("Ended", "code out err memory")


# Linux counts what a child had of its parent before it became another program, so a small parent measures.
MEASURE = ("import os, sys; child = os.spawnv(os.P_NOWAIT, sys.argv[1], sys.argv[1:]); _, status, usage = os.wait4(child, 0); "
           "print(usage.ru_maxrss); sys.exit(os.waitstatus_to_exitcode(status))")


def memory_of(folder, *command):
    """The peak of the program's resident set, for what must end well."""
    ended = subprocess.run([sys.executable, "-S", "-E", "-c", MEASURE, program, *command], cwd=folder, check=True,
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                           env=dict(os.environ, MESA_SHADER_CACHE_DISABLE="true"))  # kernels are compiled, as for a new scene
    return int(ended.stdout.split()[-1]) * 1024


def run(folder, *command):
    """Runs the program in a folder. The memory is the peak of its resident set, or of this script's if that is more."""
    out, err = folder / "out.txt", folder / "err.txt"
    with open(out, "wb") as out_file, open(err, "wb") as err_file:
        child = subprocess.Popen([program, *command], cwd=folder, stdin=subprocess.DEVNULL, stdout=out_file,
                                 stderr=err_file, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (TIMEOUT, TIMEOUT)))
        watch = threading.Timer(WALL, child.kill)
        watch.start()
        _, status, usage = os.wait4(child.pid, 0)
        watch.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
    return Ended(child.returncode, out.read_text(errors="replace"), err.read_text(errors="replace"),
                 usage.ru_maxrss * 1024)


def faults_of_refusal(ended, file):
    lines = [line for line in ended.err.splitlines() if not line.startswith("heliograph: loading ")]  # slow ones say so
    if len(lines) != 1:
        return ["%d lines on standard error: %s" % (len(lines), ended.err[:300])]
    start = "heliograph: error: "
    if not lines[0].startswith(start):
        return ["no error line: " + lines[0][:300]]
    rest = lines[0][len(start):]
    # A file that the scene's file names, an MTL file, may be the one at fault.
    name, _, rest = rest.partition(": ")
    faults = []
    if name not in (file, "scene.mtl"):
        faults.append("names no file: " + lines[0][:300])
    if ": " not in rest.split("; ")[0] and not any(part in rest for part in WHOLE_FILE):
        faults.append("names no place: " + lines[0][:300])
    if "; " not in rest:
        faults.append("names no remedy: " + lines[0][:300])
    return faults


def remarks(render):
    """What a render says of its scene."""
    return [line for line in (render.err + render.out).splitlines() if "warning: " in line or line.startswith("left out ")]


def check(case):
    """(name, 'refused' or 'rendered', the line, faults)."""
    name, files = case
    folder = work / name
    folder.mkdir(parents=True)
    size = 0
    for file, content in files.items():
        if callable(content):
            content = content()
        size += len(content) if isinstance(content, bytes) else 0
        if content is malformed.PIPE:
            os.mkfifo(folder / file)
        elif isinstance(content, malformed.Link):
            (folder / file).symlink_to(content)
        else:
            (folder / file).write_bytes(content)
    file = next(iter(files))
    content = None  # it may be large
    faults = []

    def hold(ended, command):
        beyond = ended.memory - base_memory[command] - 2 * size
        most_beyond[command] = max(most_beyond[command], (beyond >> 20, name))
        if beyond > ALLOWANCE:
            faults.append("%s takes %d MiB for %d bytes" % (command, ended.memory >> 20, size))

    info = run(folder, "info", file)
    hold(info, "info")
    if info.code == 1:
        return name, "refused", info.err.strip(), faults + faults_of_refusal(info, file)
    if info.code != 0:
        return name, "failed", info.err.strip(), faults + ["exit %d: %s" % (info.code, info.err[-300:])]
    said, refusal = [], None
    turn = zlib.crc32(name.encode()) % 4 if arguments.turns else 2
    pipelines = ("path", "raster") if turn >= 2 else (("path", "raster")[turn],)
    for pipeline in pipelines:
        render = run(folder, "render", file, "--size", "8x8", "--spp", "1", "--pipeline", pipeline, "-o", pipeline + ".exr",
                     "--stats", pipeline + ".json")
        hold(render, pipeline)
        if render.code == 1:  # found where the scene is prepared
            refusal = render.err.strip().splitlines()[-1]
            faults += faults_of_refusal(render._replace(err=refusal + "\n"), file)
            continue
        if render.code != 0:
            return name, "failed", render.err.strip(), faults + ["%s: exit %d: %s" % (pipeline, render.code, render.err[-300:])]
        statistics = json.loads((folder / (pipeline + ".json")).read_text())
        if statistics["nan_count"] != 0:
            faults.append("%s: %d samples are not finite" % (pipeline, statistics["nan_count"]))
        said += [line for line in remarks(render) if line not in usual[pathlib.Path(file).suffix]]
    if refusal is not None:
        return name, "refused", refusal, faults
    if not said and name not in malformed.GOOD:
        faults.append("renders without a word of what is wrong")
    if len(pipelines) < 2:
        return name, "rendered", said[0] if said else "", faults
    compare = run(folder, "compare", "path.exr", "raster.exr", "--json")
    difference = json.loads(compare.out)
    if difference["nan"] or difference["inf"]:
        faults.append("pixels that are not finite: %(nan)d NaN, %(inf)d infinite" % difference)
    return name, "rendered", said[0] if said else "", faults


work = pathlib.Path(arguments.keep or tempfile.mkdtemp(prefix="heliograph_hostile_")).resolve()
work.mkdir(parents=True, exist_ok=True)
(work / "secret").write_bytes(good_files.png())
try:
    document, data = good_files.gltf()
    good = {".gltf": good_files.gltf_text(document, data), ".glb": good_files.glb(document, data), ".obj": good_files.OBJ,
            ".ply": good_files.ply("ascii"), ".stl": good_files.stl_text()}
    (work / "good").mkdir()
    for name, content in (("scene.mtl", good_files.MTL), ("image.png", good_files.png())):
        (work / "good" / name).write_bytes(content)
    most_beyond = collections.defaultdict(lambda: (0, ""))
    usual = {}  # what is said of good files is no sign of a fault
    for extension, content in good.items():
        (work / "good" / ("scene" + extension)).write_bytes(content)
        usual[extension] = set()
        for pipeline in ("path", "raster"):
            render = run(work / "good", "render", "scene" + extension, "--size", "8x8", "--spp", "1", "--pipeline", pipeline)
            if render.code != 0:
                sys.exit("FAILED the good file scene%s is not rendered: %s" % (extension, render.err))
            usual[extension].update(remarks(render))
    base_memory = {pipeline: memory_of(work / "good", "render", "scene.gltf", "--size", "8x8", "--spp", "1", "--pipeline", pipeline)
                   for pipeline in ("path", "raster")}
    base_memory["info"] = 0  # the rule is for all that it takes
    cases = [case for case in malformed.CASES if arguments.only in case[0]]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(check, cases))
finally:
    if not arguments.keep:
        shutil.rmtree(work, ignore_errors=True)
failed = 0
for name, outcome, line, faults in results:
    if arguments.list:
        print("%-8s %s: %s" % (outcome, name, line))
    for fault in faults:
        print("FAILED %s: %s" % (name, fault))
    failed += bool(faults)
results = [result for result in results if result[0] not in malformed.GOOD]
count = collections.Counter(outcome for _, outcome, _, _ in results)
print("%d malformed files: %d refused, %d rendered with a warning; %d large good ones; %d failed"
      % (len(results), count["refused"], count["rendered"], len(malformed.GOOD), failed))
for command, (beyond, name) in most_beyond.items():
    print("%s: at most %d MiB beyond twice the file%s, by %s"
          % (command, beyond, " and the %d MiB of a small good one" % (base_memory[command] >> 20) if base_memory[command] else "", name))
if not arguments.only and len(results) < 200:
    sys.exit("FAILED fewer than 200 files")
sys.exit(1 if failed else 0)
