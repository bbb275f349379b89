"""Several processes on one output at once: one works, the others are refused with the name of the one that does
(code 6) or find everything done; none spoils another's work.

usage: at_once.py FRAHM SOURCE_DIR
"""

import glob
import itertools
import os
import random
import re
import signal
import time

from faulty_runs import (EVERYTHING, OUTPUT, Expected, Fault, ended, in_parallel, larger_sweep, main, sweep_study,
                         tuning_study)

RACES = 12 if EVERYTHING else 4

RUN = ("run", "study.toml", "-o", OUTPUT, "--threads", "1", "--progress", "none")
OWNER = re.compile(r"in use by process (\d+) on ")


def frozen_at(place, fault, *command):
    """A process stopped (SIGSTOP) at a call, by the shim."""
    process = place.start(*command, environment=place.environment(fault))
    give_up = time.monotonic() + 60
    while not is_frozen(process):
        assert process.poll() is None and time.monotonic() < give_up, f"{fault}: {ended(process)}"
        time.sleep(0.002)
    return process


def is_frozen(process):
    """Whether every thread of it is stopped."""
    states = []
    for path in glob.glob(f"/proc/{process.pid}/task/*/stat"):
        try:
            with open(path) as stat:
                states.append(stat.read().rsplit(")", 1)[1].split()[0])
        except OSError:  # the thread has just ended
            return False
    return bool(states) and all(state == "T" for state in states)


def thawed(process):
    os.killpg(process.pid, signal.SIGCONT)
    return ended(process)


def phases(place):
    """A call in each phase of a run: at the start, computing, assembling, before and behind the publishing."""
    calls = place.calls()
    appends = [call.number for call in calls if call.path.endswith(".frahm-log") and call.offset >= 256]
    parts = [call.number for call in calls if ".h5.part-" in call.path]
    published = next(call.number for call in calls if call.name == "rename" and call.path.endswith(OUTPUT))
    removed = [call.number for call in calls if call.name == "unlink" and call.number > published]
    return {"computing": appends[len(appends) // 2], "computed": appends[-1] + 1, "assembling": parts[len(parts) // 2],
            "publishing": published, "published": published + 1, "removing the logs": removed[0],
            "last call": removed[-1]}


def check_second(bench, study, expected):
    """A second process in each phase of the first."""
    place = bench.place(study)
    assert place.call(*RUN, fault=Fault()).code == 0

    def frozen_in_a_place(number):
        """A run may do with one sync fewer than the one that was counted, and be over before its last call."""
        for attempt in range(20):
            place = bench.place(study)
            try:
                return place, frozen_at(place, Fault(number, "freeze"), *RUN)
            except AssertionError as over:
                if attempt == 19 or "code 0" not in str(over):
                    raise

    def check(item):
        (phase, number), second = item
        case = f"{phase}, then {' '.join(second)}"
        place, first = frozen_in_a_place(number)
        outcome = ended(place.start(*second))
        owner = OWNER.search(outcome.err)
        if outcome.code == 6:
            assert owner and int(owner.group(1)) == first.pid, f"{case}: does not name the owner: {outcome}"
        else:
            assert outcome.code == 0 and phase in ("removing the logs", "last call"), f"{case}: {outcome}"
            expected.check_file(place, case)
        status = place.call("status", OUTPUT)
        assert status.code == 0, f"{case}: {status}"
        outcome = thawed(first)
        assert outcome.code == 0, f"{case}: the first: {outcome}"
        expected.check_resume(place, case)

    seconds = RUN, (*RUN, "--fresh"), ("merge", OUTPUT)
    in_parallel(check, itertools.product(phases(place).items(), seconds), at_once=8)  # they mostly wait


def check_races(bench, study, expected, *options):
    """Processes started together, again and again: whoever is refused names a process, and the file is right."""
    refused = 0
    for _ in range(RACES):
        place = bench.place(study)
        processes = []
        for _ in range(3):
            processes.append(place.start(*RUN, *options))
            time.sleep(random.uniform(0.0, 0.12))
        outcomes = [ended(process) for process in processes]
        for outcome in outcomes:
            assert outcome.code == 0 or outcome.code == 6 and OWNER.search(outcome.err), outcome
        assert any(outcome.code == 0 for outcome in outcomes)
        refused += sum(outcome.code == 6 for outcome in outcomes)
        expected.check_resume(place, "a race")
    print(f"races: {refused} of {3 * RACES} refused", flush=True)


def check_shards(bench, study, expected):
    """The same shard twice is refused; a merge while shards are at work says what is missing, and spoils nothing."""
    shards = [(*RUN, "--shard", f"{i}/3") for i in range(3)]
    place = bench.place(study)
    first = frozen_at(place, Fault(12, "freeze"), *shards[0])
    twice = place.call(*shards[0])
    owner = OWNER.search(twice.err)
    assert twice.code == 6 and owner and int(owner.group(1)) == first.pid, twice
    assert place.call(*shards[1]).code == 0
    merge = place.call("merge", OUTPUT)
    assert merge.code == 6 and "tiles are in no shard log yet" in merge.err, merge
    partial = place.call("merge", OUTPUT, "--partial")
    assert partial.code == 0 and "missing" in partial.out, partial
    assert thawed(first).code == 0
    assert place.call(*shards[2]).code == 0
    merges = [place.start("merge", OUTPUT) for _ in range(3)]
    outcomes = [ended(process) for process in merges]
    assert any(outcome.code == 0 for outcome in outcomes), outcomes
    for outcome in outcomes:
        assert outcome.code in (0, 6) and "in no shard log" not in outcome.err, outcome
    expected.check_resume(place, "shards, merged by several at once")


def check_at_once(bench):
    """One piece of work, such as a decay, keeps no logs; the second is refused all the same."""
    with open(os.path.join(bench.source, "studies", "lecture", "lecture_free_vibration_friction.toml")) as file:
        place = bench.place(file.read())
    first = frozen_at(place, Fault(6, "freeze"), *RUN)
    outcome = ended(place.start(*RUN))
    owner = OWNER.search(outcome.err)
    assert outcome.code == 6 and owner and int(owner.group(1)) == first.pid, outcome
    assert thawed(first).code == 0
    assert place.names() == [OUTPUT], place.names()


def drill(bench):
    random.seed(3)
    for study in sweep_study(bench.source), tuning_study(bench.source):
        expected = Expected(bench.place(study))
        check_second(bench, study, expected)
    check_at_once(bench)
    study = larger_sweep(bench.source)
    expected = Expected(bench.place(study))
    check_races(bench, study, expected)
    check_shards(bench, sweep_study(bench.source), Expected(bench.place(sweep_study(bench.source))))
    print("a second process is refused with the name of the first, or finds everything done")


if __name__ == "__main__":
    main(drill)
