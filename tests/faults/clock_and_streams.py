"""A wall clock that jumps by hours, and standard streams that are closed, broken or full: the map has the same bytes.

usage: clock_and_streams.py FRAHM SOURCE_DIR
"""

import json
import os
import re
import subprocess

from faulty_runs import OUTPUT, Expected, Fault, ended, in_parallel, larger_sweep, main, sweep_study

RUN = ("run", "study.toml", "-o", OUTPUT, "--threads", "2")


def times_of(outcome):
    """All numbers of the progress lines that are times or rates."""
    lines = [json.loads(line) for line in outcome.err.splitlines() if line.startswith("{")]
    assert lines, outcome
    return [line[key] for line in lines for key in ("seconds", "seconds_left", "points_per_second")
            if line[key] is not None]


def check_clock(bench, study, expected):
    place = bench.place(study)
    environment = place.environment(Fault(), "clock_shim.so")
    outcome = ended(place.start(*RUN, "--progress", "json", "--time-budget", "50m", environment=environment))
    assert outcome.code == 0, outcome
    assert all(number >= 0 for number in times_of(outcome)) and max(times_of(outcome)[:2]) < 60, outcome
    told = re.search(r"([-\d.]+) s wall", outcome.out)
    assert told and 0 <= float(told.group(1)) < 60, outcome
    expected.check_file(place, "jumping clock")

    place.clear()
    stopped = ended(place.start(*RUN, "--progress", "json", "--time-budget", "0.2s", environment=environment))
    assert stopped.code == 4 and all(number >= 0 for number in times_of(stopped)), stopped
    for _ in range(6):  # its clock is somewhere else at each look
        status = ended(place.start("status", OUTPUT, environment=environment))
        assert status.code == 0, status
        assert not re.search(r"(?<![\w-])-\d", status.out), status
    resumed = ended(place.start(*RUN, "--progress", "json", environment=environment))
    assert resumed.code == 0, resumed
    expected.check_file(place, "jumping clock, resumed")


def shell(place, script):
    """bash runs the script; $RUN is the command."""
    environment = dict(os.environ, RUN=" ".join([place.bench.program, *RUN]))
    process = subprocess.Popen(["bash", "-c", script], cwd=place.folder, env=environment, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    return ended(process)


# What is done to the streams, and the exit code that follows: 6 where the table could not be printed.
STREAMS = {
    "$RUN >&-": 0,
    "$RUN 2>&-": 0,
    "$RUN <&-": 0,
    "$RUN <&- >&- 2>&-": 0,
    "$RUN --progress none 2>&- >&-": 0,
    "$RUN > /dev/full": 6,
    "$RUN; ${RUN%% *} --help > /dev/full": 6,
    "$RUN; ${RUN%% *} run --help > /dev/full": 6,
    "$RUN; ${RUN%% *} explain stiffness > /dev/full": 6,
    "$RUN 2> /dev/full": 0,
    "$RUN | true; exit ${PIPESTATUS[0]}": 6,
    "$RUN | head -1; exit ${PIPESTATUS[0]}": None,  # the reader may be quicker or slower
    "$RUN --progress json 2>&1 | head -1; exit ${PIPESTATUS[0]}": None,
    "$RUN --progress json 2> >(head -1 >&2)": 0,
    "$RUN --progress plain 2> >(true)": 0,
}


def check_streams(bench, study, expected, script):
    place = bench.place(study)
    outcome = shell(place, script)
    code = STREAMS[script]
    assert outcome.code in ((0, 6) if code is None else (code,)), f"{script}: {outcome}"
    assert place.names() == [OUTPUT], f"{script}: {place.names()}"
    expected.check_file(place, script)


def drill(bench):
    larger = larger_sweep(bench.source)
    check_clock(bench, larger, Expected(bench.place(larger)))
    print("a wall clock that jumps changes nothing", flush=True)
    study = sweep_study(bench.source)
    expected = Expected(bench.place(study))
    in_parallel(lambda script: check_streams(bench, study, expected, script), STREAMS)
    print(f"{len(STREAMS)} ways to close, break or fill the streams")


if __name__ == "__main__":
    main(drill)
