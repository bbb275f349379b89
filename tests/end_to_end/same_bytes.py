"""Whoever computes a map, and however often they are killed, every dataset of its file has the same bytes.

usage: same_bytes.py FRAHM SOURCE_DIR
"""

import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

import h5py

KILLS = 10 if os.environ.get("FRAHM_FAULTS") == "all" else 3


def raw_bytes(path):
    """Of each dataset its type, its shape and its stored bytes, chunk by chunk, as compressed, and their order in
    the file."""
    found = {}

    def take(name, item):
        if not isinstance(item, h5py.Dataset):
            return
        if item.chunks is None:
            stored = item[()].tobytes()
        else:
            chunks = [item.id.get_chunk_info(i).chunk_offset for i in range(item.id.get_num_chunks())]
            stored = [(offset, item.id.read_direct_chunk(offset)) for offset in chunks]
            places = [item.id.get_chunk_info(i).byte_offset for i in range(item.id.get_num_chunks())]
            stored.append(sorted(range(len(places)), key=places.__getitem__))
        found[name] = (item.dtype.str, item.shape, stored)

    with h5py.File(path) as file:
        file.visititems(take)
    return found


class Runs:
    def __init__(self, program, folder, study_path):
        self.program, self.folder, self.study = program, folder, study_path

    def start(self, output, *options):
        return subprocess.Popen([self.program, "run", self.study, "-o", output, "--progress", "none", *options],
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def finish(self, output, *options):
        process = self.start(output, *options)
        message = process.communicate()[1]
        assert process.returncode == 0, f"code {process.returncode}: {message}"
        assert sorted(os.listdir(self.folder)) == sorted(["study.toml", os.path.basename(output)]), os.listdir(self.folder)
        found = raw_bytes(output)
        os.remove(output)
        return found

    def killed(self, expected, output, how, *options):
        """Starts again and again, each time killed at a random moment of its work; then to the end. A run that is done
        before its kill does not count, and the next kill comes earlier."""
        stopped, longest = 0, 0.15
        while stopped < KILLS:
            process = self.start(output, *options)
            time.sleep(random.uniform(0.0, longest))
            process.send_signal(how)
            process.communicate()
            if process.returncode == 0:
                os.remove(output)
                longest *= 0.7
                continue
            codes = {signal.SIGKILL: (-signal.SIGKILL,), signal.SIGTERM: (4, -signal.SIGTERM)}[how]
            assert process.returncode in codes, process.returncode
            stopped += 1
            if os.path.exists(output):  # killed behind its work: the file is whole, its logs may still be there
                assert raw_bytes(output) == expected, "a half file"
                break
        assert self.finish(output, *options) == expected, how


def check_tuning(program, source):
    """The starts of a tuning, as the points of a map."""
    with open(os.path.join(source, "studies", "tuning", "tune_classical.toml")) as file:
        text = re.sub(r"(?m)^start .*\n", "", file.read())
    assert text.count("[tune]\n") == 1
    with tempfile.TemporaryDirectory() as folder:
        study_path, output = os.path.join(folder, "study.toml"), os.path.join(folder, "optimum.h5")
        with open(study_path, "w") as file:
            file.write(text.replace("[tune]\n", "[tune]\nstart = 32\n"))
        runs = Runs(program, folder, study_path)
        one = runs.finish(output, "--threads", "1")
        assert one["optimum/start_objective"][1] == (32,)
        assert runs.finish(output, "--threads", "2") == one
        runs.killed(one, output, signal.SIGKILL, "--threads", "2")
        runs.killed(one, output, signal.SIGTERM, "--threads", "1")


def check_assembly(program, source):
    """A map of many chunks with borders, resonances and orbits, assembled whole and in part by teams of any size."""
    with open(os.path.join(source, "studies", "classics", "den_hartog.toml")) as file:
        text = file.read()
    assert text.count("values = [0, 0.02, 0.05, 0.1, 0.2, 0.5]") == 1
    text = text.replace("values = [0, 0.02, 0.05, 0.1, 0.2, 0.5]", "from = 0.02\nto = 0.5\npoints = 12")
    text += """
[output]
quantities = ["main_peak", "friction_regime", "friction_stops", "status"]
borders = true
resonances = ["main"]
orbits = [{ zeta = 0.1, f = 0.2, r = 0.9 }, { zeta = 0.1, f = 0.7, r = 0.4 }, { zeta = 0.2, f = 1.1, r = 2 }]
"""
    with tempfile.TemporaryDirectory() as folder:
        study_path, output = os.path.join(folder, "study.toml"), os.path.join(folder, "map.h5")
        with open(study_path, "w") as file:
            file.write(text)

        def frahm(*words):
            done = subprocess.run([program, *words], capture_output=True, text=True, timeout=120)
            assert done.returncode == 0, done.stderr

        def merged(threads, *options):
            frahm("merge", output, "--threads", threads, *options)
            found = raw_bytes(output)
            os.remove(output)
            return found

        def kept():
            return {name: open(os.path.join(folder, name), "rb").read() for name in os.listdir(folder)}

        frahm("run", study_path, "-o", output, "--shard", "0/2")
        part = merged("1", "--partial")
        assert len(part["main_peak"][2]) > 5 and part["resonance/curve"][1] == (300,), "many chunks, many curves"
        assert part["borders/border"][1][0] > 4096, "chunks of borders"
        for threads in "2", "5":
            assert merged(threads, "--partial") == part, threads
        frahm("run", study_path, "-o", output, "--shard", "1/2")
        logs = kept()
        whole = {}
        for threads in "1", "2", "5":
            for name, data in logs.items():
                with open(os.path.join(folder, name), "wb") as file:
                    file.write(data)
            whole[threads] = merged(threads)
        assert whole["1"] == whole["2"] == whole["5"]
        assert whole["1"] != part
        Runs(program, folder, study_path).killed(whole["1"], output, signal.SIGKILL, "--threads", "2")


def check_motions(program, source):
    """A map of motions with a history, of a frame that starts to shake; shards are merged."""
    with open(os.path.join(source, "studies", "structures", "shaken_frame.toml")) as file:
        text = file.read()
    assert "duration = 20\n" in text
    with tempfile.TemporaryDirectory() as folder:
        study_path, output = os.path.join(folder, "study.toml"), os.path.join(folder, "map.h5")
        with open(study_path, "w") as file:
            file.write(text.replace("duration = 20\n", "duration = 10\n"))
        runs = Runs(program, folder, study_path)
        one = runs.finish(output, "--threads", "1")
        assert one["floor10_peak"][1] == (13, 11) and one["histories/time"][1] == (1001,)
        assert runs.finish(output, "--threads", "2") == one
        for shard in "1/2", "0/2":
            assert runs.start(output, "--shard", shard).wait() == 0
        subprocess.run([program, "merge", output], check=True, capture_output=True)
        assert raw_bytes(output) == one
        os.remove(output)
        runs.killed(one, output, signal.SIGKILL, "--threads", "2")


RECORDS = """
[study]
schema = 1
kind = "transient"
[parameters]
F = { value = 0.5, unit = "N" }
k = { value = 40, unit = "N/m" }
[[mass]]
name = "m"
mass = 1
[[element]]
name = "spring"
type = "spring"
between = ["base", "m"]
stiffness = "k"
[[element]]
name = "friction"
type = "coulomb"
between = ["base", "m"]
force = "F"
[[excitation.record]]
acceleration_of = "base"
"""
GENERATED = 'records = { generate = "kanai_tajimi", count = 3, seed = 4, duration = 10, rate = 50, intensity = 0.01, ' \
            "ground_frequency = 15.6, ground_damping = 0.6 }\n"
SAMPLES = """
[[axis]]
samples = 16
zip = "house"
[[axis.of]]
parameter = "k"
distribution = "normal"
mean = 40
deviation = 4
unit = "N/m"
"""
MOTIONS_OVER_RECORDS = RECORDS + "[transient]\nduration = 10\n[[axis]]\n" + GENERATED + SAMPLES + """
[[axis]]
parameter = "F"
from = 0.1
to = 1.0
points = 10
[output]
quantities = ["m_peak", "m_acceleration_peak", "m_velocity_rms", "friction_slips", "energy_balance", "status"]
histories = [{ record = 1, F = 0.1 }]
"""
TUNING_OVER_RECORDS = RECORDS.replace('"transient"', '"tune"') + '[tune]\nobjective = "worst_peak"\nquantity = "m_peak"\n' \
    "quantile = 0.9\nstart = 6\n" + GENERATED + SAMPLES.replace("samples = 16", "samples = 8") + \
    '[[design]]\nparameter = "F"\nunit = "N"\nlower = 0.0\nupper = 2.0\n'


def check_records(program):
    """Motions over generated records, samples and a parameter, with statistics; and the starts of a tuning over them."""
    for study, expected in ((MOTIONS_OVER_RECORDS, ("m_peak", (3, 16, 10))),
                            (TUNING_OVER_RECORDS, ("optimum/start_objective", (6,)))):
        with tempfile.TemporaryDirectory() as folder:
            study_path, output = os.path.join(folder, "study.toml"), os.path.join(folder, "map.h5")
            with open(study_path, "w") as file:
                file.write(study)
            runs = Runs(program, folder, study_path)
            one = runs.finish(output, "--threads", "1")
            assert one[expected[0]][1] == expected[1], one[expected[0]][1]
            assert runs.finish(output, "--threads", "2") == one
            for shard in "1/2", "0/2":
                assert runs.start(output, "--shard", shard).wait() == 0
            subprocess.run([program, "merge", output], check=True, capture_output=True)
            assert raw_bytes(output) == one
            os.remove(output)
            runs.killed(one, output, signal.SIGKILL, "--threads", "2")


def check_several_responses(program, source):
    """Maps of stops, where several responses are searched or the frequency is swept, and of a shock absorber's table,
    where there is one."""
    swept = [("points = 141", "points = 71"),
             ("[[axis]]", "[[axis]]\nparameter = \"D\"\nfrom = 0.4\nto = 1.5\npoints = 8\n\n[[axis]]")]
    changes = [
        ("machine_on_stops", swept),
        ("machine_on_stops", [*swept, ('show = "up"\n\n[compare]\nshow = "down"', "starts = 16")]),
        ("bump_and_rebound", [("values = [600, 1200, 2400]", "from = 600\nto = 2400\npoints = 60")]),
    ]
    for name, replacements in changes:
        with open(os.path.join(source, "studies", "stops", name + ".toml")) as file:
            text = file.read()
        for passage, by in replacements:
            assert passage in text, passage
            text = text.replace(passage, by, 1)
        with tempfile.TemporaryDirectory() as folder:
            study_path, output = os.path.join(folder, "study.toml"), os.path.join(folder, "map.h5")
            with open(study_path, "w") as file:
                file.write(text)
            runs = Runs(program, folder, study_path)
            one = runs.finish(output, "--threads", "1")
            assert one["coexisting"][1] in [(8, 71), (60, 46)]
            assert runs.finish(output, "--threads", "5") == one, name
        # Kills of such maps: those of check_assembly and main, which resume by the same log.


def main():
    random.seed(2)
    program, source = sys.argv[1:]
    check_motions(program, source)
    check_records(program)
    check_several_responses(program, source)
    check_tuning(program, source)
    check_assembly(program, source)
    with tempfile.TemporaryDirectory() as folder:
        study_path, output = os.path.join(folder, "study.toml"), os.path.join(folder, "map.h5")
        with open(os.path.join(source, "studies", "classics", "den_hartog.toml")) as file, open(study_path, "w") as fewer:
            fewer.write(file.read().replace("points = 481\n", "points = 241\n"))
        runs = Runs(program, folder, study_path)
        one = runs.finish(output, "--threads", "1")
        assert len(one) > 10 and one["main_peak"][1] == (6, 25, 241)
        assert runs.finish(output, "--threads", "5") == one
        runs.killed(one, output, signal.SIGKILL, "--threads", "2")
        runs.killed(one, output, signal.SIGTERM, "--threads", "1")
    print("maps, motions over records, an assembly and tunings on 1, 2 and more threads, SIGKILL and SIGTERM: the same bytes in every dataset")


if __name__ == "__main__":
    main()
