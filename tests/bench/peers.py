#!/usr/bin/env python3
"""Heliograph beside its peers in one run: Blender Cycles, Embree, the driver's graphics pipeline, vkCmdBlitImage and
OpenImageIO, each where it is installed.

    tests/bench/peers.py BUILD [--quick] [--only PEER...] [--repeats N] [--json FILE] [--cycles FILE]

BUILD is a Release build, in which the benchmarks that this needs are made. Prints a Markdown table (what else is to be
said goes to standard error); the JSON has every repeat, and a peer that it holds is not run again. The ratio is Heliograph's time to the same error over the peer's:
below 1 it is faster. For whole renders the error is relMSE, and time to equal error the product of CPU time and relMSE,
since that of both falls as one over time; rays, triangles and levels are the same for both, so that it is the time
itself. "Alone" is without start-up, "whole" with it: of whole renders the process, start-up, files and all, until it has
the peer's error. Spread: least and most of the repeats, run in turn with the peer's. A peer that is not there is named
with what it lacks.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE / "report"))
import figures  # noqa: E402


class Missing(Exception):
    """What a peer needs and is not installed."""


def say(text):
    print(f"peers: {text}", file=sys.stderr, flush=True)


def output_of(command):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise Missing(f"{pathlib.Path(command[0]).name} failed with {done.returncode}")
    return done.stdout


class Peers:
    def __init__(self, options, scratch):
        self.options, self.scratch = options, scratch
        self.build = options.build.resolve()

    def make(self, *targets):
        """Programs of the build; Missing where one has no target, for want of its packages."""
        known = output_of(["cmake", "--build", self.build, "--target", "help"])
        for target in targets:
            if f"{target}:" not in known:
                raise Missing(f"{target} is not in this build: cmake/install-packages.sh bench, then configure anew")
        subprocess.run(["cmake", "--build", self.build, "--target", *targets], check=True, stdout=sys.stderr)

    def program(self, folder, name):
        return self.build / "tests" / "bench" / folder / name

    def repeated(self, command, rows_of):
        """Ratios of each case over the repeats of a benchmark: {case: [ratio]}."""
        ratios = {}
        for repeat in range(self.options.repeats):
            say(f"{pathlib.Path(command[0]).name}, {repeat + 1} of {self.options.repeats}")
            for case, ratio in rows_of(output_of(command)):
                ratios.setdefault(case, []).append(ratio)
        return [{"case": case, "alone": values} for case, values in ratios.items()]

    def cycles(self):
        """compare.py repeats by itself, in turn with Cycles, and matches converged pictures first."""
        if self.options.cycles:
            found = json.loads(self.options.cycles.read_text())
        else:
            if not shutil.which("blender"):
                raise Missing("blender is not installed")
            self.make("heliograph_cli", "bench_cycles")
            file = self.scratch / "cycles.json"
            quick = ["--size", "64", "--reference", "512", "--reference-cycles", "256", "--scenes", "cornell", "glass"]
            command = [HERE / "cycles" / "compare.py", self.build, "--runs", self.options.repeats, "--json", file]
            sys.stderr.write(output_of(command + (quick if self.options.quick else [])))
            found = json.loads(file.read_text())
        rows = []
        for scene, result in found.items():
            alone = [1 / run["ratio"] for run in result["runs"]]
            whole = result["process"]
            rows.append({"case": scene, "alone": alone, "whole": whole["to_equal_error"] / whole["whole_cycles"],
                         "start": [whole["start"], whole["start_cycles"]], "distance": result["distance"]})
        return rows

    def embree(self):
        self.make("bench_traversal")
        file = self.scratch / "traversal.json"
        command = [self.program("traversal", "bench_traversal"), "--json", file]
        command += ["--size", "320x176", "--runs", "5", "--only", "knot"] if self.options.quick else ["--runs", "7"]

        def rows_of(_):
            for mesh in json.loads(file.read_text()):
                for row in mesh["rows"]:
                    yield f"{mesh['mesh']}, {row['rays']}", 1 / row["cpu_ratio"]
                yield f"{mesh['mesh']}, build", mesh["build_ratio"]

        return self.repeated(command, rows_of)

    def graphics(self):
        self.make("bench_raster")

        def rows_of(text):
            header, rows = figures.parse_table(text)
            column = header.index("in CPU time")
            for row in rows:
                yield row[0], 1 / float(row[column])

        command = [self.program("raster", "bench_raster"), "--rounds", "5" if self.options.quick else "15"]
        return self.repeated(command + ([] if self.options.quick else self.assets()), rows_of)

    def assets(self):
        files = [ROOT.parent / "shared" / "assets" / name
                 for name in ("gltf/FlightHelmet/FlightHelmet.gltf", "meshes/spot/spot.obj")]
        return [file for file in files if file.exists()]

    def levels(self, command):
        """{(base, what): fastest milliseconds} of a table of chains."""
        header, rows = figures.parse_table(output_of(command))
        column = header.index("fastest, ms")
        return {(row[0], row[1].split()[0]): float(row[column]) for row in rows}

    def mips(self, target, name):
        """Chains of levels beside those of a row of the target's table."""
        self.make("bench_mip", target)
        size = ["--rounds", "5", "--size", "1024" if self.options.quick else "4096"]
        ratios = {}
        for repeat in range(self.options.repeats):
            say(f"{target}, {repeat + 1} of {self.options.repeats}")
            own = self.levels([self.program("mip", "bench_mip"), *size])
            other = own if target == "bench_mip" else self.levels([self.program("mip", target), *size])
            for base in dict.fromkeys(base for base, _ in own):
                ratios.setdefault(base, []).append(own[base, "passes/mip"] / other[base, name])
        return [{"case": f"{base}, {size[-1]} texels a side", "alone": values} for base, values in ratios.items()]

    def blits(self):
        return self.mips("bench_mip", "chain")

    def openimageio(self):
        return self.mips("bench_mip_oiio", "OpenImageIO")


