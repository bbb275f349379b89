"""Power failures at calls that change a file: what was not synced is gone, and the same command goes on from the rest.

A disk may have kept more than what was synced. Two extremes are tried: nothing else survives; and all names do, with
zeros for the bytes that were not synced.

usage: power_failures.py FRAHM SOURCE_DIR
"""

import os
import shutil

from faulty_runs import (EVERYTHING, OUTPUT, Expected, Fault, ended, in_parallel, larger_sweep, main, resumed_points, sampled,
                         sweep_study, tiles_of_log)

FAILURES = 60 if EVERYTHING else 12  # of a small run, spread over its calls
LATER = 10 if EVERYTHING else 2      # of a run of a second, which syncs as it goes
STUDY = "study.toml"


class Disk:
    """What the shim has kept of the syncs in a place."""

    def __init__(self, place):
        self.place, self.kept = place, place.folder + ".synced"
        os.makedirs(self.kept)

    def names(self):
        """Of the last sync of the folder: the inode of each name."""
        try:
            with open(os.path.join(self.kept, "names")) as file:
                return {name: int(inode) for inode, name in (line.rstrip("\n").split(" ", 1) for line in file)}
        except FileNotFoundError:
            return {}

    def bytes(self, inode):
        try:
            with open(os.path.join(self.kept, str(inode)), "rb") as file:
                return file.read()
        except FileNotFoundError:
            return b""

    def only_synced(self):
        return {name: self.bytes(inode) for name, inode in self.names().items() if name != STUDY}

    def all_names(self):
        files = {}
        for name in self.place.names():
            status = os.stat(self.place.path(name))
            files[name] = self.bytes(status.st_ino)[:status.st_size].ljust(status.st_size, b"\0")
        return files


def power_fails(bench, study, at):
    """A run that ends at this call; what two disks have then. Nothing if the run had fewer calls."""
    place = bench.place(study)
    disk = Disk(place)
    environment = dict(place.environment(Fault(at, "kill_before")), FAULT_SYNCED=disk.kept)
    outcome = ended(place.start("run", STUDY, "-o", OUTPUT, "--threads", "1", "--progress", "none", environment=environment))
    if outcome.code == 0:
        return None
    left = {"only what was synced": disk.only_synced(), "names, and zeros": disk.all_names()}
    shutil.rmtree(disk.kept)
    return left


def go_on(bench, study, expected, files, case):
    place = bench.place(study)
    for name, data in files.items():
        place.write(name, data)
    tiles = {tile for name, data in files.items() if name.endswith(".frahm-log") for tile in tiles_of_log(data)}
    is_made = OUTPUT in files
    resumed = resumed_points(expected.check_resume(place, case))
    if not is_made:
        assert (resumed or 0) >= len(tiles), f"{case}: {len(tiles)} tiles were synced, {resumed} points were taken up"
    return len(tiles)


def fail_at(bench, study, expected, calls):
    def fail(at):
        left = power_fails(bench, study, at) or {}
        return max((go_on(bench, study, expected, files, f"power failure at call {at}: {which}")
                    for which, files in left.items()), default=0)

    return in_parallel(fail, calls)


def all_calls(bench, study):
    place = bench.place(study)
    assert ended(place.start("run", STUDY, "-o", OUTPUT, "--threads", "1", "--progress", "none",
                             environment=place.environment(Fault()))).code == 0
    return [call.number for call in place.calls()]


def drill(bench):
    study = sweep_study(bench.source)
    calls = sampled(all_calls(bench, study), FAILURES)
    synced = fail_at(bench, study, Expected(bench.place(study)), calls)
    assert max(synced) == 24, synced  # all tiles, while the file was made
    study = larger_sweep(bench.source)
    calls = sampled(all_calls(bench, study), LATER + 2)[1:-1]
    synced += fail_at(bench, study, Expected(bench.place(study)), calls)
    print(f"{len(synced)} power failures, {sum(count > 0 for count in synced)} of them with tiles on the disk", flush=True)


if __name__ == "__main__":
    main(drill)
