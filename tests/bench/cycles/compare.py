#!/usr/bin/env python3
"""Efficiency of whole renders, 1 / (relMSE x CPU seconds), beside Blender Cycles: see --help.

Both renderers draw the same four glTF files (bench_cycles_scenes) with the same pixel filter, threads and samples.
Match: the squared relative distance of converged pictures without their noise (image_distance.cpp).
Error: relMSE against one of Heliograph's converged pictures. Time: CPU seconds of all threads, start-up excluded. Runs
of both in turn, medians.
"""

import argparse
import json
import os
import statistics
import subprocess
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = ["cornell", "plates", "glass", "lights500"]


class Bench:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.program = options.build + "/samples/heliograph/heliograph"

    def path(self, name):
        return os.path.join(self.folder, name)

    def heliograph(self, scene, samples, seed):
        out = self.path("h-%s-%d-%d.exr" % (scene, samples, seed))
        command = [self.program, "render", self.path(scene + ".gltf"), "--size", "{0}x{0}".format(self.options.size),
                   "--spp", str(samples), "--seed", str(seed), "-o", out, "--stats", self.path("stats.json"), "--quiet"]
        subprocess.run(command, check=True)
        stats = json.load(open(self.path("stats.json")))
        rays = sum(stats["rays"].values())
        return out, stats["render_cpu_seconds"], rays / stats["render_cpu_seconds"]

    def cycles(self, scene, samples, seed):
        out = self.path("c-%s-%d-%d.exr" % (scene, samples, seed))
        command = ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                   os.path.join(HERE, "render_cycles.py"), "--", self.path(scene + ".gltf"), out, str(self.options.size),
                   str(samples), str(seed), str(os.cpu_count())]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        return out, float([line for line in text.splitlines() if line.startswith("cycles ")][-1].split()[1])

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
    parser.add_argument("--scenes", nargs="+", default=SCENES, choices=SCENES)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--reference", type=int, default=4096, help="samples of Heliograph's converged pictures")
    parser.add_argument("--reference-cycles", type=int, default=2048)
    parser.add_argument("--keep", help="folder to work in, which is kept")
    parser.add_argument("--json", help="file for all figures")
    options = parser.parse_args()
    results = {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or scratch
        os.makedirs(folder, exist_ok=True)
        bench = Bench(options, folder)
        subprocess.run([options.build + "/tests/bench/cycles/bench_cycles_scenes", folder], check=True)
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
            results[scene] = {"distance": distance, "standard_error": uncertain, "mean_ratio": ratio, "runs": rows}
    if options.json:
        json.dump(results, open(options.json, "w"), indent=1)


main()
