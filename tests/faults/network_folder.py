"""Runs in a folder that lies on a network: sshfs over TCP from this machine to itself. Kills, lost connections and two
machines at work on shards leave the same bytes.

usage: network_folder.py FRAHM SOURCE_DIR   (ends with 77 where such a folder cannot be had)
"""

import contextlib
import errno
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

from faulty_runs import EVERYTHING, OUTPUT, Expected, Place, ended, explains, larger_sweep, main, tiles_of_log

NOT_AVAILABLE = 77
SFTP_SERVER = "/usr/lib/openssh/sftp-server"
KILLS, CUTS, STARTS = (3, 2, 10) if EVERYTHING else (1, 1, 3)
STOPPED = 4  # the exit code of a run that its time budget stopped


class NetworkPlace(Place):
    """A file that is removed while it is open has a name of FUSE's own until it is closed, which may come a moment later."""

    def names(self):
        return [name for name in super().names() if not name.startswith(".fuse_hidden")]


class Server:
    """Serves the files of this machine by SFTP, on a port of the loopback interface."""

    def __init__(self):
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.sessions = []
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            connection, _ = self.socket.accept()
            with connection:
                self.sessions.append(subprocess.Popen([SFTP_SERVER], stdin=connection, stdout=connection))

    def cut(self):
        """Ends all connections, as a network that fails."""
        for session in self.sessions:
            session.kill()
            session.wait()
        self.sessions.clear()


@contextlib.contextmanager
def mounted(server, folder, at):
    os.makedirs(at, exist_ok=True)
    subprocess.run(["sshfs", "-o", f"directport={server.port},cache=no", f"127.0.0.1:{folder}", at], check=True,
                   capture_output=True)
    try:
        yield at
    finally:
        subprocess.run(["fusermount", "-u", "-z", at], check=False, capture_output=True)  # a lost one is gone


def until_tiles(place, process, log="shard-0-of-1"):
    """Waits until the log of a run at work has tiles."""
    name = f"{OUTPUT}.{log}.frahm-log"
    while process.poll() is None:
        with contextlib.suppress(FileNotFoundError):
            if tiles_of_log(place.read(name)):
                return
        time.sleep(0.005)


def start(place, *options):
    return place.start("run", "study.toml", "-o", OUTPUT, "--progress", "none", "--threads", "1", *options)


def kill_runs(place, expected):
    for _ in range(KILLS):
        process = start(place)
        until_tiles(place, process)
        time.sleep(random.uniform(0.0, 0.2))
        process.send_signal(signal.SIGKILL)
        ended(process)
    expected.check_resume(place, "killed in a folder on the network")


def lose_connections(bench, server, folder, at, study, expected):
    for number in range(CUTS):
        with mounted(server, folder, at):
            place = NetworkPlace(bench, at, study)
            place.clear()
            process = start(place)
            until_tiles(place, process)
            server.cut()
            outcome = ended(process)
        case = f"connection {number} lost"
        assert outcome.code == 6, f"{case}: {outcome}"
        reasons = (errno.EIO, errno.ENOTCONN, errno.ECONNABORTED)
        assert any(explains(outcome, reason) for reason in reasons), f"{case}: {outcome}"
        with mounted(server, folder, at):
            place = NetworkPlace(bench, at, study)
            kept = sum(len(tiles_of_log(place.read(log))) for log in place.logs())
            assert kept > 0, f"{case}: its tiles are lost"
            expected.check_resume(place, case)


def share(bench, server, folder, ats, study, expected):
    """Two machines see the folder; each computes a shard, and one makes the file."""
    with mounted(server, folder, ats[0]), mounted(server, folder, ats[1]):
        places = [NetworkPlace(bench, at, study) for at in ats]
        places[0].clear()
        # No locks are shared: both write the same note, and may take the other's part of it for a dead one.
        for _ in range(STARTS):
            for shard in [start(place, "--shard", f"{number}/2", "--time-budget", "1s") for number, place in enumerate(places)]:
                outcome = ended(shard)
                assert outcome.code in (0, STOPPED), outcome
        for number, place in enumerate(places):
            outcome = ended(start(place, "--shard", f"{number}/2"))
            assert outcome.code == 0, outcome
        outcome = places[0].call("merge", OUTPUT)
        assert outcome.code == 0, outcome
        expected.check_file(places[1], "shards of two machines")


def drill(bench):
    if shutil.which("sshfs") is None or not os.path.exists(SFTP_SERVER) or not os.access("/dev/fuse", os.W_OK):
        print("no folder on a network can be had here: sshfs, sftp-server or /dev/fuse is missing")
        sys.exit(NOT_AVAILABLE)
    random.seed(8)
    study, server = larger_sweep(bench.source), Server()
    expected = Expected(bench.place(study))
    folder, *ats = [os.path.join(bench.folder, name) for name in ("far", "near", "nearby")]
    os.makedirs(folder)
    with mounted(server, folder, ats[0]) as at:
        kill_runs(NetworkPlace(bench, at, study), expected)
    lose_connections(bench, server, folder, ats[0], study, expected)
    share(bench, server, folder, ats, study, expected)
    print(f"{KILLS} kills, {CUTS} lost connections, 2 shards at once", flush=True)


if __name__ == "__main__":
    main(drill)
