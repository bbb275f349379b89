"""Shard logs that are cut, changed in any byte, empty, foreign, doubled or no logs at all: what is good in them is
used, what is not is computed again or refused with its name and the reason, and the end has the same bytes.

usage: damaged_logs.py FRAHM SOURCE_DIR
"""

import os
import random
import shutil

from faulty_runs import (EVERYTHING, HEADER_SIZE, OUTPUT, RECORD_HEAD, Expected, in_parallel, main, resumed_points,
                         sampled, sweep_study, tiles_of_log)

OWNER_AT = 152  # of a header: behind it stand only remarks about the writer
LOG = OUTPUT + ".shard-0-of-1.frahm-log"
TILES, POINTS_OF_TILE = 24, 129


def finished_log(bench, study, *options):
    """The files of a run whose tiles are all in the log, but which has not made its file."""
    place = bench.place(study)
    outcome = place.run("--threads", "1", "--progress", "none", "--shard", "0/2", *options)
    assert outcome.code == 0, outcome
    return place


def files_of(place):
    return {name: place.read(name) for name in place.names()}


def place_with(bench, study, files):
    place = bench.place(study)
    for name, data in files.items():
        place.write(name, data)
    return place


def check_used(bench, study, expected, files, case, tiles):
    """The run takes so many tiles from the logs (None: any number) and leaves the right file."""
    place = place_with(bench, study, files)
    outcome = place.run("--progress", "json", "--threads", "1")
    assert outcome.code == 0, f"{case}: {outcome}"
    assert place.names() == [OUTPUT], f"{case}: {place.names()}"
    expected.check_file(place, case)
    if tiles is not None:
        assert resumed_points(outcome) == tiles * POINTS_OF_TILE, f"{case}: {outcome}"
    return outcome


def check_refused(bench, study, expected, files, case, code, words, log):
    """Refused with the name of the log and a reason, nothing touched; without that log all is well again."""
    place = place_with(bench, study, files)
    outcome = place.run("--threads", "1", "--progress", "none")
    assert outcome.code == code, f"{case}: {outcome}"
    assert os.path.basename(log) in outcome.err and words in outcome.err, f"{case}: {outcome}"
    assert "internal error" not in outcome.err, f"{case}: {outcome}"
    for name, data in files.items():
        assert name in place.names() and place.read(name)[:OWNER_AT] == data[:OWNER_AT], f"{case}: {name} was touched"
        assert tiles_of_log(place.read(name)) == tiles_of_log(data), f"{case}: {name} lost tiles"
    status = place.call("status", OUTPUT)
    assert status.code in (0, 6) and "internal error" not in status.err, f"{case}: {status}"
    os.remove(place.path(log))
    expected.check_resume(place, case)


def flipped(data, at, bit):
    return data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1:]


def ends_of_records(data):
    """Where each whole record of a log ends."""
    ends, at = [HEADER_SIZE], HEADER_SIZE
    while at < len(data):
        at += RECORD_HEAD.size + RECORD_HEAD.unpack_from(data, at)[4] + 4
        ends.append(at)
    assert ends[-1] == len(data)
    return ends


def check_cuts(bench, study, expected, files):
    """A log cut off anywhere, as by a kill or a full disk."""
    data, ends = files[LOG], ends_of_records(files[LOG])
    lengths = list(range(0, ends[1] + 1, 1 if EVERYTHING else 293))
    lengths += [0, 1, HEADER_SIZE - 1, HEADER_SIZE, HEADER_SIZE + 1, ends[1] - 1, ends[1], ends[1] + 1]
    lengths += [length for end in sampled(ends[2:], 6) for length in (end - 1, end, end + RECORD_HEAD.size)]
    lengths = sorted({length for length in lengths if length <= len(data)})
    in_parallel(lambda length: check_used(bench, study, expected, files | {LOG: data[:length]}, f"cut to {length}",
                                          sum(end <= length for end in ends[1:])), lengths)
    zeros = data[:ends[3]] + bytes(5000)  # as some file systems leave a file after a power failure
    check_used(bench, study, expected, files | {LOG: zeros}, "zeros behind", 3)
    print(f"logs cut to {len(lengths)} lengths", flush=True)


def check_flips(bench, study, expected, files):
    """One bit of a log is wrong."""
    data, ends = files[LOG], ends_of_records(files[LOG])
    rng = random.Random(1)
    in_header = list(range(OWNER_AT)) if EVERYTHING else sorted({0, 7, 8, 11, 12, 19, 20, 83, 84, 147, 148, 151})
    in_parallel(lambda at: check_refused(bench, study, expected, files | {LOG: flipped(data, at, rng.randrange(8))},
                                         f"header, byte {at}", 6, "header", LOG), in_header)
    for at in (OWNER_AT, OWNER_AT + 50, HEADER_SIZE - 1):
        check_used(bench, study, expected, files | {LOG: flipped(data, at, 3)}, f"owner, byte {at}", len(ends) - 1)
    in_records = [end + i for end in (ends[0], ends[4]) for i in range(RECORD_HEAD.size)]
    in_records += [end - 1 - i for end in (ends[1], ends[-1]) for i in range(5)]
    in_records += [rng.randrange(HEADER_SIZE, len(data)) for _ in range(400 if EVERYTHING else 12)]
    in_parallel(lambda at: check_used(bench, study, expected, files | {LOG: flipped(data, at, rng.randrange(8))},
                                      f"byte {at}", sum(end <= at for end in ends[1:])), in_records)
    print(f"{len(in_header)} wrong bits in headers, {len(in_records)} in records", flush=True)