PEERS = {
    "cycles": "Blender Cycles: whole renders, CPU time",
    "embree": "Embree: rays one by one, CPU time",
    "graphics": "the driver's graphics pipeline: visibility, CPU time",
    "blits": "vkCmdBlitImage: mip chains, time on the device",
    "openimageio": "OpenImageIO: mip chains by its box, wall time",
}


def spread(values):
    return [f"{statistics.median(values):.2f}", f"{min(values):.2f} to {max(values):.2f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="small sizes and few scenes: minutes in place of an hour")
    parser.add_argument("--only", nargs="+", choices=list(PEERS))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--cycles", type=pathlib.Path, help="what compare.py wrote before, in place of running it")
    options = parser.parse_args()
    record = {"what": "heliograph peers", "quick": options.quick, "cores": os.cpu_count(), "peers": {}}
    if options.json and options.json.exists():
        found = json.loads(options.json.read_text())
        if any(found.get(key) != record[key] for key in ("what", "quick", "cores")):
            sys.exit(f"{options.json}: not a record of this run; name another file")
        record = found
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        peers = Peers(options, pathlib.Path(scratch))
        for name in options.only or PEERS:
            try:
                kept = record["peers"].get(name)
                measured = kept if isinstance(kept, list) else getattr(peers, name)()
            except Missing as error:
                say(f"left out: {PEERS[name]}: {error}")
                record["peers"][name] = {"left_out": str(error)}
                rows.append([PEERS[name], f"left out: {error}", "", "", ""])
                continue
            record["peers"][name] = measured
            for row in measured:
                whole = f"{row['whole']:.2f}" if "whole" in row else ""
                rows.append([PEERS[name], row["case"], *spread(row["alone"]), whole])
            if options.json:
                options.json.write_text(json.dumps(record, indent=1) + "\n")
    print(figures.markdown(["peer", "case", "time to equal error / the peer's", "over repeats", "whole process"], rows))
    if options.json:
        options.json.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()
