"""Runs of the program with faults on the way, and what must hold after each.

Every process has a time limit: a hang is a failure.
"""

import concurrent.futures
import contextlib
import dataclasses
import errno
import itertools
import json
import os
import re
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "end_to_end"))
from same_bytes import raw_bytes  # noqa: E402

TIME_LIMIT = 60.0  # s of any one process; they take a tenth of a second
OUTPUT = "map.h5"
HEADER_SIZE, RECORD_HEAD = 256, struct.Struct("<4sIQQQ")  # of a shard log: engine/log_format.hpp


def sweep_study(source):
    """24 tiles of 129 points, and an orbit."""
    with open(os.path.join(source, "studies", "classics", "den_hartog.toml")) as file:
        text = file.read()
    for old, new in (("values = [0, 0.02, 0.05, 0.1, 0.2, 0.5]", "values = [0.02, 0.1]"),
                     ("points = 25", "points = 12"), ("points = 481", "points = 129")):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text + """
[output]
quantities = ["main_peak", "friction_stops", "status", "residual"]
orbits = [{ r = 0.9, f = 0.3272727272727272, zeta = 0.1 }]
"""


def larger_sweep(source):
    """About a second of one processor, in 300 tiles: every orbit by shooting."""
    with open(os.path.join(source, "studies", "classics", "den_hartog.toml")) as file:
        return file.read().replace("points = 25", "points = 50") + '\n[output]\npath = "general"\n'


def tuning_study(source):
    """The starts of a tuning are its tiles."""
    with open(os.path.join(source, "studies", "tuning", "tune_h2_force.toml")) as file:
        text = re.sub(r"(?m)^start .*\n", "", file.read())
    assert text.count("[tune]\n") == 1
    return text.replace("[tune]\n", "[tune]\nstart = 4\n")


@dataclasses.dataclass
class Outcome:
    code: int
    out: str
    err: str

    def __str__(self):
        return f"code {self.code}\n{self.out}{self.err}"


@dataclasses.dataclass
class Call:
    number: int
    name: str
    offset: int
    bytes: int
    result: str
    path: str


@dataclasses.dataclass
class Fault:
    """What the shim does at call `at` of those it counts."""

    at: int = 0
    do: str = ""
    error: int = 0
    count: str = "changes"

    def __str__(self):
        reason = f" {errno.errorcode[self.error]}" if self.error else ""
        return f"{self.do}{reason} at call {self.at} ({self.count})"


class Bench:
    """The program, the shims, and a folder in which each case has its own."""

    def __init__(self, program, source, folder):
        self.program, self.source, self.folder = program, source, os.path.realpath(folder)
        self.shims = os.path.dirname(os.path.abspath(program))
        self.cases = itertools.count()

    def place(self, study):
        return Place(self, os.path.join(self.folder, f"case{next(self.cases)}"), study)


class Place:
    """A folder with a study, in which runs leave their files; whatever tells of the runs lies outside."""

    def __init__(self, bench, folder, study):
        self.bench, self.folder, self.calls_file = bench, folder, folder + ".calls"
        os.makedirs(folder, exist_ok=True)
        self.write("study.toml", study.encode())

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def names(self):
        return sorted(name for name in os.listdir(self.folder) if name != "study.toml")

    def logs(self):
        return [name for name in self.names() if name.endswith(".frahm-log")]

    def environment(self, fault=None, shim="fault_shim.so"):
        environment = dict(os.environ)
        if fault is None:
            return environment
        with contextlib.suppress(FileNotFoundError):
            os.remove(self.calls_file)
        environment.update(LD_PRELOAD=os.path.join(self.bench.shims, shim), FAULT_FOLDER=self.folder,
                           FAULT_LOG=self.calls_file, FAULT_COUNT=fault.count, FAULT_AT=str(fault.at),
                           FAULT_DO=fault.do, FAULT_ERRNO=str(fault.error))
        return environment

    def start(self, *arguments, environment=None, program=None, **how):
        """The program (or another) with its standard streams in pipes, its folder the working directory, in a group of its own."""
        how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL} | how
        return subprocess.Popen([program or self.bench.program, *arguments], cwd=self.folder, text=True, errors="replace",
                                start_new_session=True, env=environment or dict(os.environ), **how)

    def call(self, *arguments, fault=None):
        return ended(self.start(*arguments, environment=self.environment(fault)))

    def run(self, *options, fault=None):
        return self.call("run", "study.toml", "-o", OUTPUT, *options, fault=fault)

    def calls(self):
        """What the shim told of the last run."""
        with open(self.calls_file) as file:
            lines = [line.rstrip("\n").split(" ", 5) for line in file]
        return sorted((Call(int(number), name, int(offset), int(size), result, path)
                       for number, name, offset, size, result, path in lines), key=lambda call: call.number)

    def clear(self):
        for name in self.names():
            os.remove(self.path(name))


