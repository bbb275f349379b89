"""Runs the job scripts of studies/slurm on a real Slurm, with what befalls jobs on a cluster: requeued by
hand, stopped by the time limit, their node killed. The result has the bytes of one plain run.

usage: drill.py FRAHM SOURCE_DIR [--quick]
--quick: the same job scripts on a small map; nothing befalls them
ends with 0, with 1 and a message, or with 77 where Slurm is not installed or cannot run
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time

from cluster import Cluster, NotAvailable, wait_until, with_init

NOT_AVAILABLE = 77
MOST_SECONDS = 600  # of the whole drill; some three minutes on two idle cores
TASKS = 6  # two on each of three nodes, so that all run at once
# Values of the atlas' second axis instead of 31, so that each task takes some twenty seconds, and eight if it were alone on
# an idle machine: longer than slurmctld needs to find that the time of one is up.
FRICTIONS = 150 * min(len(os.sched_getaffinity(0)), TASKS)
# States in which a job stays; on its way it passes through many more, CONFIGURING and SIGNALING among them.
ENDED_BADLY = "BOOT_FAIL", "CANCELLED", "DEADLINE", "FAILED", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "TIMEOUT"
NOTICE = 4.0  # seconds between the submission and slurmctld's look at the time limits


class Drill:
    def __init__(self, program, source, folder, cluster):
        self.program, self.folder, self.cluster = program, folder, cluster
        self.scripts = os.path.join(source, "studies", "slurm")
        cluster.environment["PATH"] = os.path.dirname(program) + ":" + cluster.environment["PATH"]
        # Open MPI as root, and between nodes that are one machine, whose shared memory it must not use.
        cluster.environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                   OMPI_MCA_btl="tcp,self", OMPI_MCA_btl_tcp_if_include="lo", OMPI_MCA_pml="ob1")
        os.chdir(folder)

    def submit(self, *words):
        script = [os.path.join(self.scripts, word) if word.endswith(".sh") else word for word in words]
        return self.cluster.run("sbatch", "--parsable", *script).strip()

    def fields(self, job):
        return dict(re.findall(r"(\w+)=(\S*)", self.cluster.run("scontrol", "show", "job", job)))

    def ended_well(self, job):
        state = self.fields(job)["JobState"]
        assert state not in ENDED_BADLY, f"job {job}: {state}"
        return state == "COMPLETED"

    def wait_for_end(self, jobs, seconds=150):
        wait_until(f"jobs {', '.join(jobs)} have ended", seconds, lambda: all([self.ended_well(job) for job in jobs]))

    def restarts(self, job):
        return int(self.fields(job)["Restarts"])

    def wait_for_time_check(self):
        time.sleep((self.cluster.seconds_to_time_check() - NOTICE) % 30)


def told(text):
    print(f"slurm: {text}", flush=True)


def at_work(drill, output):
    """How many tasks of an array, or 1 for one run of everything; 0 if none, or nothing is there yet."""
    found = subprocess.run(["frahm", "status", output], env=drill.cluster.environment, capture_output=True, text=True,
                           timeout=20).stdout
    several = re.search(r"at work +(\d+) of \d+ array tasks", found)
    return int(several[1]) if several else int("one run of everything" in found)


def check_array(drill):
    """The array job: one task requeued, one stopped by its time limit, one node killed; merged by a job of its own."""
    cluster = drill.cluster
    timed, requeued = 2, 1
    script = "array.sh", str(TASKS), "study.toml", "array.h5"
    drill.wait_for_time_check()
    # Submitted by itself, a task still means the same shard. It has less time than its script wants to be told ahead.
    alone = drill.submit(f"--array={timed}", "--time=1", *script)
    rest = drill.submit(f"--array=0-{timed - 1},{timed + 1}-{TASKS - 1}", "--time=10", *script)
    merge = drill.submit(f"--dependency=afterok:{alone}:{rest}", "--time=10", "merge.sh", "array.h5")
    tasks = [f"{alone if task == timed else rest}_{task}" for task in range(TASKS)]
    wait_until("the tasks are at work", 30, lambda: at_work(drill, "array.h5") >= TASKS - 1)
    cluster.run("scontrol", "requeue", tasks[requeued])
    nodes = [drill.fields(task)["NodeList"] for task in tasks]
    node = next(node for node in nodes if node not in (nodes[timed], nodes[requeued]))
    cluster.kill_node(node)
    cluster.run("scontrol", "update", f"NodeName={node}", "State=DOWN", "Reason=drill")
    log = f"frahm-{tasks[timed]}.log"
    wait_until(f"task {timed} is stopped by its time limit", 40, lambda: "goes back into the queue" in open(log).read())
    assert "stopped by SIGUSR1" in open(log).read()
    told(f"array: task {requeued} requeued, task {timed} stopped by its time limit, node {node} killed")
    status = cluster.run("frahm", "status", "array.h5")
    print(status, end="")
    assert re.search(r"points +\d+ of \d+ done", status) and "missing tasks" in status and "--array=" in status
    cluster.start_node(node)
    cluster.run("scontrol", "update", f"NodeName={node}", "State=RESUME")
    drill.wait_for_end([*tasks, merge])
    again = [task for task, where in enumerate(nodes) if task in (timed, requeued) or where == node]
    assert all(drill.restarts(tasks[task]) >= 1 for task in again), again
    assert "finished" in cluster.run("frahm", "status", "array.h5")
    assert "nothing is left to merge" in cluster.run("frahm", "merge", "array.h5")
    told(f"array: tasks {again} ran again, the rest once; merged")


def check_mpi(drill):
    """The MPI job on two nodes: stopped by a signal that the script hands on to the ranks, then requeued by hand."""
    cluster = drill.cluster
    job = drill.submit("--nodes=2", "--ntasks=4", "--time=10", "mpi.sh", "study.toml", "mpi.h5")
    wait_until("the ranks are at work", 30, lambda: at_work(drill, "mpi.h5"))
    cluster.run("scancel", "--signal=USR1", "--batch", job)
    log = f"frahm-{job}.log"
    wait_until("the ranks have stopped", 30, lambda: "goes back into the queue" in open(log).read())
    assert "stopped by SIGUSR1" in open(log).read()
    wait_until("the job runs again", 60, lambda: at_work(drill, "mpi.h5"))
    cluster.run("scontrol", "requeue", job)
    drill.wait_for_end([job])
    assert drill.restarts(job) == 2
    told("mpi: stopped by a signal, requeued, finished")


def check_undisturbed_mpi(drill, raw_bytes):
    """The MPI job on two nodes of a map that check_printed_lines has computed."""
    drill.wait_for_end([drill.submit("--nodes=2", "--ntasks=4", "--time=10", "mpi.sh", "a small study.toml", "mpi.h5",
                                     "--set", "K=8200 N/m")])
    check_same(raw_bytes("mpi.h5"), raw_bytes("small.h5"), "the MPI job")


def check_printed_lines(drill, source, raw_bytes):
    """The lines that `frahm check` prints, given to a shell as they stand; names and values need quoting."""
    reduced_study(source, "a small study.toml", 5, frequencies=101)
    replaced = "--set", "K=8200 N/m"
    printed = drill.cluster.run("frahm", "check", "a small study.toml", *replaced)
    assert "(at most 1001)" in printed, printed  # MaxArraySize of this Slurm
    lines = [line.strip() for line in printed.splitlines() if line.startswith(("  sbatch ", "  frahm merge "))]
    assert len(lines) == 2, printed
    job = drill.cluster.run("sh", "-c", lines[0]).split()[-1]
    drill.wait_for_end([f"{job}_0", f"{job}_1"])
    drill.cluster.run("sh", "-c", lines[1])
    drill.cluster.run("frahm", "run", "a small study.toml", *replaced, "-o", "small.h5")
    check_same(raw_bytes("a small study.h5"), raw_bytes("small.h5"), "the lines that check prints")
    told("the lines that check prints were submitted as they stand")


def check_same(found, expected, what):
    differing = [name for name in {*found, *expected} if found.get(name) != expected.get(name)]
    assert not differing, f"{what}: other bytes in {', '.join(sorted(differing))}"


def reduced_study(source, path, frictions, frequencies=401):
    with open(os.path.join(source, "studies", "rig", "rig_atlas.toml")) as file:
        text = file.read()
    for before, after in ((31, frictions), (401, frequencies)):
        text, count = re.subn(rf"(?m)^points = {before}$", f"points = {after}", text)
        assert count == 1
    # What tasks cost is tuned to the time limits below: by shooting, without borders, which other tests compare.
    text, count = re.subn(r"(?m)^borders = true", 'borders = false\npath = "general"', text)
    assert count == 1
    with open(path, "w") as file:
        file.write(text)


def plain_run(program):
    start = time.monotonic()
    subprocess.run([program, "run", "study.toml", "-o", "plain.h5", "--progress", "none"], check=True,
                   stdout=subprocess.DEVNULL, timeout=120)
    told(f"a plain run: {time.monotonic() - start:.1f} s")


def run_drill(program, source, is_quick):
    sys.path.insert(0, os.path.join(source, "tests", "end_to_end"))
    from same_bytes import raw_bytes
    home = os.getcwd()
    with tempfile.TemporaryDirectory(prefix="frahm-drill-") as folder, Cluster(nodes=3, processors=2) as cluster:
        drill = Drill(program, source, folder, cluster)
        try:
            if is_quick:
                check_printed_lines(drill, source, raw_bytes)
                check_undisturbed_mpi(drill, raw_bytes)
                return
            reduced_study(source, "study.toml", FRICTIONS)
            plain_run(program)
            plain = raw_bytes("plain.h5")
            check_printed_lines(drill, source, raw_bytes)
            check_array(drill)
            check_same(raw_bytes("array.h5"), plain, "the array job")
            check_mpi(drill)
            check_same(raw_bytes("mpi.h5"), plain, "the MPI job")
        except BaseException as error:
            print(cluster.logs(), file=sys.stderr)
            for name in sorted(os.listdir(".")):
                if name.endswith(".log"):
                    lines = open(name, errors="replace").readlines()
                    print(f"--- {name}\n{''.join(lines[-8:])}", file=sys.stderr)
            print(f"--- jobs\n{cluster.run('scontrol', '--oneliner', 'show', 'job')}--- {error!r}", file=sys.stderr)
            raise
        finally:
            os.chdir(home)


def give_up(number, _):
    raise TimeoutError(f"{signal.Signals(number).name}: the drill ends here (its limit is {MOST_SECONDS} s)")


def main():
    program, source, *quick = sys.argv[1:]
    for number in signal.SIGALRM, signal.SIGTERM, signal.SIGHUP:
        signal.signal(number, give_up)
    signal.alarm(MOST_SECONDS)
    start = time.monotonic()
    try:
        run_drill(os.path.abspath(program), os.path.abspath(source), quick == ["--quick"])
    except NotAvailable as reason:
        print(f"slurm: skipped: {reason}", file=sys.stderr)
        return NOT_AVAILABLE
    told(f"array and MPI jobs left the bytes of a plain run in every dataset ({time.monotonic() - start:.0f} s)")
    return 0


if __name__ == "__main__":
    sys.exit(with_init(main))
