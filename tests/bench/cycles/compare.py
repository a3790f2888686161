#!/usr/bin/env python3
"""Efficiency of whole renders, 1 / (relMSE x CPU seconds), beside Blender Cycles: see --help.

Both renderers draw the same glTF files with the same pixel filter, threads and samples: four scenes of
bench_cycles_scenes and, where ASSETS are there, two textured assets under an environment map (export_assets.py).
Match: the squared relative distance of converged pictures without their noise (image_distance.cpp).
Error: relMSE against one of Heliograph's converged pictures. Time: CPU seconds of all threads, start-up excluded. Runs
of both in turn, medians. The second table has whole processes, start-up and files included: their CPU seconds at the
same samples, those of the same command at one sample, and what Heliograph's process takes to Cycles' error.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = ["cornell", "plates", "plates-triangles", "glass", "glass-triangles", "lights500"]  # exact spheres but for -triangles
ASSETS = {"helmet": "hdri/studio.exr", "fox": "hdri/sunset.exr"}  # and what surrounds them


def cpu_of(command):
    """CPU seconds of a process and all its threads; again where a signal ended it, as happens to Blender."""
    for attempt in range(3):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        text = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        if status == 0:
            return usage.ru_utime + usage.ru_stime
        if not os.WIFSIGNALED(status):
            break
    raise SystemExit("%s failed: %s" % (" ".join(command), text.decode()))


class Bench:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.program = options.build + "/samples/heliograph/heliograph"

    def path(self, name):
        return os.path.join(self.folder, name)

    def environment(self, scene):
        return ["--environment", os.path.join(self.options.assets, ASSETS[scene])] if scene in ASSETS else []

    def triangles(self, scene):
        """The file of a scene without exact spheres, which Cycles has not."""
        cut = self.path(scene + "-triangles.gltf")
        return cut if os.path.exists(cut) else self.path(scene + ".gltf")

    def heliograph_command(self, scene, samples, seed, out):
        return [self.program, "render", self.path(scene + ".gltf"), "--size", "{0}x{0}".format(self.options.size), "--spp",
                str(samples), "--seed", str(seed), "-o", out, "--stats", self.path("stats.json"), "--quiet",
                *self.environment(scene)]

    def cycles_command(self, scene, samples, seed, out):
        return ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                os.path.join(HERE, "render_cycles.py"), "--", self.triangles(scene), out, str(self.options.size),
                str(samples), str(seed), str(os.cpu_count()), *self.environment(scene)]

    def heliograph(self, scene, samples, seed):
        out = self.path("h-%s-%d-%d.exr" % (scene, samples, seed))
        subprocess.run(self.heliograph_command(scene, samples, seed, out), check=True, stderr=subprocess.DEVNULL)
        stats = json.load(open(self.path("stats.json")))
        rays = sum(stats["rays"].values())
        return out, stats["render_cpu_seconds"], rays / stats["render_cpu_seconds"]

    def cycles(self, scene, samples, seed):
        out = self.path("c-%s-%d-%d.exr" % (scene, samples, seed))
        for attempt in range(3):
            done = subprocess.run(self.cycles_command(scene, samples, seed, out), capture_output=True, text=True)
            if done.returncode >= 0:
                break
            print("blender died of signal %d, again" % -done.returncode, file=sys.stderr)  # now and then it does
        done.check_returncode()
        text = done.stdout
        return out, float([line for line in text.splitlines() if line.startswith("cycles ")][-1].split()[1])

    def whole(self, scene, rows):
        """Medians of CPU seconds of whole processes, and of those at one sample, of both."""
        samples, out = self.options.samples, self.path("whole.exr")
        found = []
        for seed in range(1, self.options.runs + 1):
            found.append({
                "whole": cpu_of(self.heliograph_command(scene, samples, seed, out)),
                "start": cpu_of(self.heliograph_command(scene, 1, seed, out)),
                "whole_cycles": cpu_of(self.cycles_command(scene, samples, seed, out) + ["--once"]),
                "start_cycles": cpu_of(self.cycles_command(scene, 1, seed, out) + ["--once"])})
        middle = {key: statistics.median(row[key] for row in found) for key in found[0]}
        # Error falls as one over time: what is left of the process is start-up.
        error, cpu, other = (statistics.median(row[key] for row in rows) for key in ("error", "cpu", "error_cycles"))
        middle["to_equal_error"] = middle["whole"] + cpu * (error / other - 1)
        return middle

    def relmse(self, image):
        command = [self.program, "compare", image, self.reference, "--json"]
        found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        assert found["nan"] == 0 and found["inf"] == 0, image
        return found["relmse"]

    def match(self, scene):
        """Distance of the converged pictures, its standard error, and the ratio of their means."""
        o = self.options
        ours = [self.heliograph(scene, o.reference, seed)[0] for seed in (101, 102)]
        theirs = [self.cycles(scene, o.reference_cycles, seed)[0] for seed in (101, 102)]
        self.reference = ours[0]
        command = [o.build + "/tests/bench/cycles/bench_cycles_distance", *ours, *theirs]
        return [float(x) for x in subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()]

    def run(self, scene):
        o = self.options
        rows = []
        for seed in range(1, o.runs + 1):
            image, cpu, rate = self.heliograph(scene, o.samples, seed)
            image_cycles, cpu_cycles = self.cycles(scene, o.samples, seed)
            error, error_cycles = self.relmse(image), self.relmse(image_cycles)
            rows.append({"cpu": cpu, "cpu_cycles": cpu_cycles, "error": error, "error_cycles": error_cycles,
                         "rays_per_second": rate, "ratio": error_cycles * cpu_cycles / (error * cpu)})
        return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="build folder with the targets heliograph_cli and bench_cycles")
    parser.add_argument("--scenes", nargs="+", choices=SCENES + list(ASSETS), help="default: all that are there")
    parser.add_argument("--assets", default=os.path.join(HERE, "../../../../shared/assets"),
                        help="folder with gltf/FlightHelmet, gltf/Fox.glb and hdri")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--reference", type=int, default=4096, help="samples of Heliograph's converged pictures")
    parser.add_argument("--reference-cycles", type=int, default=2048)
    parser.add_argument("--keep", help="folder to work in, which is kept")
    parser.add_argument("--json", help="file for all figures")
    options = parser.parse_args()
    have_assets = os.path.isdir(os.path.join(options.assets, "gltf"))
    options.assets = os.path.abspath(options.assets)
    if not options.scenes:
        options.scenes = SCENES + (list(ASSETS) if have_assets else [])
        if not have_assets:
            print("left out: %s, since %s is not there" % (", ".join(ASSETS), options.assets), file=sys.stderr)
    results, whole = {}, {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or scratch
        os.makedirs(folder, exist_ok=True)
        bench = Bench(options, folder)
        subprocess.run([options.build + "/tests/bench/cycles/bench_cycles_scenes", folder], check=True)
        if have_assets:
            subprocess.run([os.path.join(HERE, "export_assets.py"), options.assets, folder], check=True)
        print("| scene | distance of the means | CPU s | Cycles | relMSE | Cycles | Mrays / CPU s | efficiency / Cycles' (least, most) |")
        print("|---|---|---|---|---|---|---|---|", flush=True)
        for scene in options.scenes:
            distance, uncertain, ratio = bench.match(scene)
            rows = bench.run(scene)
            middle = {key: statistics.median(row[key] for row in rows) for key in rows[0]}
            ratios = [row["ratio"] for row in rows]
            print("| %s | %.1e ± %.0e, %+.2f %% | %.2f | %.2f | %.3g | %.3g | %.1f | %.1f (%.1f, %.1f) |" %
                  (scene, distance, uncertain, 100 * (ratio - 1), middle["cpu"], middle["cpu_cycles"], middle["error"],
                   middle["error_cycles"], middle["rays_per_second"] / 1e6, middle["ratio"], min(ratios), max(ratios)),
                  flush=True)
            whole[scene] = bench.whole(scene, rows)
            results[scene] = {"distance": distance, "standard_error": uncertain, "mean_ratio": ratio, "runs": rows,
                              "process": whole[scene]}
        print("\n| scene | whole process, CPU s | Cycles | at one sample | Cycles | to Cycles' error | over Cycles' |")
        print("|---|---|---|---|---|---|---|")
        for scene, w in whole.items():
            print("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |" %
                  (scene, w["whole"], w["whole_cycles"], w["start"], w["start_cycles"], w["to_equal_error"],
                   w["to_equal_error"] / w["whole_cycles"]))
    if options.json:
        json.dump(results, open(options.json, "w"), indent=1)


main()
