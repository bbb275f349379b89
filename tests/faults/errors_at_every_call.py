"""Whatever call fails, with whatever error, once or from then on, the run says which file and why (code 6) or does
without the call; the same command ends with the same bytes when the fault is gone. A call that writes or reads only a
part is completed.

usage: errors_at_every_call.py FRAHM SOURCE_DIR
"""

import collections
import errno
import os

from faulty_runs import (EVERYTHING, OUTPUT, Expected, Fault, explains, in_parallel, main, resumed_points, sampled,
                         sweep_study, whole_appends)

POINTS_OF_TILE = 129


def changes_that_fail(calls):
    """A disk that is full from a call on, and one that is broken at it; the other way round, and other errors, here
    and there."""
    for call in sampled(calls, 25):
        yield Fault(call.number, "fail_on", errno.ENOSPC)
        yield Fault(call.number, "fail", errno.EIO)
    for call in sampled(calls, 4):
        yield Fault(call.number, "fail", errno.ENOSPC)
        yield Fault(call.number, "fail_on", errno.EIO)
        yield Fault(call.number, "fail_on", errno.EROFS)
        yield Fault(call.number, "fail_on", errno.EDQUOT)
        yield Fault(call.number, "fail", errno.EACCES)


def first_of_each_kind(calls):
    """The first and the last call on each file of each name: the others are like these."""
    kinds = collections.defaultdict(list)
    for call in calls:
        kinds[call.name, call.path].append(call)
    return [call for same in kinds.values() for call in {same[0].number: same[0], same[-1].number: same[-1]}.values()]


def fails_and_resumes(bench, study, expected, threads, before, fault):
    """Whether it ended with an error."""
    case = f"{threads} threads, {fault}, {'with' if before else 'without'} a file before"
    place = bench.place(study)
    if before is not None:
        place.write(OUTPUT, before)
    outcome = place.run("--threads", threads, "--progress", "none", *(["--fresh"] if before else []), fault=fault)
    is_about_study = outcome.code == 2 and "study.toml: cannot be read" in outcome.err
    assert outcome.code in (0, 6) or is_about_study, f"{case}: {outcome}"
    if outcome.code == 0:
        expected.check_file(place, case)
    else:
        assert explains(outcome, fault.error), f"{case}: does not tell file and reason: {outcome}"
        assert "internal error" not in outcome.err, f"{case}: {outcome}"
    calls = place.calls()
    is_published = any(call.name == "rename" and call.path == place.path(OUTPUT) and call.result == "done"
                       for call in calls)
    if before is not None and not is_published:
        assert place.read(OUTPUT) == before, f"{case}: the file before has changed"
        os.remove(place.path(OUTPUT))
    resumed = expected.check_resume(place, case, "--threads", threads)
    if fault.count == "changes" and not is_published and resumed_points(resumed) is not None:
        kept = whole_appends(calls)
        assert resumed_points(resumed) == kept * POINTS_OF_TILE, f"{case}: {kept} tiles kept, {resumed}"
    return outcome.code == 6


def completes(bench, study, expected, threads, fault):
    case = f"{threads} threads, {fault}"
    place = bench.place(study)
    outcome = place.run("--threads", threads, "--progress", "none", fault=fault)
    assert outcome.code == 0, f"{case}: {outcome}"
    assert place.names() == [OUTPUT], f"{case}: {place.names()}"
    expected.check_file(place, case)


def counted(bench, study, threads, count, options=()):
    place = bench.place(study)
    assert place.run("--threads", threads, "--progress", "none", *options, fault=Fault(count=count)).code == 0
    return place.calls()


def drill(bench):
    study = sweep_study(bench.source)
    place = bench.place(study)
    expected = Expected(place)
    before = place.read(OUTPUT)

    changes, reads = counted(bench, study, "1", "changes"), counted(bench, study, "1", "reads")
    assert len(changes) > 50 and len(reads) > 30, (len(changes), len(reads))
    faults = list(changes_that_fail(changes))
    errors = sum(in_parallel(lambda fault: fails_and_resumes(bench, study, expected, "1", None, fault), faults))
    print(f"{len(faults)} failing changes: {errors} errors told, the others harmless", flush=True)
    assert errors > 0.8 * len(faults)

    faults = [Fault(call.number, how, errno.ENOSPC) for call in sampled(changes, 8) for how in ("fail", "fail_on")]
    in_parallel(lambda fault: fails_and_resumes(bench, study, expected, "2", before, fault), faults)
    print(f"{len(faults)} of them over an earlier file, on two threads", flush=True)

    wanted = reads if EVERYTHING else first_of_each_kind(reads)
    faults = [Fault(call.number, how, errno.EIO, "reads") for call in wanted for how in ("fail", "fail_on")]
    in_parallel(lambda fault: fails_and_resumes(bench, study, expected, "1", None, fault), faults)
    print(f"{len(faults)} failing reads", flush=True)

    faults = [Fault(call.number, "short") for call in sampled(changes, 20) if call.bytes > 1]
    faults += [Fault(call.number, "short", 0, "reads") for call in sampled(reads, 8) if call.bytes > 1]
    in_parallel(lambda fault: completes(bench, study, expected, "1", fault), faults)
    print(f"{len(faults)} short writes and reads, all completed", flush=True)


if __name__ == "__main__":
    main(drill)
