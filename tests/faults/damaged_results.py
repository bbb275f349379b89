"""Result files that are damaged or made to do harm: each is read right or refused with a word about it (exit 6), never
with a signal, an internal error, or the contents of another file.

usage: damaged_results.py FRAHM SOURCE_DIR
"""

import os
import random
import re
import shutil
import subprocess

import h5py
import numpy as np

from faulty_runs import EVERYTHING, OUTPUT, in_parallel, main, sampled, sweep_study, tuning_study

SEED = 24
COMMANDS = ("status", OUTPUT), ("export", OUTPUT, "-o", "table.csv"), ("report", OUTPUT, "-o", "page.html")
SECRET = "a line of a file that no result holds"


def made(bench, study):
    place = bench.place(study)
    outcome = place.run("--progress", "none")
    assert outcome.code in (0, 3), outcome
    return place.read(OUTPUT)


def decay_study(bench):
    with open(os.path.join(bench.source, "studies", "lecture", "lecture_free_vibration_friction.toml")) as file:
        return file.read()


def small_map(bench):
    return sweep_study(bench.source).replace("points = 129", "points = 9").replace("points = 12", "points = 2")


def check(place, case, codes=(0, 6), words=None, commands=COMMANDS):
    """Each command ends with one of the codes and without an internal error; a refusal says `words`."""
    for command in commands:
        outcome = place.call(*command)
        text = f"{case}: {command[0]}: {outcome}"
        assert outcome.code in codes, text
        assert "internal error" not in outcome.err and SECRET not in outcome.out, text
        if words is not None and outcome.code == 6:
            assert re.search(words, outcome.err), text
        for name in ("table.csv", "page.html"):
            if os.path.exists(place.path(name)):
                with open(place.path(name), errors="replace") as file:
                    assert SECRET not in file.read(), text
                os.remove(place.path(name))
        left = [name for name in place.names() if ".part" in name or "core" in name]
        assert not left, f"{text}: left over {left}"


def place_of(bench, data, name=OUTPUT):
    place = bench.place("")
    place.write(name, data)
    return place


def check_flips(bench, results):
    rng = random.Random(SEED)
    cases = []
    for kind, data in results.items():
        for _ in range(2000 if EVERYTHING else 15):
            cases.append((kind, [rng.randrange(len(data)) for _ in range(rng.choice((1, 1, 8)))], rng.randrange(1, 256)))
        # HDF5's own structures lie before and between the data: bytes near its signatures.
        marks = [m.start() for m in re.finditer(rb"OHDR|OCHK|GCOL|FRHP|FSHD|FHDB|FHIB|BTHD|BTLF|TREE|HEAP|SNOD|FAHD|EAHD", data)]
        for at in sampled(marks, 15):
            cases.append((kind, [min(len(data) - 1, at + rng.randrange(4, 64))], rng.randrange(1, 256)))

    def one(case):
        kind, places, bits = case
        data = bytearray(results[kind])
        for at in places:
            data[at] ^= bits
        check(place_of(bench, bytes(data)), f"{kind}: bytes {places} ^ {bits}", codes=(0, 2, 6),
              commands=COMMANDS[:2] if not EVERYTHING else COMMANDS)

    in_parallel(one, cases)
    print(f"{len(cases)} results with wrong bytes", flush=True)


