"""Runs killed at random moments, all of their processes at once, frozen, or asked to stop: whatever happens, nothing
that was finished is lost, and the end has the bytes of an uninterrupted run.

usage: random_kills.py FRAHM SOURCE_DIR
"""

import os
import random
import signal
import time

from faulty_runs import (EVERYTHING, OUTPUT, Expected, Fault, ended, in_parallel, larger_sweep, main, sweep_study,
                         tiles_of_log)

KILLS = 200 if EVERYTHING else 15  # of the larger run, and as many of its shards and their merge
CHAINS = 40 if EVERYTHING else 5  # runs killed again and again at random calls
STOPS = 30 if EVERYTHING else 4
MERGE = ("merge", OUTPUT)


def kept_tiles(place):
    """The tiles in logs, each with the bytes of its log before it, so that a changed log is noticed."""
    return {(log, tile) for log in place.logs() for tile in tiles_of_log(place.read(log))}


def killed_after(process, seconds, how=signal.SIGKILL):
    """Whether the process was still at work after so long, and then hit with its whole group."""
    time.sleep(seconds)
    was_at_work = process.poll() is None
    if was_at_work:
        os.killpg(process.pid, how)
    return was_at_work


def check_nothing_lost(place, before, case):
    """While the file is not there, tiles are only ever added to the logs."""
    after = kept_tiles(place)
    if OUTPUT not in place.names():
        assert before <= after, f"{case}: tiles were lost: {sorted(before - after)}"
    return after


def kill_runs(bench, study, expected):
    """One run after the other on the same output, on changing numbers of threads, killed at a random moment."""
    place, kills, rounds, kept = bench.place(study), 0, 0, set()
    while kills < KILLS:
        threads = random.choice("123")
        process = place.start("run", "study.toml", "-o", OUTPUT, "--threads", threads, "--progress", "none")
        was_killed = killed_after(process, random.uniform(0.0, 0.25))
        outcome = ended(process)
        kills += was_killed
        kept = check_nothing_lost(place, kept, f"kill {kills}")
        if outcome.code == 0:
            expected.check_resume(place, "a run that was killed and resumed")
            place.clear()
            kept, rounds = set(), rounds + 1
        else:
            assert outcome.code == -signal.SIGKILL, outcome
            if OUTPUT in place.names():  # killed behind its work
                expected.check_file(place, "killed at the end")
    expected.check_resume(place, "the last of the killed runs")
    print(f"{kills} random kills over {rounds + 1} maps", flush=True)


def kill_shards(bench, study, expected):
    """Three shards, two of them at a time, and merges in between: each killed at random; then the whole."""
    place, kills, kept = bench.place(study), 0, set()
    commands = [("run", "study.toml", "-o", OUTPUT, "--threads", "1", "--progress", "none", "--shard", f"{i}/3")
                for i in range(3)] + [MERGE, (*MERGE, "--partial")]
    while kills < KILLS:
        processes = [place.start(*command) for command in random.sample(commands, 2)]
        time.sleep(random.uniform(0.0, 0.25))
        for process in processes:
            kills += killed_after(process, 0.0)
        for process in processes:
            outcome = ended(process)
            # 6: a merge without all tiles says so, a lock of a dying process is waited for
            assert outcome.code in (0, 6, -signal.SIGKILL), outcome
        if OUTPUT in place.names() and not place.logs():
            expected.check_file(place, "merged")
            place.clear()
            kept = set()
        elif OUTPUT in place.names():
            kept = kept_tiles(place)  # of a partial map, whose logs are kept, or a merge killed behind its work
        else:
            kept = check_nothing_lost(place, kept, "shards")
    for command in commands[:3]:
        outcome = place.call(*command)
        assert outcome.code == 0, outcome
    if place.logs():
        outcome = place.call(*MERGE)
        assert outcome.code == 0, outcome
    expected.check_resume(place, "shards and merges")
    print(f"{kills} random kills of shards and merges", flush=True)


def kill_chain(bench, study, expected, seed):
    """Each resumed run is killed at a random call of its own, before, half-way or after it."""
    rng = random.Random(seed)
    place, kills = bench.place(study), 0
    for _ in range(40):
        fault = Fault(rng.randint(1, 70), rng.choice(["kill_before", "kill_half", "kill_after"]))
        outcome = place.run("--threads", rng.choice("12"), "--progress", "none", fault=fault)
        assert outcome.code in (0, -signal.SIGKILL), f"seed {seed}, {fault}: {outcome}"
        if outcome.code == 0:
            break
        kills += 1
    expected.check_resume(place, f"chain {seed}")
    return kills


def catches(process, how):
    """Whether the process has a handler for the signal."""
    with open(f"/proc/{process.pid}/status") as status:
        caught = next(int(line.split()[1], 16) for line in status if line.startswith("SigCgt:"))
    return caught >> (how - 1) & 1 == 1


def stop_runs(bench, study, expected):
    """Asked to stop, a run at work ends with code 4, and the same command goes on."""
    stops, place = 0, bench.place(study)
    while stops < STOPS:
        how = (signal.SIGTERM, signal.SIGUSR1, signal.SIGINT)[stops % 3]
        process = place.start("run", "study.toml", "-o", OUTPUT, "--threads", "2", "--progress", "none")
        while process.poll() is None and not catches(process, how):
            time.sleep(0.001)
        killed_after(process, random.uniform(0.0, 0.2), how)
        outcome = ended(process)
        if outcome.code == 4:
            stops += 1
            assert f"stopped by {how.name}" in outcome.err and "the same command " in outcome.err, outcome
            assert OUTPUT not in place.names()
        else:
            # Behind its work it just ends; the file is whole.
            assert outcome.code == 0 or outcome.code == -how and OUTPUT in place.names(), outcome
            expected.check_resume(place, "stopped too late")
            place.clear()
    expected.check_resume(place, "stopped again and again")
    print(f"{stops} stops by SIGTERM, SIGUSR1 and SIGINT", flush=True)


def freeze(bench, study, expected):
    """Frozen and thawed, a run goes on as if nothing had been."""
    place = bench.place(study)
    process = place.start("run", "study.toml", "-o", OUTPUT, "--threads", "2", "--progress", "none")
    for _ in range(5):
        time.sleep(0.03)
        os.killpg(process.pid, signal.SIGSTOP)
        time.sleep(0.05)
        os.killpg(process.pid, signal.SIGCONT)
    outcome = ended(process)
    assert outcome.code == 0, outcome
    assert place.names() == [OUTPUT]
    expected.check_file(place, "frozen and thawed")


def drill(bench):
    random.seed(6)
    larger, small = larger_sweep(bench.source), sweep_study(bench.source)
    expected = Expected(bench.place(larger))
    kill_runs(bench, larger, expected)
    kill_shards(bench, larger, expected)
    stop_runs(bench, larger, expected)
    freeze(bench, larger, expected)
    expected = Expected(bench.place(small))
    kills = sum(in_parallel(lambda seed: kill_chain(bench, small, expected, seed), range(CHAINS)))
    print(f"{kills} kills in {CHAINS} chains of resumed runs", flush=True)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it
    main(drill)