def ended(process, input=None):
    try:
        out, err = process.communicate(input, timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired:
        process.kill()
        out, err = process.communicate()
        raise AssertionError(f"hung for {TIME_LIMIT} s: {process.args}\n{out}{err}") from None
    return Outcome(process.returncode, out or "", err or "")


def whole_appends(calls):
    """The tiles whose records reached a shard log whole, by what the shim has seen."""
    return sum(call.name == "pwrite" and call.path.endswith(".frahm-log") and call.offset >= HEADER_SIZE
               and call.result in ("done", "killed_after") for call in calls)


def tiles_of_log(data):
    """The tiles of the whole records of a shard log, by its bytes."""
    tiles, at = [], HEADER_SIZE
    while at + RECORD_HEAD.size <= len(data):
        magic, _, _, tile, length = RECORD_HEAD.unpack_from(data, at)
        at += RECORD_HEAD.size + length + 4
        if magic != b"TILE" or at > len(data):
            break
        tiles.append(tile)
    return tiles


def resumed_points(outcome):
    """How many points a run with --progress json took from the logs."""
    lines = [json.loads(line) for line in outcome.err.splitlines() if line.startswith("{")]
    return lines[-1]["resumed"] if lines else None


class Expected:
    """An uninterrupted run of a study: its bytes, its tiles and its points."""

    def __init__(self, place):
        outcome = place.run("--threads", "1", "--progress", "json")
        assert outcome.code == 0, outcome
        assert place.names() == [OUTPUT], place.names()
        self.bytes = raw_bytes(place.path(OUTPUT))
        self.points = [json.loads(line) for line in outcome.err.splitlines() if line.startswith("{")][-1]["points"]

    def check_file(self, place, case):
        found = raw_bytes(place.path(OUTPUT))
        differing = [name for name in found.keys() | self.bytes.keys() if found.get(name) != self.bytes.get(name)]
        assert not differing, f"{case}: other bytes in {differing}"

    def check_resume(self, place, case, *options):
        """The same command again ends well, leaves the file alone and the bytes of the uninterrupted run."""
        outcome = place.run("--progress", "json", *options)
        assert outcome.code == 0, f"{case}: the resumed run: {outcome}"
        assert place.names() == [OUTPUT], f"{case}: left over: {place.names()}"
        self.check_file(place, case)
        return outcome


def explains(outcome, reason):
    """Whether a message names a file and the system's reason."""
    words = os.strerror(reason)
    return any(words in line and re.search(r"map\.h5|study\.toml|case\d|cannot (sync|list|open) ", line) is not None
               for line in outcome.err.splitlines())


def in_parallel(work, items, at_once=os.cpu_count()):
    """work(item) for each, so many at once; the first failure is raised when all have ended."""
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        return [future.result() for future in [pool.submit(work, item) for item in items]]


EVERYTHING = os.environ.get("FRAHM_FAULTS") == "all"  # the whole drill, which takes longer


def sampled(items, most):
    """At most so many of the items, evenly over all."""
    items = list(items)
    if EVERYTHING or len(items) <= most:
        return items
    return [items[round(i * (len(items) - 1) / (most - 1))] for i in range(most)]


def main(drill):
    """drill(bench) in a temporary folder; usage: DRILL.py FRAHM SOURCE_DIR."""
    program, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        drill(Bench(os.path.abspath(program), source, folder))
