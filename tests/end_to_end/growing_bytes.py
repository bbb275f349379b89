"""A map that grows has the same bytes whoever computes it and however often they are killed; one that grows in
its place is the earlier one until it is the new one, whole.

usage: growing_bytes.py FRAHM SOURCE_DIR
"""

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from same_bytes import raw_bytes

KILLS = 10 if os.environ.get("FRAHM_FAULTS") == "all" else 3
SHARDS = 5
LONGEST = 120  # seconds, of any run


class Growing:
    def __init__(self, program, source, folder):
        self.program, self.folder = program, folder
        self.study, self.earlier = os.path.join(folder, "map.toml"), os.path.join(folder, "earlier.h5")
        with open(os.path.join(source, "studies", "classics", "den_hartog.toml")) as file:
            text = file.read()
        assert text.count("points = 481") == 1 and text.count("points = 25\n") == 1
        coarse = os.path.join(folder, "coarse.toml")
        with open(coarse, "w") as file:
            file.write(text)
        with open(self.study, "w") as file:
            file.write(text.replace("points = 481", "points = 961").replace("points = 25\n", "points = 49\n"))
        self.finish("run", coarse, "-o", self.earlier)
        self.names = sorted(os.listdir(folder))

    def start(self, *arguments):
        return subprocess.Popen([self.program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def finish(self, *arguments):
        process = self.start(*arguments)
        out, err = process.communicate(timeout=LONGEST)
        assert process.returncode == 0, f"{arguments}: code {process.returncode}: {err}"
        return out

    def grow(self, output, source, *options):
        return ("run", self.study, "-o", output, "--from", source, "--progress", "none", *options)

    def taken(self, output):
        """The bytes of a result, which is removed; nothing else may be left."""
        assert sorted(os.listdir(self.folder)) == sorted([*self.names, os.path.basename(output)]), os.listdir(self.folder)
        found = raw_bytes(output)
        os.remove(output)
        return found

    def killed(self, expected, output, how, in_place=False):
        """Started again and again, each time killed at a random moment; then to the end. Where a run was done before
        the first kill, all begins anew with kills that come twice as early."""
        longest, stopped = 0.4, 0
        while stopped == 0:
            if in_place:
                shutil.copy(self.earlier, output)
            elif os.path.exists(output):
                os.remove(output)
            stopped = self.stopped_runs(expected, output, output if in_place else self.earlier, how, longest)
            longest /= 2
        self.finish(*self.grow(output, output if in_place else self.earlier))

    def stopped_runs(self, expected, output, source, how, longest):
        """How many of the runs were killed before they were done; after one that was done there is no other."""
        before = raw_bytes(source)
        stopped = 0
        for _ in range(KILLS):
            process = self.start(*self.grow(output, source, "--threads", "2"))
            time.sleep(random.uniform(0.0, longest))
            process.send_signal(how)
            process.communicate(timeout=LONGEST)
            stopped += process.returncode != 0
            # Whatever was killed when: each file is whole, the earlier one is what it was, or has grown.
            assert raw_bytes(source) in ([before, expected] if source == output else [before]), "a half file"
            if os.path.exists(output) and raw_bytes(output) == expected:
                break
        return stopped


def check(program, source, folder):
    growing = Growing(program, source, folder)
    output = os.path.join(folder, "map.h5")
    table = growing.finish(*growing.grow(output, growing.earlier, "--threads", "1"))
    counted = re.search(r"reused +(\d+) points of .*, (\d+) computed", table)
    known = 6 * 25 * 481  # all: what grows in its place must have every point
    assert [int(n) for n in counted.groups()] == [known, 6 * 49 * 961 - known], counted.groups()
    one = growing.taken(output)
    assert len(one) > 10 and one["main_peak"][1] == (6, 49, 961)
    for threads in "2", "5":
        growing.finish(*growing.grow(output, growing.earlier, "--threads", threads))
        assert growing.taken(output) == one, threads

    for shard in range(SHARDS):
        growing.finish(*growing.grow(output, growing.earlier, "--shard", f"{shard}/{SHARDS}"))
    growing.finish("merge", output)
    assert growing.taken(output) == one, "shards"

    for how in signal.SIGKILL, signal.SIGTERM:
        growing.killed(one, output, how)
        assert growing.taken(output) == one, how

    for how in signal.SIGKILL, signal.SIGTERM:
        growing.killed(one, output, how, in_place=True)
        assert growing.taken(output) == one, how


def main():
    random.seed(3)
    program, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        check(program, source, folder)
    print("a map that grows on 1, 2 and 5 threads, by shards, killed, and in its place: the same bytes")


if __name__ == "__main__":
    main()
