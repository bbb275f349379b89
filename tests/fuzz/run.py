#!/usr/bin/env python3
"""Runs each fuzzer for a stated number of inputs and prints what became of them, by kind of input.

usage: run.py [--build FOLDER] [--inputs NUMBER] [--seed NUMBER] [TARGET[:NUMBER] ...]

One fuzzer runs on each core. TARGET:NUMBER has its own number of inputs. A target that stands there again runs again, with
other seeds: one that is slow can share the cores with itself.

A finding - a signal, an exception that is no message, a sanitizer's report, more than 20 s or 1 GB - is kept in
FOLDER/findings, named, and makes the exit code 1; the fuzzer goes on with another seed. What helps the next time is
kept in FOLDER/corpus; the small corpus beside this file is what every build replays (tests `fuzz: ...`).
"""

import argparse
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
MOST_ENDS = 40  # of one target by findings: then it stops
SECONDS, MEGABYTES = 20, 1024  # that one input may take

sys.path.insert(0, str(SOURCE / "tests/studies/reading"))
from wrong_studies import wrong_studies  # noqa: E402

# Of each target: the greatest length of an input [bytes], and more seeds.
TARGETS = {
    "study": (12000, ["studies/*/*.toml"]),
    "expression": (400, []),
    "csv": (4000, ["tests/studies/reading/wrong/data/*.csv", "tests/studies/reading/wrong/*.csv"]),
    "matrix": (4000, ["tests/studies/reading/wrong/*.mtx"]),
    "log": (4000, []),
    "result": (60000, []),
}


def words_of(texts):
    """A dictionary for the fuzzer: the words of the seeds."""
    words = {word for text in texts for word in re.findall(rb'[A-Za-z_\[\]]{2,24}(?: = )?', text)}
    words |= {b"nan", b"-inf", b"1e308", b"1e-320", b"-1", b"0x7fffffff", b"9223372036854775807", b"1e999"}
    return "".join(f'"{word.decode()}"\n' for word in sorted(words))


def seeds_for(target, work):
    """One folder of seeds, and the dictionary of their words."""
    longest, patterns = TARGETS[target]
    files = [file for pattern in patterns for file in SOURCE.glob(pattern)]
    files += [file for file in (HERE / "corpus" / target).glob("*")]
    folder = work / "seeds" / target
    folder.mkdir(parents=True, exist_ok=True)
    seeds = [(file.name, file.read_bytes()) for file in sorted(files)]
    if target == "study":
        seeds += [(f"{name}.toml", text.encode()) for name, text in wrong_studies().items()]
    texts = []
    for number, (name, data) in enumerate(seeds):
        if len(data) > longest:
            continue
        (folder / f"{number:04}_{name}").write_bytes(data)
        texts.append(data)
    dictionary = work / f"{target}.words"
    dictionary.write_text(words_of(texts if target in ("study", "csv", "expression") else []))
    return folder, dictionary


def kind_of(report):
    """What a fuzzer's last words call the finding."""
    for pattern in (r"ERROR: libFuzzer: ([a-z-]+)", r"ERROR: AddressSanitizer: ([\w-]+)", r"runtime error: ([^\n]+)",
                    r"ERROR: LeakSanitizer: ([\w ]+)"):
        found = re.search(pattern, report)
        if found:
            return found.group(1)
    return "unknown end"


def place_of(report):
    """The first of our functions in the stack, else the library it ended in."""
    for frame in re.findall(r"#\d+ 0x[0-9a-f]+ in (.+)", report):
        if "/solvers/" in frame or "/studies/" in frame or "/engine/" in frame or "/results/" in frame:
            return re.sub(r"\s+\(BuildId.*", "", frame)
    foreign = re.findall(r"#\d+ 0x[0-9a-f]+\s+\((\S+)\+0x", report)
    return foreign[0] if foreign else "no stack"


def executed(report):
    counts = re.findall(r"stat::number_of_executed_units: (\d+)", report) or re.findall(r"^#(\d+)\s", report, re.M)
    return int(counts[-1]) if counts else 0


def environment():
    quiet = dict(os.environ)
    # Freed memory is kept from use for a while; more of it than several inputs need makes each fork of `result` slow.
    quiet["ASAN_OPTIONS"] = "detect_leaks=0:allocator_may_return_null=1:handle_abort=1:quarantine_size_mb=16"
    quiet["UBSAN_OPTIONS"] = "halt_on_error=1:print_stacktrace=1"
    quiet["OMP_NUM_THREADS"] = "1"
    return quiet


def fuzz(target, inputs, seed, build, seeds, dictionary):
    """Runs one target; returns (inputs, read, refused, {(kind, place): path of an input})."""
    work = build / "fuzz"
    corpus, findings = work / "corpus" / target, work / "findings"
    corpus.mkdir(parents=True, exist_ok=True)
    findings.mkdir(parents=True, exist_ok=True)
    done, read, refused, ends, found = 0, 0, 0, 0, {}
    while done < inputs and ends < MOST_ENDS:
        prefix = f"{findings}/{target}-{seed}-"
        command = [f"{build}/bin/fuzz_{target}", f"-runs={inputs - done}", f"-seed={seed}",
                   f"-rss_limit_mb={MEGABYTES}", f"-timeout={SECONDS}", f"-max_len={TARGETS[target][0]}",
                   f"-dict={dictionary}", "-print_final_stats=1", "-verbosity=1", f"-artifact_prefix={prefix}",
                   str(corpus), str(seeds)]
        ended = subprocess.run(command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        report = ended.stdout.decode(errors="replace")
        if executed(report) == 0:
            sys.exit(f"{command[0]} did not run:\n{report[-2000:]}")
        done += executed(report)
        ends += ended.returncode != 0
        outcomes = re.search(r"outcomes: (\d+) read, (\d+) refused", report)
        if outcomes:
            read, refused = read + int(outcomes.group(1)), refused + int(outcomes.group(2))
        if ended.returncode != 0:
            kept = sorted(findings.glob(f"{target}-{seed}-*"))
            what = kind_of(report), place_of(report)
            if what not in found:
                found[what] = kept[0] if kept else None
                print(f"  {target}: {what[0]} in {what[1]}: {found[what]}", flush=True)
                (findings / f"{target}-{seed}.report").write_text(report[-20000:])
        seed += 1
    return done, read, refused, found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", type=Path, default=SOURCE / "build/asan")
    parser.add_argument("--inputs", type=int, default=20000, help="for each target")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("targets", nargs="*", default=list(TARGETS), metavar="TARGET")
    options = parser.parse_args()
    row_format = "{:12} {:9} inputs {:9} read {:9} refused {:4} findings {:6.0f} s"

    targets = [asked.partition(":")[::2] for asked in options.targets]
    seeds = {target: seeds_for(target, options.build / "fuzz") for target, _ in targets}
    many = 1000  # seeds: more than one run takes

    def row_of(place):
        target, number = targets[place]
        seed = options.seed + many * sum(before == target for before, _ in targets[:place])
        start = time.monotonic()
        done, read, refused, found = fuzz(target, int(number or options.inputs), seed, options.build, *seeds[target])
        return target, done, read, refused, len(found), time.monotonic() - start

    rows = []
    with ThreadPoolExecutor(os.cpu_count()) as cores:
        for row in cores.map(row_of, range(len(targets))):
            rows.append(row)
            print(row_format.format(*row), flush=True)
    total = [sum(row[i] for row in rows) for i in range(1, 6)]
    print(row_format.format("all", *total))
    return 1 if total[3] else 0


if __name__ == "__main__":
    sys.exit(main())
