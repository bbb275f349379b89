"""A Slurm cluster of several nodes on this one machine, in a folder of its own.

Everything it starts, and whatever that starts, is a descendant of with_init() and ends with it.
"""

import ctypes
import os
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

PROGRAMS = "munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "scancel", "sinfo"
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"  # where Debian keeps the daemons
CREDENTIAL_SECONDS = 5  # of a job; Slurm starts no requeued job before they are over (120 by default)
TIME_CHECK_SECONDS = 30  # slurmctld looks at the time limits of jobs once in so many (PERIODIC_TIMEOUT)

CONFIGURATION = """\
ClusterName=drill
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire={credential_seconds}
CryptoType=crypto/munge
SlurmctldPort={port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/slurmd.%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
JobRequeue=1
KillWait=2
"""


class NotAvailable(Exception):
    """Slurm is not installed here, or cannot run here."""


def _free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def _die_with_parent(how=signal.SIGKILL):
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, how, 0, 0, 0)


def _stat(pid):
    """State and parent of a process; nothing if it has ended meanwhile."""
    try:
        with open(f"/proc/{pid}/stat") as stat:
            state, parent = stat.read().rpartition(")")[2].split()[:2]
        return state, int(parent)
    except OSError:
        return None


def _parent(pid):
    found = _stat(pid)
    return found[1] if found else os.getpid()


def descendants(pid):
    """The living ones."""
    children = {}
    for entry in map(int, filter(str.isdigit, os.listdir("/proc"))):
        found = _stat(entry)
        if found and found[0] != "Z":
            children.setdefault(found[1], []).append(entry)
    found, ahead = [], [pid]
    while ahead:
        some = children.get(ahead.pop(), [])
        found += some
        ahead += some
    return found


def _has_in_environment(pid, setting):
    try:
        with open(f"/proc/{pid}/environ", "rb") as environment:
            return setting.encode() in environment.read().split(b"\0")
    except OSError:
        return False


def _kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def _end_descendants(pid, but=()):
    end = time.monotonic() + 20
    while time.monotonic() < end:
        left = set(descendants(pid)) - set(but)
        if not left:
            return
        for one in left:
            _kill(one)
        time.sleep(0.05)


def with_init(work):
    """Carries out work() in a child, for its exit code. This process is init for it: it adopts the orphans of daemons,
    buries the dead at once (Slurm takes a zombie for a job that will not end), and ends all when the work is done,
    however that ended."""
    pr_set_child_subreaper = 36
    ctypes.CDLL(None).prctl(pr_set_child_subreaper, 1, 0, 0, 0)
    child = os.fork()
    if child == 0:
        _die_with_parent(signal.SIGTERM)
        sys.exit(work())
    for number in signal.SIGTERM, signal.SIGHUP, signal.SIGINT:
        signal.signal(number, lambda number, _: os.kill(child, signal.SIGTERM))
    pid, status = os.wait()
    while pid != child:
        pid, status = os.wait()
    burying = threading.Thread(target=_bury_all, daemon=True)
    burying.start()
    _end_descendants(os.getpid())
    return os.waitstatus_to_exitcode(status) if os.WIFEXITED(status) else 1


def _bury_all():
    try:
        while True:
            os.wait()
    except ChildProcessError:
        pass


def wait_until(what, seconds, holds):
    """Looks until holds() gives something true, and returns it."""
    end = time.monotonic() + seconds
    while True:
        found = holds()
        if found:
            return found
        if time.monotonic() > end:
            raise TimeoutError(f"after {seconds} s still not: {what}")
        time.sleep(0.1)


