"""Files that are not ours stay as they are, whatever their names; what is left of a kill goes away; what is told is told
plainly and in time.

usage: users_files.py FRAHM SOURCE_DIR
"""

import datetime
import os
import re
import resource
import stat
import subprocess

import h5py

from faulty_runs import EVERYTHING, OUTPUT, Fault, ended, main, sweep_study

MINE = b"my thesis\n" * 100
SWEEP = "run", "study.toml", "-o", OUTPUT, "--progress", "none"


def small_map(bench):
    return sweep_study(bench.source).replace("points = 129", "points = 9").replace("points = 12", "points = 2")


def made(bench):
    place = bench.place(small_map(bench))
    assert place.call(*SWEEP).code == 0
    return place


def check_names_like_ours(bench):
    """Files that are named like our parts, locks, logs and notes."""
    inode = "0123456789abcdef"
    kept = [OUTPUT + suffix for suffix in (".part", ".part-" + inode, f".part-{inode}-12345", f".part-{inode}-x",
                                           ".frahm-study", ".mine.frahm-study", ".0123456789abcdef-0123456789abcdef.frahm-study")]
    for options in ((), ("--fresh",)):
        place = bench.place(small_map(bench))
        for name in kept:
            place.write(name, MINE)
        outcome = place.call(*SWEEP, *options)
        assert outcome.code == 0, outcome
        assert place.call("export", OUTPUT, "-o", OUTPUT + ".csv").code == 0
        for name in kept:
            assert place.read(name) == MINE, name
    for name in OUTPUT + ".frahm-lock", OUTPUT + ".shard-0-of-2.frahm-log":
        for options in ((), ("--fresh",)):
            place = bench.place(small_map(bench))
            place.write(name, MINE)
            outcome = place.call(*SWEEP, *options)
            assert outcome.code == 6 and name in outcome.err and place.read(name) == MINE, f"{name}: {outcome}"


def check_links(bench):
    """Links in the places of our own files are not followed."""
    for name in OUTPUT + ".frahm-lock", OUTPUT + ".shard-0-of-1.frahm-log", "table.csv.frahm-lock":
        place = made(bench) if name.startswith("table") else bench.place(small_map(bench))
        place.write("mine.txt", MINE)
        os.symlink("mine.txt", place.path(name))
        command = ("export", OUTPUT, "-o", "table.csv") if name.startswith("table") else SWEEP
        outcome = place.call(*command)
        assert outcome.code == 6 and name in outcome.err, f"{name}: {outcome}"
        assert place.read("mine.txt") == MINE, name
    place = bench.place(small_map(bench))
    place.write("mine.txt", MINE)
    os.symlink("mine.txt", place.path(OUTPUT + ".part"))
    assert place.call(*SWEEP).code == 0 and place.read("mine.txt") == MINE


def check_notes(bench):
    """A file named as the very note of a run, 32 hex digits, and a run refused for somebody else's log."""
    place = bench.place(small_map(bench))
    assert place.call(*SWEEP, "--shard", "0/2").code == 0
    note = next(name for name in place.names() if name.endswith(".frahm-study"))
    for options in ((), ("--fresh",)):
        place = bench.place(small_map(bench))
        place.write(note, MINE)
        outcome = place.call(*SWEEP, *options)
        assert outcome.code == 6 and note in outcome.err and place.read(note) == MINE, outcome
    place = bench.place(small_map(bench))
    log = OUTPUT + ".mine.frahm-log"
    place.write(log, MINE)
    outcome = place.call(*SWEEP)
    assert outcome.code == 6 and place.names() == [log], f"{outcome} {place.names()}"


def check_two_exports(bench):
    place = made(bench)
    assert place.call("export", OUTPUT, "-o", "expected.csv").code == 0
    for _ in range(5):
        processes = [place.start("export", OUTPUT, "-o", "table.csv") for _ in range(4)]
        outcomes = [ended(process) for process in processes]
        assert all(o.code == 0 or o.code == 6 and "in use" in o.err for o in outcomes), [str(o) for o in outcomes]
        assert any(o.code == 0 for o in outcomes)
        assert place.read("table.csv") == place.read("expected.csv")
        os.remove(place.path("table.csv"))
        assert place.names() == ["expected.csv", OUTPUT], place.names()


