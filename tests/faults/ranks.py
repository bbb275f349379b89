"""Ranks of an MPI job killed at random moments and at chosen calls of one of them, one or all at once: the job ends,
nothing that was finished is lost, and any other way to run the study goes on from there to the same bytes. A frozen
rank is noticed, and the others finish without it.

usage: ranks.py FRAHM SOURCE_DIR MPIEXEC
"""

import contextlib
import os
import random
import re
import signal
import subprocess
import sys
import time

import faulty_runs
from faulty_runs import (EVERYTHING, HEADER_SIZE, OUTPUT, TIME_LIMIT, Expected, Fault, ended, in_parallel, larger_sweep, sampled,
                         sweep_study, tiles_of_log)

RANKS = 3
KILLS = 15 if EVERYTHING else 1  # at random moments, in each of several series
FREEZES = 6 if EVERYTHING else 1
CALLS = 40 if EVERYTHING else 2  # of each rank, each before, half-way and after
AT_ONCE = 4                      # jobs, which mostly wait for their launchers
ALLOWED = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
           "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}


class Launcher:
    """Starts the program on ranks, as Place.start() does on its own."""

    def __init__(self, mpiexec):
        self.mpiexec = mpiexec

    def start(self, place, ranks, environment=None, options=(), **how):
        command = ["-np", str(ranks), place.bench.program, "run", "study.toml", "-o", OUTPUT, "--threads", "1",
                   "--progress", "none", *options]
        return place.start(*command, environment=dict(environment or os.environ, **ALLOWED), program=self.mpiexec, **how)


def ranks_of(process):
    """The living processes that a launcher has started, those that outlive it too, each with its state: "T" if it is stopped."""
    states = {}
    for pid in filter(str.isdecimal, os.listdir("/proc")):
        with contextlib.suppress(FileNotFoundError, ProcessLookupError), open(f"/proc/{pid}/stat") as file:
            state, _, _, session = file.read().rsplit(")", 1)[1].split()[:4]
            if int(session) == process.pid != int(pid) and state not in "ZX":
                states[int(pid)] = state
    return states


def send(number, *pids):
    """A process may have ended meanwhile."""
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)


def wait_for(condition, what):
    give_up = time.monotonic() + TIME_LIMIT
    while not (found := condition()):
        assert time.monotonic() < give_up, f"not within {TIME_LIMIT} s: {what}"
        time.sleep(0.01)
    return found


def job_ended(process):
    """As ended(); but where ranks are killed as they start, Open MPI's launcher itself may wait for ever for their
    greeting. That is no hang of ours if none of the ranks lives; any other is. A killed rank that waits for the disk
    outlives its launcher, and holds its locks."""
    try:
        process.wait(TIME_LIMIT)
    except subprocess.TimeoutExpired:
        assert not ranks_of(process), f"ranks {ranks_of(process)} hang"
        print("the launcher outlived all its ranks and was killed", flush=True)
        process.kill()
    outcome = ended(process)
    wait_for(lambda: not ranks_of(process), "the end of all ranks")
    return outcome


def launcher_crashed(outcome):
    """Open MPI's launcher may itself fall over (libpmix 4.2, PMIx_server_finalize) after rank 0 has ended the job without
    the frozen rank. That is no fault of ours if rank 0 said that all is well."""
    return (outcome.code == -signal.SIGSEGV and "PMIx_server_finalize" in outcome.err
            and re.search(r"MPI_ABORT was invoked on rank 0 .*\s+with errorcode 0\.", outcome.err) is not None)


def kept(place):
    return {tile for log in place.logs() for tile in tiles_of_log(place.read(log))}


def go_on(launcher, place, expected, case):
    """By any other way of running."""
    ranks = random.choice([0, 2, 3])
    if ranks > 0:
        outcome = job_ended(launcher.start(place, ranks))
        assert outcome.code == 0, f"{case}: on {ranks} ranks: {outcome}"
    expected.check_resume(place, case)


