"""Runs the job scripts of studies/slurm on a real Slurm, with everything that befalls jobs on a cluster: requeued by
hand, stopped by the time limit, their node killed. The result has the bytes of one plain run.

usage: drill.py FRAHM SOURCE_DIR
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
MOST_SECONDS = 420  # of the whole drill; two minutes on two idle cores
TASKS = 6  # two on each of three nodes, so that all run at once
FRICTIONS = 100  # values of the atlas' second axis instead of 31: some seconds for each task
NOTICE = 4.0  # seconds between the submission and slurmctld's look at the time limits


class Drill:
    def __init__(self, program, source, folder, cluster):
        self.program, self.folder, self.cluster = program, folder, cluster
        self.scripts = os.path.join(source, "studies", "slurm")
        cluster.environment["PATH"] = os.path.dirname(program) + ":" + cluster.environment["PATH"]
        # Open MPI as root, between nodes that are one machine.
        cluster.environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                   OMPI_MCA_rmaps_base_oversubscribe="1")
        os.chdir(folder)

    def submit(self, *words):
        script = [os.path.join(self.scripts, word) if word.endswith(".sh") else word for word in words]
        return self.cluster.run("sbatch", "--parsable", *script).strip()

    def status(self, output):
        return self.cluster.run("frahm", "status", output)

    def fields(self, job):
        return dict(re.findall(r"(\w+)=(\S*)", self.cluster.run("scontrol", "show", "job", job)))

    def ended_well(self, job):
        state = self.fields(job)["JobState"]
        assert state in ("PENDING", "RUNNING", "COMPLETING", "COMPLETED", "REQUEUED"), f"job {job}: {state}"
        return state == "COMPLETED"

    def wait_for_end(self, jobs, seconds=150):
        wait_until(f"jobs {', '.join(jobs)} have ended", seconds, lambda: all([self.ended_well(job) for job in jobs]))

    def restarts(self, job):
        return int(self.fields(job)["Restarts"])

    def wait_for_time_check(self):
        time.sleep((self.cluster.seconds_to_time_check() - NOTICE) % 30)


def told(text):
    print(f"slurm: {text}", flush=True)


def check_array(drill):
    """The array job: one task requeued, one stopped by its time limit, one node killed; merged by a job of its own."""
    cluster = drill.cluster
    drill.wait_for_time_check()
    array = drill.submit(f"--array=0-{TASKS - 1}", "--time=10", "array.sh", str(TASKS), "study.toml", "array.h5")
    merge = drill.submit(f"--dependency=afterok:{array}", "--time=10", "merge.sh", "array.h5")
    everybody = f"{TASKS} of {TASKS} array tasks: 0-{TASKS - 1}"
    wait_until("all tasks are at work", 20, lambda: os.path.exists("frahm-%s_%d.log" % (array, TASKS - 1)) and
               everybody in subprocess.run(["frahm", "status", "array.h5"], env=cluster.environment, capture_output=True,
                                           text=True, timeout=20).stdout)
    # Now its time is up, 90 s before which Slurm gives notice: at slurmctld's next look.
    cluster.run("scontrol", "update", f"JobId={array}_2", "TimeLimit=1")
    status = drill.status("array.h5")
    assert re.search(r"points +\d+ of \d+ done", status) and f"--array=0-{TASKS - 1}" in status, status
    cluster.run("scontrol", "requeue", f"{array}_1")
    victims = {task: drill.fields(f"{array}_{task}")["NodeList"] for task in range(TASKS)}
    node = next(node for node in victims.values() if node not in (victims[1], victims[2]))
    cluster.kill_node(node)
    cluster.run("scontrol", "update", f"NodeName={node}", "State=DOWN", "Reason=drill")
    wait_until("task 2 is stopped by its time limit", 40,
               lambda: "goes back into the queue" in open(f"frahm-{array}_2.log").read())
    told("array: task 1 requeued, task 2 stopped by its time limit, node %s killed" % node)
    print(drill.status("array.h5"), end="")
    cluster.start_node(node)
    cluster.run("scontrol", "update", f"NodeName={node}", "State=RESUME")
    tasks = [f"{array}_{task}" for task in range(TASKS)]
    drill.wait_for_end([*tasks, merge])
    assert "stopped by SIGUSR1" in open(f"frahm-{array}_2.log").read()
    again = [task for task, where in victims.items() if task in (1, 2) or where == node]
    assert all(drill.restarts(tasks[task]) >= 1 for task in again), again
    assert "finished" in drill.status("array.h5")
    assert "nothing is left to merge" in cluster.run("frahm", "merge", "array.h5")
    told(f"array: tasks {again} ran again, the rest once; merged")


def check_mpi(drill):
    """The MPI job: stopped by a signal that the script hands on to the ranks, then requeued by hand."""
    cluster = drill.cluster
    job = drill.submit("--nodes=1", "--ntasks=2", "--time=10", "mpi.sh", "study.toml", "mpi.h5")
    running = lambda: subprocess.run(["frahm", "status", "mpi.h5"], env=cluster.environment, capture_output=True, text=True,
                                     timeout=20).stdout
    wait_until("the ranks are at work", 30, lambda: "a run of the whole" in running())
    cluster.run("scancel", "--signal=USR1", "--batch", job)
    log = f"frahm-{job}.log"
    wait_until("the ranks have stopped", 30, lambda: "goes back into the queue" in open(log).read())
    assert "stopped by SIGUSR1" in open(log).read()
    wait_until("the job runs again", 60, lambda: "a run of the whole" in running())
    cluster.run("scontrol", "requeue", job)
    drill.wait_for_end([job])
    assert drill.restarts(job) == 2
    told("mpi: stopped by a signal, requeued, finished")


def reduced_study(source, path):
    with open(os.path.join(source, "studies", "rig_atlas.toml")) as file:
        text, count = re.subn(r"(?m)^points = 31$", f"points = {FRICTIONS}", file.read())
    assert count == 1
    with open(path, "w") as file:
        file.write(text)


def plain_run(program):
    start = time.monotonic()
    subprocess.run([program, "run", "study.toml", "-o", "plain.h5", "--progress", "none"], check=True,
                   stdout=subprocess.DEVNULL, timeout=120)
    told(f"a plain run: {time.monotonic() - start:.1f} s")


def run_drill(program, source):
    sys.path.insert(0, os.path.join(source, "tests", "end_to_end"))
    from same_bytes import raw_bytes
    home = os.getcwd()
    with tempfile.TemporaryDirectory(prefix="frahm-drill-") as folder, Cluster(nodes=3, processors=2) as cluster:
        drill = Drill(program, source, folder, cluster)
        try:
            reduced_study(source, "study.toml")
            plain_run(program)
            plain = raw_bytes("plain.h5")
            check_array(drill)
            assert raw_bytes("array.h5") == plain, "the array job's file has other bytes"
            check_mpi(drill)
            assert raw_bytes("mpi.h5") == plain, "the MPI job's file has other bytes"
        except BaseException:
            for name in sorted(os.listdir(".")):
                if name.endswith(".log"):
                    print(f"--- {name}\n{open(name, errors='replace').read()}", file=sys.stderr)
            print(cluster.logs(), file=sys.stderr)
            raise
        finally:
            os.chdir(home)


def give_up(number, _):
    raise TimeoutError(f"{signal.Signals(number).name}: the drill ends here (its limit is {MOST_SECONDS} s)")


def main():
    program, source = map(os.path.abspath, sys.argv[1:])
    for number in signal.SIGALRM, signal.SIGTERM, signal.SIGHUP:
        signal.signal(number, give_up)
    signal.alarm(MOST_SECONDS)
    start = time.monotonic()
    try:
        run_drill(program, source)
    except NotAvailable as reason:
        print(f"slurm: skipped: {reason}", file=sys.stderr)
        return NOT_AVAILABLE
    told(f"array and MPI jobs left the bytes of a plain run in every dataset ({time.monotonic() - start:.0f} s)")
    return 0


if __name__ == "__main__":
    sys.exit(with_init(main))
