"""On any number of MPI ranks a study gives the same bytes as in one process, whatever happens to a rank.

usage: ranks.py FRAHM SOURCE_DIR MPIEXEC [few]

few: a small map on few ranks, without kills and signals: for programs that sanitizers make slow.
"""

import fcntl
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

from same_bytes import MOTIONS_OVER_RECORDS, TUNING_OVER_RECORDS, raw_bytes

TIME_LIMIT = 120.0  # s of any one run: a hang is a failure
SHARDS = 5

ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_hwloc_base_binding_policy="none")


class Folder:
    def __init__(self, program, mpiexec, folder, study):
        self.program, self.mpiexec, self.folder = program, mpiexec, folder
        self.study, self.output = os.path.join(folder, "study.toml"), os.path.join(folder, "map.h5")
        with open(self.study, "w") as file:
            file.write(study)

    def command(self, *options, study=None):
        return [self.program, "run", study or self.study, "-o", self.output, "--progress", "none", *options]

    def start(self, command):
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)

    def end(self, process):
        try:
            out, message = process.communicate(timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            process.kill()
            raise AssertionError(f"hangs: {process.args}")
        return process.returncode, out, message

    def call(self, command):
        return self.end(self.start(command))

    def on_ranks(self, ranks, *options):
        return [self.mpiexec, "-np", str(ranks), *self.command(*options)]

    def of_different(self, *commands):
        """A rank for each command."""
        line = [self.mpiexec]
        for i, command in enumerate(commands):
            line += ([":"] if i > 0 else []) + ["-np", "1", *command]
        return line

    def finish(self, command):
        code, out, message = self.call(command)
        assert code == 0, f"code {code}: {message}"
        left = sorted(os.listdir(self.folder))
        assert left == ["map.h5", "study.toml"], left
        found = raw_bytes(self.output)
        os.remove(self.output)
        return found, out

    def logs(self):
        return [name for name in os.listdir(self.folder) if name.endswith(".frahm-log")]

    def forget(self):
        for name in os.listdir(self.folder):
            if name != "study.toml":
                os.remove(os.path.join(self.folder, name))


def check_numbers_of_ranks(folder, expected):
    for ranks, threads in (1, 2), (2, 1), (7, 2):
        found, out = folder.finish(folder.on_ranks(ranks, "--threads", str(threads)))
        assert found == expected, (ranks, threads)
        team = f"{ranks * threads} threads of {ranks} ranks" if ranks > 1 else f" on {threads} thread"
        assert out.count(team) == 1, out
        assert out.count("status ") == 1, "said by more than one rank"


def check_shards(folder, expected):
    for shard in range(SHARDS):
        ranks = 1 + shard % 2
        code, _, message = folder.call(folder.on_ranks(ranks, "--shard", f"{shard}/{SHARDS}"))
        assert code == 0, message
    code, _, message = folder.call([folder.program, "merge", folder.output])
    assert code == 0, message
    assert raw_bytes(folder.output) == expected, "shards"
    folder.forget()


def check_stops(folder, expected):
    for how in signal.SIGUSR1, signal.SIGTERM, signal.SIGINT:
        process = folder.start(folder.on_ranks(3, "--threads", "1"))
        while not folder.logs() and process.poll() is None:
            time.sleep(0.001)
        time.sleep(random.uniform(0.0, 0.2))
        process.send_signal(how)
        code, _, message = folder.end(process)
        if how == signal.SIGUSR1 and code != 0:  # which the launcher passes on; the others it carries out itself
            assert code == 4, (code, message)
            assert message.count("stopped by SIGUSR1") == 1, message
        assert folder.finish(folder.on_ranks(2))[0] == expected, how

    code, _, message = folder.call(folder.on_ranks(2, "--time-budget", "0.05s"))
    assert code == 4 and message.count("the time budget of 0.05 s is used up") == 1, (code, message)
    assert folder.finish(folder.command())[0] == expected


def check_errors(folder, expected):
    nowhere = os.path.join(folder.folder, "nowhere.toml")
    code, _, message = folder.call(folder.of_different(folder.command(), folder.command(study=nowhere)))
    assert code == 2 and message.count("frahm: rank 1: ") == 1 and nowhere in message, (code, message)
    folder.forget()

    with tempfile.TemporaryDirectory() as elsewhere:
        other = os.path.join(elsewhere, "study.toml")
        with open(folder.study) as file, open(other, "w") as changed:
            changed.write(file.read().replace("mass = 102.66\n", "mass = 102.67\n"))
        code, _, message = folder.call(folder.of_different(folder.command(), folder.command(study=other)))
    assert code == 6 and message.count("another study") == 1, (code, message)
    folder.forget()

    log = folder.output + ".shard-0-of-1-rank-1.frahm-log"
    with open(log, "wb") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        code, _, message = folder.call(folder.on_ranks(2))
    assert code == 6 and message.count("frahm: rank 1 (process ") == 1 and log in message, (code, message)
    assert folder.finish(folder.on_ranks(2))[0] == expected

    code, out, message = folder.call([folder.mpiexec, "-np", "3", folder.program, "check", folder.study])
    assert code == 0 and out.count("is a valid study") == 1, (code, out, message)
    code, _, message = folder.call([folder.mpiexec, "-np", "3", folder.program, "run", nowhere])
    assert code == 2 and message.count("frahm: ") == 1, (code, message)
    code, _, message = folder.call([folder.mpiexec, "-np", "2", folder.program, "run", folder.study, "--wrong"])
    assert code == 2 and message.count("--wrong") == 1, (code, message)


def check_full_disk(folder, expected):
    full = ["sh", "-c", 'trap "" XFSZ; ulimit -f 40; exec "$@"', "sh", *folder.command("--threads", "1")]
    code, _, message = folder.call(folder.of_different(folder.command("--threads", "1"), full))
    assert code == 6 and "rank 1 (process " in message and "File too large" in message, (code, message)
    assert folder.finish(folder.on_ranks(2))[0] == expected


def check_tuning(program, source, mpiexec):
    """The starts of a tuning are its tiles."""
    with open(os.path.join(source, "studies", "tuning", "tune_h2_force.toml")) as file:
        lines = [line for line in file.read().splitlines() if not line.startswith("start ")]
    with tempfile.TemporaryDirectory() as path:
        folder = Folder(program, mpiexec, path, "\n".join(lines).replace("[tune]", "[tune]\nstart = 16"))
        expected, _ = folder.finish(folder.command("--threads", "1"))
        assert expected["optimum/start_objective"][1] == (16,)
        assert folder.finish(folder.on_ranks(3))[0] == expected


def check_records(program, mpiexec):
    """Motions over records and samples on five ranks; the starts of a tuning over them."""
    with tempfile.TemporaryDirectory() as path:
        folder = Folder(program, mpiexec, path, MOTIONS_OVER_RECORDS)
        expected, _ = folder.finish(folder.command("--threads", "1"))
        assert folder.finish(folder.on_ranks(5))[0] == expected
        check_shards(folder, expected)
    with tempfile.TemporaryDirectory() as path:
        folder = Folder(program, mpiexec, path, TUNING_OVER_RECORDS)
        expected, _ = folder.finish(folder.command("--threads", "1"))
        assert folder.finish(folder.on_ranks(5))[0] == expected


def check_few(program, mpiexec, study):
    with tempfile.TemporaryDirectory() as path:
        folder = Folder(program, mpiexec, path, study)
        expected, _ = folder.finish(folder.command("--threads", "1"))
        check_numbers_of_ranks(folder, expected)
        check_shards(folder, expected)
        check_errors(folder, expected)
    print("1, 2 and 7 ranks, shards and errors of a rank: the same bytes in every dataset")


def main():
    random.seed(6)
    program, source, mpiexec, *few = sys.argv[1:]
    with open(os.path.join(source, "studies", "rig", "rig_atlas.toml")) as file:
        study = file.read()
    assert study.count("points = 42\n") == 1
    study = study.replace("points = 42\n", "points = 6\n").replace("points = 401\n", "points = 201\n")
    if few:
        return check_few(program, mpiexec, study.replace("points = 201\n", "points = 21\n"))
    check_tuning(program, source, mpiexec)
    check_records(program, mpiexec)
    with tempfile.TemporaryDirectory() as path:
        folder = Folder(program, mpiexec, path, study)
        expected, _ = folder.finish(folder.command("--threads", "1"))
        assert len(expected) > 10 and expected["main_peak"][1] == (6, 31, 201)
        check_numbers_of_ranks(folder, expected)
        check_shards(folder, expected)
        check_errors(folder, expected)
        check_full_disk(folder, expected)
        check_stops(folder, expected)
    # Killed ranks of a map: tests/faults/ranks.py.
    print("1, 2, 3, 5 and 7 ranks, signals and errors of a rank: the same bytes in every dataset")


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it
    main()
