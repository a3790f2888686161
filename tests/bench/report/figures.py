"""Recorded figures: tables that benchmarks printed, kept as JSON in docs/figures with the command that prints them."""
import json
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[3]
FOLDER = ROOT / "docs" / "figures"

# NAME: title, and the command that prints its Markdown table (BUILD stands for the build folder).
TABLES = {
    "bench": ("Error against time", "BUILD/samples/heliograph/heliograph bench --json bench.json && "
                                    "tests/bench/report/report.py bench.json --table"),
    "peers": ("Beside its peers", "tests/bench/peers.py BUILD"),
    "price": ("What features cost", "cmake --build BUILD --target bench_price && "
                                    "BUILD/tests/bench/price/bench_price features"),
    "price_raster": ("What features of the raster pipeline cost", "cmake --build BUILD --target bench_price && "
                                                                  "BUILD/tests/bench/price/bench_price features raster"),
    "mutation": ("Planted faults", "tests/mutation/mutation.py BUILD --engine"),
    "sweeps": ("How far quantities can go", "cmake --build BUILD --target stability_sweeps && "
                                            "BUILD/tests/stability/stability_sweeps BUILD/sweeps.json && "
                                            "tests/stability/picture.py BUILD/sweeps.json docs/figures/sweeps.png"),
    "ulp": ("Worst errors of the shared functions", "cmake --build BUILD --target accuracy_math && "
                                                    "HELIOGRAPH_SEARCH_SECONDS=60 BUILD/tests/accuracy/accuracy_math "
                                                    "--gtest_filter='*Search*'"),
    "startup": ("Start-up", "RUNS=3 tests/bench/startup.sh BUILD"),
    "cycles": ("Whole renders beside Blender Cycles", "cmake --build BUILD --target heliograph_cli bench_cycles && "
                                                      "tests/bench/cycles/compare.py BUILD"),
    "traversal": ("Traversal beside Embree", "cmake --build BUILD --target bench_traversal && "
                                             "BUILD/tests/bench/traversal/bench_traversal"),
    "raster": ("Rasterizer beside the graphics pipeline", "cmake --build BUILD --target bench_raster && "
                                                          "BUILD/tests/bench/raster/bench_raster --rounds 21"),
    "loading": ("Loading beside assimp", "RUNS=1 tests/bench/loading/loading.sh BUILD"),
    "denoise": ("Denoised pictures", "cmake --build BUILD --target bench_error && "
                                     "BUILD/tests/bench/error/bench_error table --seeds 6 --reference 2048"),
    "materials": ("Materials as they are added", "cmake --build BUILD --target bench_materials && "
                                                 "tests/bench/materials/run.sh BUILD"),
}


def parse_table(text):
    """The first Markdown table in a text: header and rows of cells."""
    lines = [line.strip() for line in text.splitlines()]
    for i in range(len(lines) - 1):
        if lines[i].startswith("|") and re.fullmatch(r"\|[-:|\s]+\|", lines[i + 1]):
            rows = []
            for line in lines[i + 2:]:
                if not line.startswith("|"):
                    break
                rows.append([cell.strip() for cell in line.strip("|").split("|")])
            return [cell.strip() for cell in lines[i].strip("|").split("|")], rows
    raise ValueError("there is no Markdown table in it")


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def load(name):
    """A recorded figure, or None."""
    file = FOLDER / f"{name}.json"
    return json.loads(file.read_text()) if file.exists() else None


def picture(name):
    """The file of a recorded figure's picture, or None."""
    file = FOLDER / f"{name}.png"
    return file if file.exists() else None


def store(name, header, rows, date, conditions):
    title, command = TABLES[name]
    FOLDER.mkdir(parents=True, exist_ok=True)
    record = {"title": title, "command": command.replace("BUILD", "build"), "date": date, "conditions": conditions,
              "header": header, "rows": rows}
    (FOLDER / f"{name}.json").write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n")


def marked(name, record):
    """What stands between a figure's marks in a page."""
    return (f"<!-- figure {name}: tests/bench/report/record.py writes it -->\n`{record['command']}`\n\n"
            f"{markdown(record['header'], record['rows'])}\n\n"
            f"Recorded {record['date']}: {record['conditions']}.\n<!-- /figure -->")


def renew(page):
    """The page's text with all figures as they are recorded; one that is not stays as it is."""
    def replace(match):
        record = load(match[1])
        return match[0] if record is None else marked(match[1], record)
    return re.sub(r"<!-- figure (\w+):.*?<!-- /figure -->", replace, page.read_text(), flags=re.S)
