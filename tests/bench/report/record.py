#!/usr/bin/env python3
"""Records the tables that benchmarks print, and writes them into the documents that show them.

    tests/bench/report/record.py BUILD NAME... --conditions TEXT   runs the benchmarks, records, renews the documents
    tests/bench/report/record.py --from FILE NAME --conditions TEXT   records a table that was printed before
    tests/bench/report/record.py --write                           renews the documents from what is recorded
    tests/bench/report/record.py --check                           whether the documents say what is recorded
    tests/bench/report/record.py --list                            names and commands

Documents are docs/*.md; a figure stands between "<!-- figure NAME: ... -->" and "<!-- /figure -->".
"""
import argparse
import datetime
import pathlib
import subprocess
import sys

import figures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--from", dest="printed", type=pathlib.Path)
    parser.add_argument("--conditions", default="")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    if arguments.list:
        for name, (title, command) in figures.TABLES.items():
            print(f"{name:10} {title}\n           {command}")
        return
    names = arguments.names if arguments.printed else arguments.names[1:]
    for name in names:
        if name not in figures.TABLES:
            sys.exit(f"there is no figure '{name}'; see --list")
        if not arguments.conditions:
            sys.exit("say with --conditions on what machine and driver it runs")
        if arguments.printed:
            text = arguments.printed.read_text()
        else:
            command = figures.TABLES[name][1].replace("BUILD", arguments.names[0])
            text = subprocess.run(command, shell=True, check=True, cwd=figures.ROOT, stdout=subprocess.PIPE,
                                  text=True).stdout
        header, rows = figures.parse_table(text)
        figures.store(name, header, rows, datetime.date.today().isoformat(), arguments.conditions)
    stale = []
    for page in sorted((figures.ROOT / "docs").glob("*.md")):
        text = figures.renew(page)
        if text == page.read_text():
            continue
        stale.append(page.name)
        if not arguments.check:
            page.write_text(text)
    if arguments.check and stale:
        sys.exit(f"{', '.join(stale)}: not what is recorded; run tests/bench/report/record.py --write")


if __name__ == "__main__":
    main()