def kill_at_calls(launcher, bench, study, expected):
    """A rank is killed by its own k-th call; the launcher ends the others."""
    faults = []
    for rank in range(RANKS):
        place = bench.place(study)
        environment = dict(place.environment(Fault()), FAULT_RANK=str(rank))
        assert job_ended(launcher.start(place, RANKS, environment)).code == 0
        faults += [(rank, Fault(call.number, how)) for call in sampled(place.calls(), CALLS)
                   for how in ("kill_before", "kill_half", "kill_after")]

    def kill(item):
        rank, fault = item
        place = bench.place(study)
        environment = dict(place.environment(fault), FAULT_RANK=str(rank))
        outcome = job_ended(launcher.start(place, RANKS, environment))
        if outcome.code == 0:  # the tiles were dealt out otherwise: this rank had fewer calls
            expected.check_file(place, f"rank {rank}, {fault}")
            return 0
        go_on(launcher, place, expected, f"rank {rank}, {fault}")
        return 1

    kills = sum(in_parallel(kill, faults, AT_ONCE))
    print(f"{kills} kills at calls of a rank", flush=True)
    assert kills > CALLS


def kill_at_random(launcher, bench, study, expected):
    """One rank, or all of them at once with their launcher."""
    place, kills, before = bench.place(study), 0, set()
    while kills < KILLS:
        process = launcher.start(place, RANKS)
        time.sleep(random.uniform(0.1, 0.6))
        ranks = list(ranks_of(process))
        if ranks and random.random() < 0.5:
            send(signal.SIGKILL, random.choice(ranks))
        elif ranks:
            send(signal.SIGKILL, process.pid, *ranks)
        outcome = job_ended(process)
        kills += outcome.code != 0
        if OUTPUT in place.names():
            expected.check_file(place, "killed ranks")
            expected.check_resume(place, "killed ranks")
            place.clear()
        else:
            assert before <= kept(place), "tiles were lost"
        before = kept(place)
    go_on(launcher, place, expected, "killed ranks")
    return kills


def second_tile_of(launcher, bench, study, rank):
    """The number of the call by which a rank appends its second tile to its log."""
    place = bench.place(study)
    environment = dict(place.environment(Fault()), FAULT_RANK=str(rank))
    assert job_ended(launcher.start(place, RANKS, environment)).code == 0
    appends = [call.number for call in place.calls()
               if call.name == "pwrite" and call.path.endswith(".frahm-log") and call.offset >= HEADER_SIZE]
    return appends[1]


def read_again(file):
    file.seek(0)
    return file.read()


def freeze(launcher, bench, study, expected, at_call, thaws):
    """The last of the ranks freezes when it has finished a tile; the job ends without it."""
    place = bench.place(study)
    environment = dict(place.environment(Fault(at_call, "freeze")), FAULT_RANK=str(RANKS - 1))
    given_up = "has been silent for 2 s"
    with open(place.folder + ".told", "a+") as told:
        process = launcher.start(place, RANKS, environment, ("--rank-silence", "2s"), stderr=told)
        frozen = wait_for(lambda: [pid for pid, state in ranks_of(process).items() if state == "T"], "a frozen rank")
        if thaws:
            wait_for(lambda: given_up in read_again(told), "word of the frozen rank")
            send(signal.SIGCONT, *frozen)
        outcome = job_ended(process)
        outcome.err = read_again(told)
    case = f"a rank that freezes{' and thaws' if thaws else ''}"
    assert outcome.code == 0 or launcher_crashed(outcome), f"{case}: {outcome}"
    assert given_up in outcome.err, f"{case}: {outcome}"
    expected.check_file(place, case)
    expected.check_resume(place, case)


def drill(bench):
    random.seed(4)
    launcher = Launcher(mpiexec)
    study = sweep_study(bench.source)
    kill_at_calls(launcher, bench, study, Expected(bench.place(study)))
    study = larger_sweep(bench.source)
    expected = Expected(bench.place(study))
    kills = sum(in_parallel(lambda _: kill_at_random(launcher, bench, study, expected), range(AT_ONCE), AT_ONCE))
    print(f"{kills} random kills of one rank or of all", flush=True)
    at_call = second_tile_of(launcher, bench, study, RANKS - 1)
    for number in range(FREEZES):
        freeze(launcher, bench, study, expected, at_call, thaws=number % 2 == 1)
    print(f"{FREEZES} ranks frozen", flush=True)


if __name__ == "__main__":
    mpiexec = sys.argv.pop()
    faulty_runs.main(drill)