def check_foreign(bench, study, expected, files):
    """Logs that are of something else, or no logs."""
    other_physics = files_of(finished_log(bench, study.replace("mass = 1", "mass = 1.5")))
    other_grid = files_of(finished_log(bench, study.replace("to = 2.5", "to = 2.6")))
    shard = OUTPUT + ".shard-0-of-2.frahm-log"
    for case, other in (("physics", other_physics), ("grid", other_grid)):
        check_refused(bench, study, expected, files | {shard: other[shard]}, f"other {case}", 5,
                      "another system" if case == "physics" else "another grid", shard)
        check_refused(bench, study, expected, {LOG: other[shard]}, f"own log of other {case}", 5,
                      "another system" if case == "physics" else "another grid", LOG)
    swapped = files[LOG][:ends_of_records(files[LOG])[2]] + other_physics[shard][HEADER_SIZE:]
    check_used(bench, study, expected, {LOG: swapped}, "records of another study behind two of its own", 2)
    for name in LOG, shard:
        check_refused(bench, study, expected, files | {name: b"my thesis\n" * 100}, "a text", 6, "not a shard log", name)
        check_refused(bench, study, expected, files | {name: bytes(20000)}, "zeros", 6, "not a shard log", name)
    newer = files[LOG][:8] + b"\x63\0\0\0" + files[LOG][12:]
    for name in LOG, shard:
        check_refused(bench, study, expected, files | {name: newer}, "another version", 6, "version 99", name)
    empty = check_used(bench, study, expected, files | {shard: b""}, "an empty shard", TILES)
    assert empty.code == 0


def check_doubles(bench, study, expected, files):
    """The same tiles more than once, or under a name that is none of a log."""
    data, ends = files[LOG], ends_of_records(files[LOG])
    copy = OUTPUT + ".shard-1-of-2.frahm-log"
    check_used(bench, study, expected, files | {copy: data}, "two logs of the same", TILES)
    check_used(bench, study, expected, files | {LOG: data + data[HEADER_SIZE:]}, "records twice", TILES)
    backwards = b"".join(data[a:b] for a, b in reversed(list(zip(ends, ends[1:]))))
    check_used(bench, study, expected, {copy: data[:HEADER_SIZE] + backwards}, "records in another order", TILES)
    place = place_with(bench, study, {OUTPUT + ".my.copy.frahm-log": data, "copy.frahm-log": data})
    outcome = place.run("--progress", "json")
    assert outcome.code == 0 and resumed_points(outcome) == 0, outcome
    assert place.names() == ["copy.frahm-log", OUTPUT, OUTPUT + ".my.copy.frahm-log"], place.names()
    expected.check_file(place, "logs of other names")


def check_no_files(bench, study, expected, files):
    """A folder or a pipe in the place of a log; the note of the study damaged or gone."""
    shard = OUTPUT + ".shard-0-of-2.frahm-log"
    for name in LOG, shard:
        for make in os.mkdir, os.mkfifo:
            place = bench.place(study)
            make(place.path(name))
            for command in ("run", "study.toml", "-o", OUTPUT, "--progress", "none"), ("status", OUTPUT), ("merge", OUTPUT):
                outcome = place.call(*command)
                assert outcome.code == 6 and name in outcome.out + outcome.err, f"{make.__name__} {name}: {outcome}"
            shutil.rmtree(place.path(name)) if make is os.mkdir else os.remove(place.path(name))
            expected.check_resume(place, f"{make.__name__} {name}")
    whole = finished_log(bench, study)
    outcome = whole.call("run", "study.toml", "-o", OUTPUT, "--shard", "1/2", "--progress", "none")
    assert outcome.code == 0, outcome
    note = next(name for name in whole.names() if name.endswith(".frahm-study"))
    text = whole.read(note)
    for damaged in [b"", text[:10], text[: len(text) // 2], b"\xff" * 100, None]:
        place = place_with(bench, study, files_of(whole) | ({note: damaged} if damaged is not None else {}))
        if damaged is None:
            os.remove(place.path(note))
        outcome = place.call("merge", OUTPUT)
        assert outcome.code in (2, 6) and "frahm-study" in outcome.err or "study" in outcome.err, outcome
        assert "internal error" not in outcome.err and len(place.logs()) == 2, outcome
        expected.check_resume(place, "a damaged note")


def drill(bench):
    study = sweep_study(bench.source)
    expected = Expected(bench.place(study))
    # A log of all tiles, as of a run that was killed before its assembly.
    place = finished_log(bench, study)
    assert place.call("run", "study.toml", "-o", OUTPUT, "--shard", "1/2", "--progress", "none").code == 0
    first, second = (place.read(name) for name in place.logs())
    files = {LOG: first + second[HEADER_SIZE:]}
    assert sorted(tiles_of_log(files[LOG])) == list(range(TILES))
    check_cuts(bench, study, expected, files)
    check_flips(bench, study, expected, files)
    check_foreign(bench, study, expected, files)
    check_doubles(bench, study, expected, files)
    check_no_files(bench, study, expected, files)
    print("foreign and doubled logs, and what is no log, are told apart")


if __name__ == "__main__":
    main(drill)
