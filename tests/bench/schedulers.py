#!/usr/bin/env python3
"""Samples and rays per second of both schedulers of the path tracer, run by run in turn: see --help.

CPU seconds of rendering, start-up excluded; medians. The pictures must be equal to the bit. docs/benchmarks.md has the
table of a device; --scheduler auto takes what it says is faster.
"""

import argparse
import json
import os
import statistics
import subprocess
import tempfile

SCHEDULERS = ["megakernel", "wavefront"]
SCENES = ["sample:cornell", "sample:plates", "sample:glass", "sample:lights500", "sample:gallery"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="build folder with the target heliograph_cli")
    parser.add_argument("--scenes", nargs="+", default=SCENES, help="files or samples")
    parser.add_argument("--environment", help="of all scenes")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    program = options.build + "/samples/heliograph/heliograph"
    with tempfile.TemporaryDirectory() as folder:
        pictures = {name: os.path.join(folder, name + ".exr") for name in SCHEDULERS}
        stats = os.path.join(folder, "stats.json")
        print("| scene | Msamples / CPU s, megakernel | wavefront | Mrays / CPU s, megakernel | wavefront | wavefront / megakernel |")
        print("|---|---|---|---|---|---|", flush=True)
        for scene in options.scenes:
            samples = {name: [] for name in SCHEDULERS}
            rays = {name: [] for name in SCHEDULERS}
            for run in range(options.runs):
                for name in SCHEDULERS if run % 2 == 0 else SCHEDULERS[::-1]:
                    command = [program, "render", scene, "--size", "{0}x{0}".format(options.size), "--spp",
                               str(options.samples), "--scheduler", name, "-o", pictures[name], "--stats", stats, "--quiet"]
                    if options.environment:
                        command += ["--environment", options.environment]
                    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
                    with open(stats) as file:
                        found = json.load(file)
                    seconds = found["render_cpu_seconds"]
                    samples[name].append(options.size**2 * options.samples / seconds / 1e6)
                    rays[name].append(sum(found["rays"].values()) / seconds / 1e6)
            command = [program, "compare", *pictures.values(), "--json"]
            apart = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
            assert apart["worst"]["error"] == 0, "the pictures of %s differ" % scene
            ratio = statistics.median(b / a for a, b in zip(*samples.values()))
            figures = [statistics.median(values[name]) for values in (samples, rays) for name in SCHEDULERS]
            print("| %s | %.2f | %.2f | %.1f | %.1f | %.2f |" % (os.path.basename(scene), *figures, ratio), flush=True)


main()
