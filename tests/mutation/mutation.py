#!/usr/bin/env python3
"""Plants small faults in shaders and engine, one at a time, and runs the tests that should notice.

    tests/mutation/mutation.py BUILD [--only PATTERN] [--engine] [--jobs N] [--anew] [--work FOLDER] [--report FILE]
    tests/mutation/mutation.py BUILD --suite [--jobs N]
    tests/mutation/mutation.py BUILD --check

BUILD is a Release build of this tree. The faults are those of faults.txt. Faults in shaders need no build: a folder that
holds the faulty file lies over the embedded ones (HELIOGRAPH_SHADER_DIR). Faults in the engine are planted in a copy of
the tree with a build of its own, only with --engine. A test is run without any fault first: it must pass, and a fault
that makes it take ten times as long, and no less than a minute, has hung it and counts as caught. Results are kept in
FOLDER/results.json, and what is there is not run again but with --anew. Exit 1 where a fault survives that
`survivors.txt` does not explain. The test suite plants the twenty faults of sample.txt (--suite), in which the case that
notices is named alone; that it passes without the fault is an entry of the suite already.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SEPARATOR = "  =>  "
LIMIT_SECONDS = 600  # of one test without a fault


class Fault:
    def __init__(self, section, text, replacement):
        self.file, self.tests, self.is_built = section
        self.text, self.replacement = text, replacement
        self.name = f"{self.file}: {' '.join(text.split())}{SEPARATOR}{' '.join(replacement.split())}"

    def is_shader(self):
        """Whether it is planted without a build."""
        return not self.is_built and self.file.endswith((".glsl", ".comp"))

    def planted(self):
        source = (ROOT / self.file).read_text()
        if source.count(self.text) != 1:
            raise ValueError(f"{self.name}: the text is in the file {source.count(self.text)} times, not once")
        return source.replace(self.text, self.replacement)


def read_catalogue(path):
    """Faults may go over several lines: one ends where the next has a separator or a section begins."""
    faults, section, pending = [], None, []

    def finish():
        joined = "\n".join(pending)
        pending.clear()
        if not joined.strip():
            return
        text, separator, replacement = joined.partition(SEPARATOR)
        if not separator or section is None:
            raise ValueError(f"{path}: no fault: {joined!r}")
        faults.append(Fault(section, text.strip(), replacement.strip()))

    for line in path.read_text().splitlines():
        head = re.fullmatch(r"\[(\S+) \| (.+)\]", line)
        if head:
            finish()
            tests = head[2].removeprefix("build: ")
            section = head[1], [test.split(" ", 1) for test in tests.split(" ; ")], tests != head[2]
        elif line.startswith("#") and section is None or not line.strip():
            finish()
        else:
            begins = SEPARATOR in "\n".join(pending) and not line.startswith("    ")
            if begins:
                finish()
            pending.append(line)
    finish()
    return faults


def executable(build, name):
    found = [path for path in (build / "tests").rglob(name) if path.is_file() and os.access(path, os.X_OK)]
    return found[0] if found else None


def run_test(build, test, environment, limit=LIMIT_SECONDS):
    """What a test did: "passed", "failed", "hung" or "missing", and the first failed case."""
    program = executable(build, test[0])
    if program is None:
        return "missing", ""
    command = [program] + ([f"--gtest_filter={test[1]}"] if len(test) > 1 else [])
    try:
        done = subprocess.run(command + ["--gtest_fail_fast"], env=environment, cwd=build, capture_output=True,
                              text=True, errors="replace", timeout=limit)
    except subprocess.TimeoutExpired:
        return "hung", ""
    if done.returncode == 0:
        if re.search(r"Running 0 tests|\[  SKIPPED \]", done.stdout):
            return "missing", "the filter finds no case, or one was skipped"
        return "passed", ""
    case = re.search(r"\[  FAILED  \] (\S+)", done.stdout)
    return "failed", case[1] if case else f"exit {done.returncode}"


class NotRunnable(Exception):
    """A test is not built, or does not pass without any fault."""


class CleanRuns:
    """What each test does without any fault, kept with the results: each is run once."""

    def __init__(self, results):
        self.known = results.setdefault("clean", {})
        self.lock = threading.Lock()

    @staticmethod
    def key(build, test):
        return f"{'engine: ' if build.name == 'engine' else ''}{' '.join(test)}"

    def knows(self, build, test):
        return self.known.get(self.key(build, test), {}).get("state") == "passed"

    def limit(self, build, test, environment):
        """Seconds after which a fault has hung the test. Throws where the test does not pass without one."""
        key = self.key(build, test)
        with self.lock:
            if not self.knows(build, test):
                started = time.monotonic()
                state, _ = run_test(build, test, environment())
                self.known[key] = {"state": state, "seconds": round(time.monotonic() - started, 1)}
        if self.known[key]["state"] != "passed":
            raise NotRunnable(f"without any fault the test '{key}' is {self.known[key]['state']}")
        return max(60.0, 10 * self.known[key]["seconds"])


def judge(build, tests, environment, limit_of):
    """What the first test that notices says: those after it are not run, nor without the fault."""
    for test in tests:
        state, detail = run_test(build, test, environment, limit_of(test))
        if state != "passed":
            caught = state in ("failed", "hung")
            return {"state": "caught" if caught else state, "by": test[0], "case": "hung" if state == "hung" else detail}
    return {"state": "survived"}


def shader_environment(work, fault, name=""):
    """Of a process that takes the fault's file, none if there is no fault, and keeps its compiled kernels apart: faulty
    ones do not push out good ones."""
    mine = work / f"worker-{name or threading.current_thread().name.rpartition('_')[2]}"
    overlay = mine / "overlay"
    shutil.rmtree(overlay, ignore_errors=True)
    overlay.mkdir(parents=True)
    if fault is not None:
        (overlay / fault.file).parent.mkdir(parents=True)
        (overlay / fault.file).write_text(fault.planted())
    return dict(os.environ, HELIOGRAPH_SHADER_DIR=str(overlay), XDG_CACHE_HOME=str(mine / "cache"),
                MESA_SHADER_CACHE_DIR=str(mine / "mesa"))


class EngineCopy:
    """A copy of the tree, built once, in which one file at a time is faulty."""

    def __init__(self, build, work):
        self.source, self.build = work / "tree", work / "engine"
        self.fresh = True
        self.lock = threading.Lock()

    def prepare(self, targets):
        self.source.mkdir(parents=True, exist_ok=True)
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], check=True, capture_output=True, text=True)
        for name in filter(None, listed.stdout.split("\0")):
            copy = self.source / name
            copy.parent.mkdir(parents=True, exist_ok=True)
            # Times of files that are the same stay, so that a copy of an earlier run is not built anew.
            if not copy.exists() or copy.read_bytes() != (ROOT / name).read_bytes():
                shutil.copy(ROOT / name, copy)
        subprocess.run(["cmake", "-S", self.source, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        f"-DHELIOGRAPH_SHARED_DIR={ROOT.parent / 'shared'}"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.make(targets)

    def make(self, targets):
        return subprocess.run(["cmake", "--build", self.build, "-j2", "--target", *targets], capture_output=True,
                              text=True)

    def run(self, fault, environment, clean):
        targets = sorted({test[0] for test in fault.tests})
        with self.lock:
            if self.fresh:
                self.prepare(targets)
                self.fresh = False
            if not all(clean.knows(self.build, test) for test in fault.tests):
                self.make(targets)
            limits = {" ".join(test): clean.limit(self.build, test, lambda: environment) for test in fault.tests}
            path = self.source / fault.file
            good = path.read_text()
            path.write_text(fault.planted())
            try:
                made = self.make(targets)
                if made.returncode != 0:
                    return {"state": "does not compile", "case": made.stdout[-300:]}
                return judge(self.build, fault.tests, environment, lambda test: limits[" ".join(test)])
            finally:
                path.write_text(good)


def read_explained(path):
    """Survivors that are known: "NAME" lines, each followed by indented lines that say why."""
    return {line for line in path.read_text().splitlines() if line and not line.startswith((" ", "#"))}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="", help="regular expression of the faults' names")
    parser.add_argument("--suite", action="store_true", help="the faults of sample.txt, anew and without clean runs")
    parser.add_argument("--jobs", type=int, default=1, help="faults in shaders to run side by side")
    parser.add_argument("--anew", action="store_true", help="forget earlier results")
    parser.add_argument("--engine", action="store_true", help="also faults that need a build")
    parser.add_argument("--work", type=pathlib.Path, help="default BUILD/mutation")
    parser.add_argument("--report", type=pathlib.Path, help="Markdown")
    parser.add_argument("--check", action="store_true", help="only whether every fault's text is in its file once")
    arguments = parser.parse_args()
    faults = read_catalogue(HERE / "faults.txt")
    names = [fault.name for fault in faults]
    assert len(set(names)) == len(names), "a fault is there twice"
    sample = read_catalogue(HERE / "sample.txt")
    for fault in sample:
        if fault.name not in names:
            sys.exit(f"sample.txt: faults.txt has no '{fault.name}'")
    stale = []
    for fault in faults:
        try:
            fault.planted()
        except (ValueError, FileNotFoundError) as error:
            stale.append(str(error))
    faults = [fault for fault in faults if not any(message.startswith(fault.name) for message in stale)]
    explained = read_explained(HERE / "survivors.txt")
    for name in explained - set(names):
        sys.exit(f"survivors.txt: no fault is called '{name}'")
    if arguments.check:
        print("\n".join([f"{len(faults)} faults whose text is in their file once", *stale]))
        sys.exit(1 if stale else 0)
    build = arguments.build.resolve()
    work = (arguments.work or build / ("mutation-suite" if arguments.suite else "mutation")).resolve()
    work.mkdir(parents=True, exist_ok=True)
    store = work / "results.json"
    anew = arguments.anew or arguments.suite
    results = json.loads(store.read_text()) if store.exists() and not anew else {}

    chosen = [fault for fault in (sample if arguments.suite else faults) if re.search(arguments.only, fault.name)]
    if not arguments.engine:
        chosen = [fault for fault in chosen if fault.is_shader()]
    clean = CleanRuns(results)
    engine = EngineCopy(build, work)
    lock, stopped = threading.Lock(), set()
    waiting = [fault for fault in chosen if fault.name not in results]

    def run_fault(fault):
        started = time.monotonic()
        try:
            if fault.is_shader():
                def limit_of(test):
                    if arguments.suite:
                        return LIMIT_SECONDS
                    return clean.limit(build, test, lambda: shader_environment(work, None, "clean"))

                result = judge(build, fault.tests, shader_environment(work, fault), limit_of)
            else:
                result = engine.run(fault, shader_environment(work, None), clean)
        except NotRunnable as error:
            with lock:
                stopped.add(str(error))
            return
        result["seconds"] = round(time.monotonic() - started, 1)
        with lock:
            results[fault.name] = result
            store.with_suffix(".partial").write_text(json.dumps(results, indent=1))
            store.with_suffix(".partial").replace(store)
            done = sum(one.name in results for one in chosen)
            print(f"{done}/{len(chosen)} {result['state']:9} {result['seconds']:6.1f} s  {fault.name[:110]}", flush=True)

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for finished in concurrent.futures.as_completed([pool.submit(run_fault, fault) for fault in waiting]):
            finished.result()

    run = [fault for fault in chosen if fault.name in results]
    caught = [fault for fault in run if results[fault.name]["state"] == "caught"]
    left = [fault for fault in run if results[fault.name]["state"] != "caught"]
    print(f"{len(caught)} of {len(run)} faults caught ({100 * len(caught) / max(len(run), 1):.1f} %)")
    for fault in left:
        print(f"  {results[fault.name]['state']}{' (explained)' if fault.name in explained else ''}: {fault.name}")
    if arguments.report:
        lines = ["| file | faults | run | caught |", "|---|---|---|---|"]
        for file in dict.fromkeys(fault.file for fault in faults):
            counts = [sum(fault.file == file for fault in some) for some in (faults, run, caught)]
            lines.append(f"| {file} | {' | '.join(map(str, counts))} |")
        lines.append(f"| all | {len(faults)} | {len(run)} | {len(caught)} |")
        arguments.report.write_text("\n".join(lines) + "\n")
    for message in stale:
        print(f"  not run, mend the catalogue: {message}")
    for message in sorted(stopped):
        print(f"  not run: {message}")
    if stale or stopped or any(fault.name not in explained for fault in left):
        sys.exit(1)


if __name__ == "__main__":
    main()
