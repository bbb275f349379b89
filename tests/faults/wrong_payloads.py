"""Shard logs whose records have the checksum that they should have, and contents that mean nothing: an error that names
the log (exit 6), never an internal error. Where the contents could be right, the run ends well.

usage: wrong_payloads.py FRAHM SOURCE_DIR
"""

import random
import struct

from damaged_logs import LOG, files_of, finished_log, place_with
from faulty_runs import EVERYTHING, HEADER_SIZE, OUTPUT, RECORD_HEAD, in_parallel, main, sweep_study, tuning_study

SEED = 24
TABLE = []
for byte in range(256):
    for _ in range(8):
        byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
    TABLE.append(byte)


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = TABLE[(crc ^ byte) & 0xFF] ^ crc >> 8
    return crc ^ 0xFFFFFFFF


def with_payload(data, change):
    """The first record of a log with another payload, its length and checksum right; the others as they are."""
    magic, version, mark, tile, length = RECORD_HEAD.unpack_from(data, HEADER_SIZE)
    begin = HEADER_SIZE + RECORD_HEAD.size
    payload = change(bytes(data[begin:begin + length]))
    record = RECORD_HEAD.pack(magic, version, mark, tile, len(payload)) + payload
    return data[:HEADER_SIZE] + record + struct.pack("<I", crc32c(record)) + data[begin + length + 4:]


def word(at, value):
    def change(payload):
        return payload[:at] + struct.pack("<Q", value) + payload[at + 8:]
    return change


def drawn_changes(rng, count):
    """Words anywhere, small and large, cuts and additions."""
    def one():
        where, how = rng.random(), rng.randrange(4)
        value = rng.choice((0, 1, 7, 2**31, 2**53, 2**63, 2**64 - 1, rng.getrandbits(64)))
        def change(payload):
            at = int(where * (len(payload) // 8)) * 8
            if how == 0:
                return payload[:at]
            if how == 1:
                return payload + struct.pack("<QQ", value, value)
            return word(at, value)(payload)
        return change
    return [one() for _ in range(count)]


def check(bench, study, log, change, case, codes):
    place = place_with(bench, study, {LOG: with_payload(log, change)})
    note = [name for name in place.names() if name.endswith(".frahm-study")]
    for command in (("status", OUTPUT), ("run", "study.toml", "-o", OUTPUT, "--progress", "none", "--time-budget", "20s")):
        outcome = place.call(*command)
        text = f"{case}: {command[0]}: {outcome} {note}"
        assert outcome.code in codes or command[0] == "status" and outcome.code == 0, text
        assert "internal error" not in outcome.err, text
        assert outcome.code != 6 or LOG in outcome.err, text
    if outcome.code == 6:
        assert place.read(LOG)[HEADER_SIZE:] == with_payload(log, change)[HEADER_SIZE:], f"{case}: the log was changed"
        place.call("run", "study.toml", "-o", OUTPUT, "--fresh", "--progress", "none")


def drill(bench):
    rng = random.Random(SEED)
    study = sweep_study(bench.source).replace("points = 129", "points = 9").replace("points = 12", "points = 2")
    tuning = tuning_study(bench.source)
    for kind, text, codes in (("map", study, (0, 3, 6)), ("tuning", tuning, (0, 6, 7))):
        files = files_of(finished_log(bench, text))
        log = next(data for name, data in files.items() if name.endswith(".frahm-log"))
        known = {"an empty payload": lambda p: b"", "a payload that goes on": lambda p: p + b"\0" * 8}
        if kind == "map":
            known["a failed point beyond the tile"] = lambda p: p + struct.pack("<QQ", 10**6, 0)
            known["a reason that is no text"] = lambda p: p + struct.pack("<QQ", 0, 2) + b"\xff\xfe"
            known["borders that the study has not"] = lambda p: p + struct.pack("<Q", 2**64 - 1)
        else:
            known["2^64 - 1 optima"] = word(0, 2**64 - 1)
        for case, change in known.items():
            check(bench, text, log, change, f"{kind}: {case}", (6,))
        changes = drawn_changes(rng, 2000 if EVERYTHING else 25)
        in_parallel(lambda i: check(bench, text, log, changes[i], f"{kind}: change {i} of seed {SEED}", codes),
                    range(len(changes)))
        print(f"{kind}: {len(known) + len(changes)} wrong payloads", flush=True)
    many = log[:12] + struct.pack("<Q", 2**60) + log[20:148]
    header = many + struct.pack("<I", crc32c(many)) + log[152:HEADER_SIZE]
    place = place_with(bench, study, {LOG: header})
    outcome = place.call("status", OUTPUT)
    assert outcome.code == 6 and LOG in outcome.err, f"2^60 tiles: {outcome}"


if __name__ == "__main__":
    main(drill)
