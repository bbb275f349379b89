#!/usr/bin/env python3
"""Tells which lines of `solvers` and `engine` the tests have run, after a run of them in a build of preset `asan`.

usage: coverage.py [--build FOLDER] [--least PERCENT]

Prints the table of tests/README.md, by folder, and writes each run of lines that were not reached to
FOLDER/not_covered.txt. Ends with 1 where `solvers` or `engine` has less than PERCENT.
"""

import argparse
import json
import os
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent.parent
ROOMS = "solvers", "engine"


def lines_of(build):
    """{file: {line: how often}} by gcovr; a line of a template is covered if one of its instances is."""
    report = build.resolve() / "lines.json"
    filters = [word for room in ROOMS for word in ("--filter", f"{SOURCE}/{room}/")]
    # In the folder of the build, as llvm-cov leaves its files where it runs.
    subprocess.run(["gcovr", "--root", str(SOURCE), *filters, "--gcov-executable", "llvm-cov-14 gcov", "--json",
                    str(report), "-j", str(os.cpu_count()), *ROOMS], check=True, cwd=build)
    counts = defaultdict(lambda: defaultdict(int))
    for file in json.loads(report.read_text())["files"]:
        for line in file["lines"]:
            if not line["gcovr/noncode"]:
                counts[file["file"]][line["line_number"]] += line["count"]
    return counts


def by_folder(counts):
    """{folder: [lines, covered]}: one folder below the room, and the rooms themselves."""
    sums = defaultdict(lambda: [0, 0])
    for file, lines in counts.items():
        parts = Path(file).parts
        for folder in {parts[0], "/".join(parts[: min(2, len(parts) - 1)])}:
            sums[folder][0] += len(lines)
            sums[folder][1] += sum(count > 0 for count in lines.values())
    return sums


def runs_of(lines):
    """Missed lines that follow each other among those with code, as (first, last)."""
    runs, is_open = [], False
    for number in sorted(lines):
        if lines[number] > 0:
            is_open = False
        elif is_open:
            runs[-1][1] = number
        else:
            runs.append([number, number])
            is_open = True
    return runs


def write_missed(counts, path):
    with path.open("w") as out:
        for file in sorted(counts):
            text = (SOURCE / file).read_text().splitlines()
            for first, last in runs_of(counts[file]):
                print(f"{file}:{first}-{last}: {text[first - 1].strip()}", file=out)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", type=Path, default=SOURCE / "build/asan")
    parser.add_argument("--least", type=float, default=95.0, help="of each room [%%]")
    options = parser.parse_args()
    counts = lines_of(options.build)
    sums = by_folder(counts)
    print("| folder | lines | covered | % |\n|---|---|---|---|")
    for folder in sorted(sums):
        lines, covered = sums[folder]
        print(f"| `{folder}` | {lines:,} | {covered:,} | {100 * covered / lines:.1f} |")
    write_missed(counts, options.build / "not_covered.txt")
    print(f"each line not reached: {options.build / 'not_covered.txt'}")
    low = [room for room in ROOMS if 100 * sums[room][1] < options.least * sums[room][0]]
    if low:
        print(f"below {options.least} %: {', '.join(low)}", file=sys.stderr)
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
