#!/usr/bin/env python3
"""Pictures of where each swept quantity begins to fail.

    tests/stability/picture.py POINTS.json PICTURE     (.svg or .png; POINTS.json: what stability_sweeps wrote)

Needs matplotlib (Debian: python3-matplotlib).
"""
import json
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

FLOOR, CEILING = 1e-10, 1e2
STYLES = {  # right?, what a render says: colour, marker, words
    (True, "nothing"): ("#1a7f37", "o", "right"),
    (True, "warned"): ("#1a7f37", "^", "right, with a warning"),
    (False, "warned"): ("#bc4c00", "^", "wrong, with a warning"),
    (False, "nothing"): ("#cf222e", "X", "wrong, without a word"),
    (False, "refused"): ("#57606a", "s", "refused"),
}


def shown(point):
    """An error's place on the axis: none at the bottom, what is not finite or refused at the top."""
    error = point["error"]
    return CEILING if error is None or not math.isfinite(error) else min(max(error, FLOOR), CEILING)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        record = json.load(file)
    if record.get("what") != "stability_sweeps":
        sys.exit(f"{sys.argv[1]}: no points of stability_sweeps")
    sweeps = record["sweeps"]
    columns = 3
    rows = len(sweeps) // columns + 1  # a place is left for the legend
    figure, grid = plt.subplots(rows, columns, sharey=True, layout="constrained", figsize=(11, 2.1 * rows))
    used = set()
    for axes, sweep in zip(grid.flat, sweeps):
        points = [point for point in sweep["points"] if point["value"] > 0]
        axes.plot([point["value"] for point in points], [shown(point) for point in points], color="#8c959f",
                  linewidth=.8)
        for point in points:
            key = point["right"], point["said"]
            used.add(key)
            colour, marker, _ = STYLES[key]
            axes.plot(point["value"], shown(point), marker, color=colour, markersize=4)
            if point["noise"]:  # what four standard errors of it leave
                least = max((point["error"] or 0) - 4 * point["noise"], FLOOR)
                axes.vlines(point["value"], least, shown(point), color=colour, linewidth=.6)
        axes.axhline(sweep["tolerance"], color="#0969da", linewidth=.8, linestyle="--")
        axes.set_title(sweep["name"], fontsize=8)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(FLOOR / 3, CEILING * 3)
        axes.tick_params(labelsize=7)
        axes.grid(True, color="#eaeef2", linewidth=.5)
    for axes in list(grid.flat)[len(sweeps):]:
        axes.set_visible(False)
    handles = [plt.Line2D([], [], linestyle="", marker=marker, color=colour, label=words)
               for key, (colour, marker, words) in STYLES.items() if key in used]
    handles.append(plt.Line2D([], [], color="#0969da", linestyle="--", linewidth=.8, label="right within"))
    figure.legend(handles=handles, fontsize=9, loc="lower right", frameon=False)
    figure.supylabel(f"relative error (none: {FLOOR:g}; not finite or refused: {CEILING:g})", fontsize=8)
    figure.savefig(sys.argv[2], dpi=100, metadata={"Date": None} if sys.argv[2].endswith(".svg") else None)


if __name__ == "__main__":
    main()