def check_modes(bench):
    before = os.umask(0o027)
    try:
        place = made(bench)
        for command, name in ((SWEEP + ("--fresh",), OUTPUT), (("export", OUTPUT, "-o", "table.csv"), "table.csv"),
                              (("report", OUTPUT, "-o", "page.html"), "page.html")):
            path = place.path(name)
            assert place.call(*command).code == 0
            assert stat.S_IMODE(os.stat(path).st_mode) == 0o640, oct(os.stat(path).st_mode)
            os.chmod(path, 0o604)
            assert place.call(*command).code == 0
            assert stat.S_IMODE(os.stat(path).st_mode) == 0o604, oct(os.stat(path).st_mode)
    finally:
        os.umask(before)


def check_limits(bench):
    """A file above the limit of the shell: an error, nothing left over, and the file before stays."""
    place = made(bench)
    before = place.read(OUTPUT)
    for command in (SWEEP + ("--fresh",), ("export", OUTPUT, "-o", "table.csv"), ("report", OUTPUT, "-o", "page.html"),
                    ("point", "study.toml", "--history", "history.csv")):
        limit = 100 if command[0] == "export" else 2000
        process = place.start(*command, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        outcome = ended(process)
        assert outcome.code == 6, f"{command}: {outcome}"
        assert "File too large" in outcome.err, f"{command}: {outcome}"
        left = [name for name in place.names() if ".part" in name or name.endswith((".csv", ".html"))]
        assert not left and place.read(OUTPUT) == before, f"{command}: {left}"


def check_killed_parts(bench):
    """Parts that a kill leaves are gone after the next run."""
    left = 0
    for command, name in ((SWEEP, OUTPUT), (("export", OUTPUT, "-o", "table.csv"), "table.csv")):
        for at in range(1, 400, 1 if EVERYTHING else 3):
            place = made(bench) if name != OUTPUT else bench.place(small_map(bench))
            outcome = place.call(*command, fault=Fault(at, "kill_before"))
            if outcome.code == 0:
                break
            if name == OUTPUT and not any(".part-" in other for other in place.names()) and at % 20:
                continue
            left += any(".part-" in other for other in place.names())
            assert place.call(*command).code == 0
            assert not [other for other in place.names() if ".part" in other], (at, place.names())
    assert left > 5, left


def check_own_outputs(bench):
    """Tables and pages replace their like only."""
    place = made(bench)
    history = ("point", "study.toml", "--history")
    for command in (("export", OUTPUT, "-o"), history, ("report", OUTPUT, "-o")):
        for name in "measured.csv", "page.html", "notes.txt":
            place.write(name, b"time [s],x [mm]\n0,1\n" if name == "measured.csv" else b"<!doctype html>\n<p>mine</p>\n")
            data = place.read(name)
            outcome = place.call(*command, name)
            assert outcome.code == 6 and name in outcome.err and "exists already" in outcome.err, f"{command}: {outcome}"
            assert place.read(name) == data, f"{command} {name}"
        name = "own.html" if command[0] == "report" else command[0] + ".csv"
        for _ in range(2):  # the second replaces the first
            outcome = place.call(*command, name)
            assert outcome.code == 0, f"{command}: {outcome}"
    less = small_map(bench).replace('"friction_stops", ', "")
    place.write("less.toml", less.encode())
    assert place.call("run", "less.toml", "-o", "less.h5", "--progress", "none").code == 0
    assert place.call("export", "less.h5", "-o", "export.csv").code == 0  # with fewer of the columns


def check_what_the_study_reads(bench):
    """A history never replaces a record that its study reads."""
    folder = os.path.join(bench.source, "studies", "earthquakes")
    with open(os.path.join(folder, "response_spectrum.toml")) as file:
        place = bench.place(file.read())
    with open(os.path.join(folder, "synthetic_quake.csv"), "rb") as file:
        record = file.read()
    place.write("synthetic_quake.csv", record)
    os.link(place.path("synthetic_quake.csv"), place.path("other_name.csv"))
    for name in "synthetic_quake.csv", "other_name.csv":
        outcome = place.call("point", "study.toml", "--history", name)
        assert outcome.code == 6 and "that the study reads" in outcome.err, outcome
        assert place.read(name) == record


def check_words(bench):
    place = bench.place(small_map(bench))
    for argument in b"a\nb.h5", b"a\xff.h5", "a\u009b31m.h5".encode(), b"a\x1b[31m.h5":
        process = subprocess.run([bench.program.encode(), b"run", b"study.toml", b"-o", argument], cwd=place.folder,
                                 capture_output=True, timeout=60)
        assert process.returncode == 2 and b"UTF-8" in process.stderr, process
        assert not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f]", process.stderr.decode()), process
        assert place.names() == [], place.names()
    for title in "\u009b31m", "\\u001b[31m":
        text = small_map(bench).replace('title  = "', 'title  = "' + title, 1)
        assert text != small_map(bench)
        place.write("study.toml", text.encode())
        outcome = place.call("check", "study.toml")
        assert outcome.code in (0, 2), outcome
        assert not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f]", outcome.out + outcome.err), repr(outcome.out + outcome.err)
    place.write("study.toml", small_map(bench).replace("[parameters]", "wrong = \"\u009b31m\" \n[parameters]", 1).encode())
    outcome = place.call("check", "study.toml")
    assert outcome.code == 2 and not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f]", outcome.err), repr(outcome.err)


