"""A disk that is really full, a folder that cannot be written, is not there or is no folder: an error that says so
(code 6), nothing lost, and the same command ends well when there is room again.

usage: disks.py FRAHM SOURCE_DIR
"""

import contextlib
import errno
import os
import subprocess
import time

from faulty_runs import OUTPUT, Expected, Place, explains, main, sweep_study, tiles_of_log

LOG_SIZE = 24 * 129 * 8 * 4  # bytes of the values in the logs


@contextlib.contextmanager
def small_disk(bench, name, size):
    """A disk in memory of so many bytes, at a folder of its own; None where mounting is not allowed."""
    folder = os.path.join(bench.folder, name)
    os.makedirs(folder)
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "frahm", folder], capture_output=True)
    if mounted.returncode != 0:
        yield None
        return
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)


def remount(folder, options):
    subprocess.run(["mount", "-o", f"remount,{options}", folder], check=True)


def check_full_disk(bench, study, expected):
    """Full while tiles are computed, or while the file is assembled; with an earlier file there or not."""
    full = 0
    for kilobytes in range(8, 2 * LOG_SIZE // 1024, 8):
        with small_disk(bench, f"full{kilobytes}", f"{kilobytes}k") as folder:
            if folder is None:
                print("SKIPPED: this user may not mount a disk in memory, so none was really full", flush=True)
                return
            place = Place(bench, folder, study)
            outcome = place.run("--threads", "2", "--progress", "none")
            if outcome.code == 0:
                break
            full += 1
            assert outcome.code == 6 and explains(outcome, errno.ENOSPC), f"{kilobytes} kB: {outcome}"
            assert OUTPUT not in place.names(), f"{kilobytes} kB: {place.names()}"
            tiles = sum(len(tiles_of_log(place.read(log))) for log in place.logs())
            remount(folder, "size=20m")
            expected.check_resume(place, f"{kilobytes} kB: {tiles} tiles kept", "--threads", "2")
    assert full > 10, full
    print(f"{full} disks that were full", flush=True)


def check_read_only(bench, study, expected):
    """A finished map in a folder that cannot be written is told; an unfinished one cannot go on."""
    with small_disk(bench, "read_only", "20m") as folder:
        if folder is None:
            print("SKIPPED: this user may not mount a disk, so none was read-only", flush=True)
            return
        place = Place(bench, folder, study)
        remount(folder, "ro")
        outcome = place.run()
        assert outcome.code == 6 and explains(outcome, errno.EROFS), outcome
        remount(folder, "rw")
        half = place.run("--shard", "0/2", "--progress", "none")
        assert half.code == 0, half
        remount(folder, "ro")
        outcome = place.run()
        assert outcome.code == 6 and explains(outcome, errno.EROFS), outcome
        assert place.call("status", OUTPUT).code == 0
        outcome = place.call("merge", OUTPUT)
        assert outcome.code == 6 and OUTPUT in outcome.err, outcome
        remount(folder, "rw")
        expected.check_resume(place, "writable again")
        remount(folder, "ro")
        outcome = place.run()
        assert outcome.code == 0 and "computed already" in outcome.out, outcome
        outcome = place.run("--fresh")
        assert outcome.code == 6 and explains(outcome, errno.EROFS), outcome
        expected.check_file(place, "read-only")


def check_places(bench, study, expected):
    """The result's folder is not there, or goes away; the output is a folder or a pipe."""
    place = bench.place(study)
    for output, reason in (("nowhere/map.h5", errno.ENOENT), ("study.toml/map.h5", errno.ENOTDIR)):
        outcome = place.call("run", "study.toml", "-o", output)
        assert outcome.code == 6 and output.split("/")[0] in outcome.err, outcome
        assert os.strerror(reason) in outcome.err, outcome
    os.mkdir(place.path("folder.h5"))
    os.mkfifo(place.path("pipe.h5"))
    for output in "folder.h5", "pipe.h5":
        for options in (), ("--fresh",):
            outcome = place.call("run", "study.toml", "-o", output, *options)
            assert outcome.code == 6 and output in outcome.err, outcome
    name = "x" * 250 + ".h5"
    outcome = place.call("run", "study.toml", "-o", name)
    assert outcome.code == 6 and os.strerror(errno.ENAMETOOLONG) in outcome.err, outcome
    assert place.names() == ["folder.h5", "pipe.h5"], place.names()

    place = bench.place(study)
    os.mkdir(place.path("gone"))
    process = place.start("run", "study.toml", "-o", "gone/map.h5", "--threads", "1", "--progress", "none",
                          environment=place.environment())
    while process.poll() is None and not os.listdir(place.path("gone")):
        time.sleep(0.001)
    os.rename(place.path("gone"), place.path("moved"))
    out, err = process.communicate(timeout=60)
    assert process.returncode in (0, 6), err
    if process.returncode == 6:
        assert "gone" in err and os.strerror(errno.ENOENT) in err, err
    os.rename(place.path("moved"), place.path("gone"))
    outcome = place.call("run", "study.toml", "-o", "gone/map.h5")
    assert outcome.code == 0, outcome
    assert os.listdir(place.path("gone")) == [OUTPUT]


def drill(bench):
    study = sweep_study(bench.source)
    place = bench.place(study)
    expected = Expected(place)
    check_full_disk(bench, study, expected)
    check_read_only(bench, study, expected)
    check_places(bench, study, expected)
    print("read-only, missing and impossible places are told")


if __name__ == "__main__":
    main(drill)