def check_cuts(bench, data):
    for size in sampled(range(0, len(data), max(1, len(data) // 200)), 6):
        check(place_of(bench, data[:size]), f"cut to {size} bytes", codes=(6,))


def changed(bench, data, change):
    """A place with a result that `change` (of an open h5py file) has changed."""
    place = place_of(bench, data)
    with h5py.File(place.path(OUTPUT), "r+") as file:
        change(file, place)
    return place


def replace(file, name, **how):
    """A dataset anew, with the attributes of the one there."""
    attributes = {key: file[name].attrs[key] for key in file[name].attrs
                  if key in ("units", "long_name", "CLASS", "NAME", "flag_values", "flag_meanings")}
    del file[name]
    dataset = file.create_dataset(name, **how)
    for key, value in attributes.items():
        dataset.attrs[key] = value
    return dataset


def external(file, place):
    with open(place.path("secret"), "w") as secret:
        secret.write((SECRET + "\n") * 1000)
    shape = file["main_peak"].shape
    del file["main_peak"]
    creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    creation.set_external(place.path("secret").encode(), 0, int(np.prod(shape)) * 8)
    h5py.h5d.create(file.id, b"main_peak", h5py.h5t.IEEE_F64LE, h5py.h5s.create_simple(shape), creation)


def virtual(file, place):
    shape = file["main_peak"].shape
    with h5py.File(place.path("other.h5"), "w") as other:
        other["x"] = np.ones(shape)
    del file["main_peak"]
    layout = h5py.VirtualLayout(shape=shape, dtype="f8")
    layout[...] = h5py.VirtualSource(place.path("other.h5"), "x", shape=shape)
    file.create_virtual_dataset("main_peak", layout)


def external_link(file, place):
    with h5py.File(place.path("other.h5"), "w") as other:
        other.create_group("x")
    file["group"] = h5py.ExternalLink(place.path("other.h5"), "/x")


def fifo_link(file, place):
    os.mkfifo(place.path("pipe"))
    file["group"] = h5py.ExternalLink(place.path("pipe"), "/x")


def cycle(file, place):
    group = file.create_group("loop")
    group["again"] = file["/"]


def deep(file, place):
    group = file
    for _ in range(100_000 if EVERYTHING else 3000):
        group = group.create_group("g")


def many(file, place):
    """2^40 ways through 40 groups."""
    groups = [file.create_group("many")]
    for i in range(40):
        groups.append(file.create_group(f"n{i}"))
    for above, below in zip(groups, groups[1:]):
        above["a"] = below
        above["b"] = below


def doubles_for_references(file, place):
    for name in list(file):
        item = file[name]
        for key in ("DIMENSION_LIST", "REFERENCE_LIST"):
            if isinstance(item, h5py.Dataset) and key in item.attrs:
                del item.attrs[key]
                item.attrs[key] = np.arange(200.0)


def objects(rows):
    """Rows of different lengths, as h5py takes them."""
    array = np.empty(len(rows), dtype=object)
    array[:] = rows
    return array


# What is no list of dimensions: value and type of the attribute.
NO_LISTS = {
    "doubles": lambda file: (np.arange(200.0), None),
    "a few doubles": lambda file: (np.arange(7.0), None),
    "one number": lambda file: (np.int64(3), None),
    "plain references": lambda file: (np.array([file["r"].ref] * 2, dtype=h5py.ref_dtype), None),
    "regions": lambda file: (np.array([file["r"].regionref[0:1]] * 2, dtype=h5py.regionref_dtype), None),
    "a text": lambda file: (b"abc", "S3"),
    "nothing": lambda file: (h5py.Empty("f8"), None),
    "lists of numbers": lambda file: (objects([np.arange(3.0), np.arange(2.0)]), h5py.vlen_dtype("f8")),
    "too many lists": lambda file: (objects([np.array([file["r"].ref], dtype=h5py.ref_dtype) for _ in range(9)]),
                                    h5py.vlen_dtype(h5py.ref_dtype)),
}


def replace_list(name, kind):
    def change(file, place):
        value, dtype = NO_LISTS[kind](file)
        del file[name].attrs["DIMENSION_LIST"]
        file[name].attrs.create("DIMENSION_LIST", value, dtype=dtype)
    return change


def null_space(file, place):
    name = "main_peak"
    del file[name]
    file.create_dataset(name, data=h5py.Empty("f8"))


def flat_scale(file, place):
    replace(file, "r", data=np.ones((3, 3)))


def empty_axis(file, place):
    replace(file, "r", shape=(0,), dtype="f8")


def endless(file, place):
    replace(file, "r", shape=(2**61,), dtype="f8", chunks=(2**20,))


def sparse(file, place):
    replace(file, "r", shape=(2**36,), dtype="f8", chunks=(2**20,))


def text_for_number(file, place):
    file.attrs["format_version"] = "one"


def wrong_flags(file, place):
    file["status"].attrs["flag_values"] = np.array([-5, 300], dtype="i4")


def escapes(file, place):
    file.attrs["title"] = "a \x1b[31mred\x1b[0m \u009b31m title\x07"


def huge_text(file, place):
    file.attrs.create("title", np.zeros(2**16, dtype="S1024"))


REFUSED = {
    "external storage": (external, "another file"),
    "a virtual dataset": (virtual, "other files"),
    "an external link": (external_link, "link to another file"),
    "a link to a pipe": (fifo_link, "link to another file"),
    "a cycle of groups": (cycle, "nested deeper"),
    "groups far too deep": (deep, "nested deeper"),
    "many ways through few groups": (many, "nested deeper|objects"),
    "a dataset without an extent": (null_space, "holds no data"),
    "a scale of two dimensions": (flat_scale, "one dimension"),
    "an axis of size zero": (empty_axis, "axis"),
    "2^61 values": (endless, "has more values"),
    "2^36 values and none stored": (sparse, "do not fit in"),
    "a text for a number": (text_for_number, "must be numbers"),
    "flags out of range": (wrong_flags, "flag value"),
}


def check_made_to_harm(bench, data):
    for case, (change, words) in REFUSED.items():
        check(changed(bench, data, change), case, codes=(6,), words=words)
    check(changed(bench, data, doubles_for_references), "doubles for references", codes=(0, 6))
    for kind in NO_LISTS:
        for name in ("main_peak", "status"):
            place = changed(bench, data, replace_list(name, kind))
            check(place, f"{kind} for the dimensions of {name}", codes=(6,), words="DIMENSION_LIST",
                  commands=COMMANDS[1:] + (("merge", OUTPUT),))
    check(changed(bench, data, huge_text), "an array of texts for the title", codes=(6,))
    place = changed(bench, data, escapes)
    outcome = place.call("status", OUTPUT)
    assert outcome.code == 0 and not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f]", outcome.out), repr(outcome.out)
    place = bench.place(small_map(bench))
    os.mkfifo(place.path("pipe.h5"))
    outcome = place.run("--from", "pipe.h5")
    assert outcome.code == 6 and "pipe" in outcome.err, outcome
    print(f"{len(REFUSED) + 4 + 2 * len(NO_LISTS)} results made to do harm", flush=True)


def check_repacked(bench, data):
    """Another layout of the same values is a result like any other."""
    first = place_of(bench, data)
    assert first.call(*COMMANDS[1]).code == 0
    for options in (("-l", "CONTI"), ("-f", "NONE"), ("-l", "CHUNK=1x1x1"), ("-f", "GZIP=9"), ("-L",)):
        place = place_of(bench, data, "first.h5")
        repacked = subprocess.run(["h5repack", *options, place.path("first.h5"), place.path(OUTPUT)], capture_output=True)
        if repacked.returncode != 0:
            continue  # of this layout h5repack cannot make one
        for command in COMMANDS:
            outcome = place.call(*command)
            assert outcome.code == 0, f"h5repack {options}: {outcome}"
        assert place.read("table.csv") == first.read("table.csv"), f"h5repack {options}"
        again = place_of(bench, place.read(OUTPUT))
        again.write("study.toml", small_map(bench).encode())
        outcome = again.call("run", "study.toml", "-o", "new.h5", "--from", OUTPUT, "--progress", "none")
        assert outcome.code == 0, f"h5repack {options}: {outcome}"


def check_embedded_study(bench, data):
    """A study in a result names a pipe or an endless device: it is not waited for."""
    for named in "pipe", "/dev/zero":
        def change(file, place):
            os.mkfifo(place.path("pipe"))
            text = file["provenance"].attrs["study"]
            text = (text.decode() if isinstance(text, bytes) else text).replace(
                "[excitation]", f'[matrices]\nmass = "{named}"\n[excitation]', 1)
            file["provenance"].attrs["study"] = text
            del file["provenance"].attrs["checksum"]  # as in a file of an earlier version

        place = changed(bench, data, change)
        check(place, f"an embedded study that names {named}", codes=(0, 2, 6), commands=COMMANDS)
        outcome = place.call("run", "study.toml", "-o", "other.h5", "--from", OUTPUT)
        assert outcome.code in (2, 5, 6), outcome
        study = small_map(bench).replace("[excitation]", f'[matrices]\nmass = "{named}"\n[excitation]', 1)
        place.write("study.toml", study.encode())
        outcome = place.call("check", "study.toml")
        assert outcome.code == 2 and "internal error" not in outcome.err, outcome


def check_changed_texts(bench, data):
    """A stored study, or another text of where a result comes from, that is not the one that was written."""
    for name in "study", "overrides", "fingerprint_grid":
        def change(file, _):
            file["provenance"].attrs.modify(name, "r = 1")

        place = changed(bench, data, change)
        place.write("study.toml", small_map(bench).encode())
        growing = ("run", "study.toml", "-o", "new.h5", "--from", OUTPUT, "--progress", "none")
        for command in *COMMANDS, growing, ("run", "study.toml", "-o", OUTPUT, "--progress", "none"):
            outcome = place.call(*command)
            if name == "fingerprint_grid" and command[0] == "run":  # another study's result
                assert outcome.code in (5, 6), f"{name}: {outcome}"
                continue
            assert outcome.code == 6 and "were changed after they were written" in outcome.err, f"{name}: {outcome}"


def damage(path, name):
    """Bytes within the first chunk of a dataset, away from its ends."""
    with h5py.File(path) as file:
        chunk = file[name].id.get_chunk_info(0)
    with open(path, "r+b") as file:
        file.seek(chunk.byte_offset + chunk.size // 2)
        old = file.read(4)
        file.seek(chunk.byte_offset + chunk.size // 2)
        file.write(bytes(byte ^ 0xFF for byte in old))


def in_chunks(path):
    """The datasets of a file that are stored in chunks."""
    names = []
    with h5py.File(path) as file:
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) and item.chunks else None)
    return names


def check_reruns(bench):
    """A rerun does not take a damaged result for a finished one, whichever of its data are damaged, and a merge keeps its logs."""
    place = bench.place(small_map(bench))
    assert place.run("--progress", "none").code == 0
    whole = place.read(OUTPUT)
    names = in_chunks(place.path(OUTPUT))
    assert {"main_peak", "residual"} <= set(names) and any("/" in name for name in names), names
    for name in names:
        place.write(OUTPUT, whole)
        damage(place.path(OUTPUT), name)
        damaged = place.read(OUTPUT)
        outcome = place.run("--progress", "none")
        assert outcome.code == 6 and "computed already" not in outcome.out, f"{name}: {outcome}"
        assert f"{OUTPUT}:/{name}: cannot read" in outcome.err and "--fresh computes it again" in outcome.err, f"{name}: {outcome}"
        assert place.read(OUTPUT) == damaged and place.names() == [OUTPUT], f"{name}: {place.names()}"
    assert place.run("--progress", "none", "--fresh").code == 0
    assert "computed already" in place.run("--progress", "none").out

    place = bench.place(small_map(bench))
    for shard in "0/2", "1/2":
        assert place.run("--shard", shard, "--progress", "none").code == 0
    beside = {name: place.read(name) for name in place.names()}
    assert place.call("merge", OUTPUT).code == 0
    for name, data in beside.items():  # as where the merge was killed before it removed them
        place.write(name, data)
    damage(place.path(OUTPUT), "main_peak")
    outcome = place.call("merge", OUTPUT)
    assert outcome.code == 6 and "remove it, and merge makes it again" in outcome.err, outcome
    assert set(beside) < set(place.names()), place.names()
    os.remove(place.path(OUTPUT))
    assert place.call("merge", OUTPUT).code == 0 and place.names() == [OUTPUT], place.names()
    print(f"reruns of a result damaged in each of {len(names)} datasets", flush=True)


def check_flipped_reruns(bench, data):
    """One bit is another: a rerun, a map that takes its points and a table have the numbers of the whole file or say that it is damaged."""
    place = bench.place(small_map(bench))
    commands = {OUTPUT: (), "other.h5": ("-o", "other.h5", "--from", OUTPUT)}

    def table(result):
        outcome = place.call("export", result, "-o", "-")
        assert outcome.code == 0, outcome
        return outcome.out

    place.write(OUTPUT, data)
    whole = table(OUTPUT)
    refused, flips = 0, 80 if EVERYTHING else 12
    for at in random.Random(SEED).sample(range(len(data)), flips):
        flipped = bytearray(data)
        flipped[at] ^= 1 << at % 8
        for result, options in commands.items():
            place.write(OUTPUT, bytes(flipped))
            outcome = place.call("run", "study.toml", "--progress", "none", *(options or ("-o", OUTPUT)))
            assert outcome.code in (0, 5, 6), f"byte {at}: {outcome}"
            assert outcome.code != 0 or table(result) == whole, f"byte {at}: {result} has other numbers: {outcome}"
            refused += outcome.code != 0
            if result != OUTPUT and os.path.exists(place.path(result)):
                os.remove(place.path(result))
        place.write(OUTPUT, bytes(flipped))
        outcome = place.call("export", OUTPUT, "-o", "-")
        assert outcome.code in (0, 6), f"byte {at}: {outcome}"
        # The names in the first line lie under no checksum.
        assert outcome.code != 0 or outcome.out.split("\n")[1:] == whole.split("\n")[1:], f"byte {at}: other numbers in a table"
    assert refused > flips // 4, refused
    print(f"{flips} flipped bits under a rerun, --from and export: {refused} refusals, no other number", flush=True)


def check_studies_of_damaged(bench):
    """A study is not written from a damaged tuning."""
    place = bench.place(tuning_study(bench.source))
    assert place.run("--progress", "none").code == 0
    whole = place.read(OUTPUT)
    names = in_chunks(place.path(OUTPUT))
    assert names
    for name in names:
        place.write(OUTPUT, whole)
        damage(place.path(OUTPUT), name)
        outcome = place.call("export", OUTPUT, "--sweep", "sweep.toml")
        assert outcome.code == 6 and "is damaged" in outcome.err, f"{name}: {outcome}"
        assert place.names() == [OUTPUT], f"{name}: {place.names()}"
    print(f"sweeps of a tuning damaged in each of {len(names)} datasets", flush=True)


def drill(bench):
    assert shutil.which("h5repack"), "hdf5-tools is needed"
    results = {"map": made(bench, small_map(bench)), "decay": made(bench, decay_study(bench))}
    check_repacked(bench, results["map"])
    check_made_to_harm(bench, results["map"])
    check_embedded_study(bench, results["map"])
    check_changed_texts(bench, results["map"])
    check_reruns(bench)
    check_flipped_reruns(bench, results["map"])
    check_studies_of_damaged(bench)
    check_cuts(bench, results["map"])
    check_flips(bench, results)


if __name__ == "__main__":
    main(drill)