class Cluster:
    """To be used within with_init()."""

    def __init__(self, nodes, processors):
        missing = [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]
        if missing:
            raise NotAvailable("not installed: " + ", ".join(missing) + " (Debian: slurm-wlm, munge)")
        self.nodes, self.processors = [f"n{i + 1}" for i in range(nodes)], processors
        self.folder = tempfile.mkdtemp(prefix="frahm-slurm-")
        self.environment = {**os.environ, "PATH": PATH, "SLURM_CONF": os.path.join(self.folder, "slurm.conf")}
        self.daemons = {}
        self.init = os.getppid()

    def __enter__(self):
        try:
            self._write_configuration()
            self._start()
        except (OSError, subprocess.SubprocessError, TimeoutError) as error:
            logs = self.logs()
            self.stop()
            raise NotAvailable(f"Slurm does not start here: {error}\n{logs}") from error
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_):
        self.stop()

    def _write_configuration(self):
        for name in "state", "log", "spool", "munge":
            os.mkdir(os.path.join(self.folder, name), 0o700)
        with open(os.open(os.path.join(self.folder, "munge", "key"), os.O_CREAT | os.O_WRONLY, 0o400), "wb") as key:
            key.write(os.urandom(1024))
        host = socket.gethostname().split(".")[0]
        port, *node_ports = _free_ports(1 + len(self.nodes))
        lines = [CONFIGURATION.format(folder=self.folder, host=host, port=port, user=pwd.getpwuid(os.getuid()).pw_name,
                                      credential_seconds=CREDENTIAL_SECONDS)]
        for name, node_port in zip(self.nodes, node_ports):
            os.mkdir(os.path.join(self.folder, "spool", name))
            lines.append(f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={node_port} "
                         f"CPUs={self.processors} State=UNKNOWN\n")
        lines.append(f"PartitionName=main Nodes={','.join(self.nodes)} Default=YES MaxTime=60 State=UP\n")
        with open(self.environment["SLURM_CONF"], "w") as file:
            file.writelines(lines)

    def _daemon(self, name, *command):
        with open(os.path.join(self.folder, "log", name + ".out"), "ab") as output:
            self.daemons[name] = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=output,
                                                  stderr=output, preexec_fn=_die_with_parent)

    def _start(self):
        munge = os.path.join(self.folder, "munge")
        self._daemon("munged", "munged", "--foreground", "--force", f"--key-file={munge}/key", f"--socket={munge}/socket",
                     f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        wait_until("munged is there", 10, lambda: os.path.exists(f"{munge}/socket"))
        self._daemon("slurmctld", "slurmctld", "-D", "-f", self.environment["SLURM_CONF"])
        self.started = time.monotonic()
        for node in self.nodes:
            self.start_node(node)
        wait_until("every node is idle", 30, lambda: self._idle_nodes() == len(self.nodes))

    def start_node(self, node):
        self._daemon(node, "slurmd", "-D", "-f", self.environment["SLURM_CONF"], "-N", node)

    def kill_node(self, node):
        """SIGKILL to the node's daemon, and to the jobs on it and their keepers: the node is gone without a word."""
        daemon = self.daemons.pop(node)
        jobs = [pid for pid in descendants(self.init) if _has_in_environment(pid, f"SLURMD_NODENAME={node}")]
        keepers = {_parent(pid) for pid in jobs} - {self.init, *jobs}
        for pid in [daemon.pid, *keepers, *jobs]:
            _kill(pid)
        daemon.wait()
        # One that waits for the disk dies, and lets go of its files, only when the disk has answered.
        wait_until(f"the processes of {node} are gone", 60, lambda: not {*keepers, *jobs} & {*descendants(self.init)})

    def _idle_nodes(self):
        found = subprocess.run(["sinfo", "-hN", "-o", "%T"], env=self.environment, capture_output=True, text=True, timeout=20)
        return found.stdout.split().count("idle")

    def run(self, *command, seconds=60):
        """A command that has to succeed; its output."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=seconds)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def seconds_to_time_check(self):
        return TIME_CHECK_SECONDS - (time.monotonic() - self.started) % TIME_CHECK_SECONDS

    def logs(self):
        text = ""
        for place in "log", "munge":
            folder = os.path.join(self.folder, place)
            for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else ():
                if name.startswith(("key", "seed", "socket", "pid")):
                    continue
                with open(os.path.join(folder, name), errors="replace") as file:
                    text += f"--- {name}\n" + "".join(file.readlines()[-15:])
        return text

    def stop(self):
        """Ends the daemons, all their descendants, and removes the folder."""
        for daemon in self.daemons.values():
            daemon.kill()
            daemon.wait(timeout=10)
        _end_descendants(self.init, but=[os.getpid()])
        shutil.rmtree(self.folder, ignore_errors=True)
