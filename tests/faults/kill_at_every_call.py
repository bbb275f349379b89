"""Killed at any call that changes a file, before it, half-way or after it, a run loses the tiles in hand only, and
the same command ends with the bytes of an uninterrupted run.

usage: kill_at_every_call.py FRAHM SOURCE_DIR
"""

import re

from faulty_runs import (EVERYTHING, OUTPUT, Expected, Fault, in_parallel, main, resumed_points, sampled, sweep_study,
                         tiles_of_log, tuning_study, whole_appends)

BEFORE, HALF, AFTER = "kill_before", "kill_half", "kill_after"
POINTS_OF_TILE = {"sweep": 129, "tuning": 1}


def kill_points(calls):
    """After a call is before the next one, but for what other threads do meanwhile."""
    for call in calls:
        yield Fault(call.number, BEFORE)
        if call.bytes > 1:
            yield Fault(call.number, HALF)
        if EVERYTHING or call is calls[-1]:
            yield Fault(call.number, AFTER)


def kill_and_resume(bench, study, kind, threads, expected, fault):
    case = f"{kind}, {threads} threads, {fault}"
    place = bench.place(study)
    killed = place.run("--threads", threads, "--progress", "none", fault=fault)
    if killed.code == 0:  # two threads: a run may have fewer calls than the one that was counted
        expected.check_file(place, case)
        return 0
    assert killed.code == -9, f"{case}: {killed}"
    told, is_published = whole_appends(place.calls()), OUTPUT in place.names()
    if is_published:
        expected.check_file(place, case)
    else:
        kept = check_in_hand(place, threads, told, case)
    resumed = expected.check_resume(place, case, "--threads", threads)
    if not is_published:
        assert resumed_points(resumed) == kept * POINTS_OF_TILE[kind], f"{case}: {kept} tiles kept, {resumed}"
    return 1


def check_in_hand(place, threads, told, case):
    """How many tiles are in the log. They are taken in order, so those below the last one kept are kept or were in hand. A
    thread may be killed between its append and its word of it to the shim."""
    tiles = [tile for log in place.logs() for tile in tiles_of_log(place.read(log))]
    kept = len(tiles)
    assert kept == len(set(tiles)) and told <= kept <= told + int(threads), f"{case}: {told} appended, {tiles} in the log"
    if tiles:
        assert max(tiles) + 1 - kept <= int(threads) - 1, f"{case}: lost more than what was in hand: {tiles}"
    return kept


def kill_everywhere(bench, study, kind, threads):
    place = bench.place(study)
    expected = Expected(place)
    place.clear()
    assert place.run("--threads", threads, "--progress", "none", fault=Fault()).code == 0
    calls = place.calls()
    assert len(calls) > 30 and whole_appends(calls) >= 4, calls
    faults = list(kill_points(sampled(calls, 40 if kind == "sweep" and threads == "1" else 12)))
    killed = sum(in_parallel(lambda fault: kill_and_resume(bench, study, kind, threads, expected, fault), faults))
    assert killed > 0.9 * len(faults), (killed, len(faults))
    return killed


def title_of(place):
    return next(line.split(maxsplit=1)[1] for line in place.call("status", OUTPUT).out.splitlines() if line.startswith("title"))


def retitle(bench, study, expected, result, fault):
    """A finished result under a study of another title, whose words are written into it: killed, and run again."""
    place = bench.place(re.sub(r"(?m)^title .*", 'title = "other"', study))
    place.write(OUTPUT, result)
    killed = place.run("--progress", "none", fault=fault)
    case = f"other words, {fault}"
    assert killed.code in (0, -9), f"{case}: {killed}"
    expected.check_file(place, case)
    expected.check_resume(place, case)
    assert title_of(place) == "other", case
    return place.calls(), killed.code == -9


def kill_retitling(bench, study):
    place = bench.place(study)
    expected, result = Expected(place), place.read(OUTPUT)
    assert title_of(place) != "other"
    calls, _ = retitle(bench, study, expected, result, Fault())
    faults = list(kill_points(sampled(calls, 12)))
    killed = sum(in_parallel(lambda fault: retitle(bench, study, expected, result, fault)[1], faults))
    assert killed > 10, (killed, len(faults))
    return killed


def drill(bench):
    sweep, tuning = sweep_study(bench.source), tuning_study(bench.source)
    for kind, study in (("sweep", sweep), ("tuning", tuning)):
        print(f"other words of a {kind}: {kill_retitling(bench, study)} kills", flush=True)
    for kind, study, threads in (("sweep", sweep, "1"), ("sweep", sweep, "2"), ("tuning", tuning, "2")):
        print(f"{kind} on {threads} threads: {kill_everywhere(bench, study, kind, threads)} kills", flush=True)


if __name__ == "__main__":
    main(drill)
