#!/usr/bin/env python3
"""One self-contained HTML page of what `heliograph bench` measured, with the other recorded figures.

    tests/bench/report/report.py BENCH.json -o REPORT.html
    tests/bench/report/report.py BENCH.json --table            a Markdown table: one line a series

Needs matplotlib (Debian: python3-matplotlib) for the page.
"""
import argparse
import base64
import collections
import html
import io
import json
import pathlib
import sys

import figures

GROUPS = {
    "samplers": "Samplers",
    "lights": "Choice of lights",
    "errors": "Adaptive sampling and denoising",
    "integrators": "Other integrators, held against all of light's ways",
    "accelerators": "Accelerators",
    "antialiasing": "The rasterizer's antialiasing",
    "filters": "Texture filters",
    "mips": "Mip generation",
    "traversal": "Traversal",
}
STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 sans-serif; color: #1b1f24; background: #fff; max-width: 1100px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #d0d7de; } h3 { margin-bottom: .3rem; }
code { background: #f3f5f7; padding: .1em .3em; border-radius: 3px; font-size: .9em; overflow-wrap: anywhere; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: .85rem; margin: .6rem 0; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid #e3e8ee; text-align: right; } th { background: #f6f8fa; }
td:first-child, th:first-child, td:nth-child(2), th:nth-child(2) { text-align: left; }
.plot { width: 100%; height: auto; } .small { color: #57606a; font-size: .85rem; }
.pictures { display: flex; flex-wrap: wrap; gap: .8rem; } figure { margin: 0; width: 150px; }
figure img { width: 150px; height: 150px; image-rendering: pixelated; border: 1px solid #d0d7de; display: block; }
figcaption { font-size: .8rem; color: #57606a; }
"""


def points_of(series):
    """Per number of samples: mean error, its spread over the renders, least CPU time."""
    by_samples = collections.defaultdict(list)
    for point in series["points"]:
        by_samples[point["samples"]].append(point)
    rows = []
    for samples, renders in sorted(by_samples.items()):
        errors = [render["relmse"] for render in renders]
        mean = sum(errors) / len(errors)
        rows.append({"samples": samples, "relmse": mean, "low": min(errors), "high": max(errors),
                     "cpu": min(render["cpu_seconds"] for render in renders), "items": renders[0].get("items")})
    return rows


def time_to(rows, error):
    """CPU seconds at which a series has an error, between its points on straight lines of the logarithms."""
    import math
    for before, after in zip(rows, rows[1:]):
        if before["relmse"] >= error >= after["relmse"] > 0:
            share = math.log(before["relmse"] / error) / max(math.log(before["relmse"] / after["relmse"]), 1e-12)
            return before["cpu"] * (after["cpu"] / before["cpu"]) ** share
    return None


def table_rows(record):
    """A line a series; the ratio is to the scene's first series of the same truth."""
    first = {}
    rows = []
    for series in record["series"]:
        points = points_of(series)
        last = points[-1]
        if "unit" in series:
            rows.append([series["scene"], series["group"], series["method"], f"{last['samples']} {series['unit']}",
                         f"{last['relmse']:.3g}", f"{last['cpu']:.3g}", "", ""])
            continue
        baseline = first.setdefault((series["truth"], series["group"] == "filters"), points)
        fit = series.get("fit", {})
        # At the least error that both reach.
        common = max(last["relmse"], baseline[-1]["relmse"])
        own, base = time_to(points, common), time_to(baseline, common)
        order = f"{fit['order']:.2f} ± {fit['order_error']:.2f}" if fit.get("order") else ""
        if fit.get("expected_order"):
            order += " ({:g} to {:g})".format(*fit["expected_order"])
        ratio = f"{base / own:.2f}" if base and own and baseline is not points else ""
        rows.append([series["scene"], series["group"], series["method"], str(last["samples"]), f"{last['relmse']:.3g}",
                     f"{last['cpu']:.3g}", order, ratio])
    return ["scene", "group", "method", "samples", "relMSE", "CPU s", "order (by theory)", "speed at equal error"], rows


def plot(series_list, title):
    """Error against CPU time and against samples, both logarithmic, as a PNG."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    picture, (time_axes, sample_axes) = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True, layout="constrained")
    drawn = False
    for i, series in enumerate(series_list):
        rows = [row for row in points_of(series) if row["relmse"] > 0 and row["cpu"] > 0]
        if not rows:
            continue
        drawn = True
        errors = [row["relmse"] for row in rows]
        spread = [[max(row["relmse"] - max(row["low"], row["relmse"] * 1e-3), 0) for row in rows],
                  [max(row["high"] - row["relmse"], 0) for row in rows]]
        style = dict(marker="osD^vP*X"[i % 8], markersize=4, linewidth=1.4, capsize=2, elinewidth=.8,
                     color=plt.cm.tab10(i % 10), linestyle="--" if series["biased"] else "-", label=series["method"])
        time_axes.errorbar([row["cpu"] for row in rows], errors, yerr=spread, **style)
        sample_axes.errorbar([row["samples"] for row in rows], errors, yerr=spread, **style)
    time_axes.set_xlabel("CPU time of rendering, s")
    sample_axes.set_xlabel("samples per pixel")
    time_axes.set_ylabel("relMSE")
    for axes in (time_axes, sample_axes):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.grid(True, which="major", color="#d0d7de", linewidth=.6)
        axes.grid(True, which="minor", color="#eef1f4", linewidth=.4)
    sample_axes.set_xscale("log", base=2)
    sample_axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    picture.suptitle(title, fontsize=11)
    data = io.BytesIO()
    picture.savefig(data, format="png", dpi=110)
    plt.close(picture)
    return data.getvalue() if drawn else None


def plot_sizes(series_list, title):
    """CPU time of one texel or ray against the size, and the error, as a PNG."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    picture, (time_axes, error_axes) = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    for i, series in enumerate(series_list):
        label = f"{series['scene']}, {series['method']}"
        # Powers of two are a line, other sizes points beside it.
        for odd in (False, True):
            rows = [row for row in points_of(series) if (row["samples"] & (row["samples"] - 1) != 0) == odd]
            if not rows:
                continue
            style = dict(marker="osD^"[i % 4], markersize=4, linewidth=0 if odd else 1.4, color=plt.cm.tab10(i % 10),
                         markerfacecolor="none" if odd else None, label=None if odd else label)
            time_axes.plot([row["samples"] for row in rows], [row["cpu"] / row["items"] * 1e9 for row in rows], **style)
            error_axes.plot([row["samples"] for row in rows], [max(row["relmse"], 1e-18) for row in rows], **style)
    time_axes.set_ylabel("CPU time of each texel that is made, or ray, ns")
    error_axes.set_ylabel("relMSE against double precision (none: 1e-18)")
    error_axes.axhline(1e-9, color="#8c959f", linewidth=.8, linestyle=":")
    for axes in (time_axes, error_axes):
        axes.set_xlabel(series_list[0]["unit"])
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.grid(True, which="major", color="#d0d7de", linewidth=.6)
    error_axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    picture.suptitle(title, fontsize=11)
    data = io.BytesIO()
    picture.savefig(data, format="png", dpi=110)
    plt.close(picture)
    return data.getvalue()


def image(data, alternative, css=""):
    encoded = base64.b64encode(data).decode()
    return f'<img {css} alt="{html.escape(alternative)}" src="data:image/png;base64,{encoded}">'


def html_table(header, rows):
    cells = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table></div>'


def pictures(record, folder, truth, series_list):
    shown = []
    description = record["truths"].get(truth, {})
    if "picture" in description and (folder / description["picture"]).exists():
        kind = description["kind"]
        if kind == "reference":
            kind = f"reference, {description['samples']} samples, own relMSE {description['residual_relmse']:.1e}"
        shown.append(("truth", kind, folder / description["picture"]))
    for series in series_list:
        for point in series["points"]:
            if "picture" not in point:
                continue
            error = f"{point['samples']} samples, relMSE {point['relmse']:.2g}"
            shown.append((series["method"], error, folder / point["picture"]))
            shown.append((series["method"], "its error: white is 100\u00a0%", folder / point["difference"]))
    parts = []
    for name, detail, file in shown:
        if file.exists():
            parts.append(f"<figure>{image(file.read_bytes(), name)}<figcaption><b>{html.escape(name)}</b><br>"
                         f"{html.escape(detail)}</figcaption></figure>")
    return f'<div class="pictures">{"".join(parts)}</div>'


def page(record, folder):
    settings = record["settings"]
    parts = ["<h1>Heliograph: error against time</h1>",
             f"<p>Version {html.escape(record['version'])} on {html.escape(record['device'])}; pictures of "
             f"{settings['size'][0]}x{settings['size'][1]} pixels, {settings['repeats']} renders of every point. Errors are "
             "relMSE, mean((x − truth)² / (truth² + 0.01)), against a closed form, or a reference whose own error, told by "
             "two independent halves, is subtracted. Times are CPU seconds of all threads, rendering alone (set-up is in "
             "the JSON); the least of a point's renders. Bars span the errors of its renders; dashed methods are biased.</p>"]
    header, rows = table_rows(record)
    parts += ["<h2>Series</h2>", "<p class='small'>The last point of each series. Order: exponent of relMSE over samples. "
              "Speed at equal error: CPU time of the scene's first series over this one's, at the least error that both reach."
              "</p>", html_table(header, rows)]
    by_group = collections.defaultdict(lambda: collections.defaultdict(list))
    firsts = {}
    for series in record["series"]:
        firsts.setdefault(series["truth"], series)
        by_group[series["group"]][series["truth"]].append(series)
    for group, truths in by_group.items():
        parts.append(f"<h2>{html.escape(GROUPS.get(group, group))}</h2>")
        of_sizes = [series for series_list in truths.values() for series in series_list if "unit" in series]
        if of_sizes:
            drawing = plot_sizes(of_sizes, f"{GROUPS.get(group, group)}: cost and error over sizes")
            parts.append(image(drawing, group, 'class="plot"'))
            continue
        for truth, series_list in truths.items():
            # The scene's first series beside those that are compared with it.
            shown = series_list if firsts[truth] in series_list else [firsts[truth]] + series_list
            parts.append(f"<h3>{html.escape(series_list[0]['scene'])}</h3>")
            alone = len(shown) == 1 and any(series["truth"] == truth and series not in shown for series in record["series"])
            drawing = None if alone else plot(shown, f"{series_list[0]['scene']}: {GROUPS.get(group, group).lower()}")
            if drawing:
                parts.append(image(drawing, f"{truth} {group}", 'class="plot"'))
            parts.append(pictures(record, folder, truth, series_list))
    recorded = [(name, figures.load(name)) for name in figures.TABLES if name != "bench"]
    for name, figure in recorded:
        if figure is None:
            continue
        parts += [f"<h2>{html.escape(figure['title'])}</h2>", f"<p><code>{html.escape(figure['command'])}</code></p>",
                  html_table(figure["header"], figure["rows"]),
                  image(figures.picture(name).read_bytes(), figure["title"], 'class="plot"') if figures.picture(name) else "",
                  f"<p class='small'>Recorded {figure['date']}: {html.escape(figure['conditions'])}.</p>"]
    return ("<!doctype html><html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
            "content='width=device-width, initial-scale=1'><title>Heliograph: error against time</title>"
            f"<style>{STYLE}</style></head><body>{''.join(parts)}</body></html>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--table", action="store_true")
    arguments = parser.parse_args()
    record = json.loads(arguments.bench.read_text())
    if record.get("what") != "heliograph bench":
        sys.exit(f"{arguments.bench}: no record of heliograph bench")
    if arguments.table:
        print(figures.markdown(*table_rows(record)))
    if arguments.output:
        arguments.output.write_text(page(record, arguments.bench.with_suffix(".pictures")))


if __name__ == "__main__":
    main()
