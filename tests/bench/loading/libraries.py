#!/usr/bin/env python3
"""The libraries of Debian 12 that read OBJ, PLY and STL, beside this repository's readers: seconds and peak memory for
the files of loading.sh, and what each says of malformed files. Prints two Markdown tables. Needs cmake/packages-bench.txt.
  tests/bench/loading/libraries.py BUILD [TRIANGLES...]
"""
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(root / "tests/hostile"))
import malformed

build = pathlib.Path(sys.argv[1]).resolve()
counts = [int(count) for count in sys.argv[2:]] or [10 ** 4, 10 ** 5, 10 ** 6, 10 ** 7]
RUNS = int(os.environ.get("RUNS", 3))
subprocess.run(["cmake", "--build", str(build), "--target", "bench_loading", "bench_loading_libraries"], check=True, stdout=subprocess.DEVNULL)
own = str(build / "tests/bench/loading/bench_loading")
libraries = own + "_libraries"
READERS = {"obj": [(own, "heliograph"), (own, "assimp"), (libraries, "tinyobjloader"), (libraries, "tinyobjloader-callbacks")],
           "ply": [(own, "heliograph"), (own, "assimp")], "stl": [(own, "heliograph"), (own, "assimp"), (libraries, "admesh")]}


def run(reader, file, seconds=None):
    limit = (lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))) if seconds else None  # a hang
    return subprocess.run([*reader, file], cwd=os.path.dirname(file), capture_output=True, text=True, errors="replace", preexec_fn=limit)


print("| file | triangles | reader | s | peak, MiB | peak / geometry |\n|---|---|---|---|---|---|")
with tempfile.TemporaryDirectory() as folder:
    for kind, readers in READERS.items():
        for count in counts:
            file = "%s/mesh.%s" % (folder, kind)
            subprocess.run([own, "write", kind, str(count), file], check=True)
            geometry = None
            for reader in readers:
                rows = [[float(word) for word in run(reader, file).stdout.split()] for _ in range(RUNS)]
                triangles, seconds, peak, bytes_ = (statistics.median(column) for column in zip(*rows))
                geometry = geometry or bytes_  # what the scene holds, for all of them
                print("| %s | %d | %s | %.3f | %.1f | %.2f |" % (kind, triangles, reader[1], seconds, peak, peak / geometry))
            os.remove(file)

print("\n| reader | malformed files | refused with the place | refused without | loaded with a warning | without | crashed or 2 s |\n|---|---|---|---|---|---|---|")
with tempfile.TemporaryDirectory() as folder:
    for kind, readers in READERS.items():
        cases = [(name, files) for name, files in malformed.CASES if name.startswith(kind + "-") and
                 all(isinstance(content, bytes) for content in files.values())]
        for reader in readers:
            ends = {"place": 0, "refused": 0, "warned": 0, "silent": 0, "crashed": 0}
            for name, files in cases:
                for file, content in files.items():
                    (pathlib.Path(folder) / file).write_bytes(content)
                ended = run(reader, str(pathlib.Path(folder) / next(iter(files))), 2)
                if ended.returncode == 0:
                    ends["warned" if ended.stderr.strip() else "silent"] += 1
                elif ended.returncode != 1:
                    ends["crashed"] += 1
                else:  # the line, the element or the byte
                    ends["place" if re.search(r"line \d|byte \d|(vertex|face|facet|triangle|element) \w|header|mtllib|usemtl", ended.stderr) else "refused"] += 1
            print("| %s %s | %d | %s |" % (kind, reader[1], len(cases), " | ".join(str(n) for n in ends.values())))