def check_utc(bench):
    for zone in "Pacific/Kiritimati", "America/Caracas", "XYZ-9:30":
        place = bench.place(small_map(bench))
        process = place.start(*SWEEP, environment=dict(os.environ, TZ=zone))
        assert ended(process).code == 0
        with h5py.File(place.path(OUTPUT)) as file:
            told = file["provenance"].attrs["started"]
        told = datetime.datetime.fromisoformat((told.decode() if isinstance(told, bytes) else told).replace("Z", "+00:00"))
        off = abs((datetime.datetime.now(datetime.timezone.utc) - told).total_seconds())
        assert off < 600, f"{zone}: {told}"


def check_tiny(bench):
    place = bench.place(re.sub(r"values = \[0.02, 0.1\]", "values = [1e-308]", small_map(bench)))
    for command in (SWEEP, ("status", OUTPUT)):
        outcome = place.call(*command)
        assert outcome.code in (0, 3) and "stod" not in outcome.err, outcome


def check_failed_sweep(bench):
    """An export of several files that failed in the middle is tried again."""
    with open(os.path.join(bench.source, "studies", "tuning", "tune_rig_schedule.toml")) as file:
        place = bench.place(file.read())
    outcome = place.call("run", "study.toml", "-o", OUTPUT, "--progress", "none")
    assert outcome.code == 0, outcome
    export = "export", OUTPUT, "--sweep", "again.toml"
    assert place.call(*export, fault=Fault()).code == 0
    calls = place.calls()
    files = [name for name in place.names() if name != OUTPUT]
    assert len(files) > 1, files
    last = max(call.number for call in calls if call.name == "rename")
    for name in files:
        os.remove(place.path(name))
    outcome = place.call(*export, fault=Fault(last, "kill_before"))
    assert outcome.code != 0 and any(name in files for name in place.names()), outcome
    outcome = place.call(*export)
    assert outcome.code == 0 and [name for name in place.names() if name != OUTPUT] == files, outcome


def drill(bench):
    for check in (check_names_like_ours, check_notes, check_links, check_two_exports, check_modes, check_limits, check_own_outputs,
                  check_what_the_study_reads, check_words, check_utc, check_tiny, check_failed_sweep, check_killed_parts):
        check(bench)
        print(check.__name__, flush=True)


if __name__ == "__main__":
    main(drill)
