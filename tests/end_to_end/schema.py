"""schema.py PROGRAM SOURCES REFUSALS [--all]: the JSON Schema of studies, against every study, the reader and what
it refuses.  --all: of mistakes in every study too, some twenty thousand, in minutes."""
import collections
import concurrent.futures
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import jsonschema

program, sources, refusals = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
sys.path.insert(0, str(Path(__file__).parent / "schema"))
sys.path.insert(0, str(sources / "tests/studies/reading"))
from mutants import MORE_WRONG, WRONG, mutants, text_of  # noqa: E402
from wrong_studies import FOLDER, wrong_studies  # noqa: E402


def frahm(*arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=120)


schema = json.loads(frahm("schema").stdout)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
paths = sorted(sources.glob("studies/**/*.toml"), key=lambda path: path.stat().st_size)
texts = {path: path.read_text() for path in paths}
assert len(texts) > 90

for path, text in texts.items():
    errors = [f"{'/'.join(map(str, error.absolute_path))}: {error.message}" for error in validator.iter_errors(tomllib.loads(text))]
    assert not errors, (path, errors)
for kind in ("sweep", "tune", "identify", "decay", "transient"):
    validator.validate(tomllib.loads(frahm("new", kind, "-").stdout))


def own(node):
    """The table that is meant by a list of tables, or by what may be a table too."""
    node = node.get("items", node)
    forms = [each.get("items", each) for each in node.get("anyOf", [])]
    return next((each for each in forms if "properties" in each), node)


def keys(section, node):
    node = own(node)
    found = []
    for key, below in node.get("properties", {}).items():
        if section:
            found.append((section, key, below))
        if "properties" in own(below):
            found += keys(f"{section}.{key}" if section else key, below)
    return found


# What is wrong in form is refused by both.
small = texts[sources / "studies/classics/den_hartog.toml"]
wrong = {
    "a section": small + "\n[exitation]\n",
    "a key": small.replace("stiffness = 1\n", "stifness = 1\n"),
    "a type of element": small.replace('type = "spring"', 'type = "sprung"'),
    "a kind": small.replace('kind   = "sweep"', 'kind = "swept"'),
    "no kind": small.replace('kind   = "sweep"\n', ""),
    "a text for a whole number": small.replace("points = 481", 'points = "481"'),
    "a list for a value": small.replace("amplitude = 1\n", "amplitude = [1]\n"),
    "a table for a list of tables": small.replace("[[mass]]", "[mass]"),
    "a value with a third key": small.replace("amplitude = 1\n", 'amplitude = { value = 1, units = "N" }\n'),
    "a key of another type of element": small.replace("stiffness = 1\n", "stiffness = 1\ninertance = 1\n"),
    "a section of another kind": small + "\n[decay]\n",
    "a key of another kind": small + "\n[output]\nhistories = true\n",
    "a key of another profile": small.replace("[[excitation.force]]", """[[excitation.motion]]
node = "base"
profile = "harmonic"
crank = 0.1
[[excitation.force]]"""),
    "an empty name": small.replace('on = "main"', 'on = ""'),
    "another version": small.replace("schema = 1", "schema = 2"),
    "a spring without stiffness": small.replace("stiffness = 1\n", ""),
    "friction without a force": small.replace('force = "f"\n', ""),
    "a force without amplitude": small.replace("amplitude = 1\n", ""),
    "one point": small.replace("points = 481", "points = 1"),
    "no point": small.replace("points = 481", "points = 0"),
    "an order below 0": small.replace("amplitude = 1\n", "amplitude = 1\norder = -1\n"),
    "an order above all": small.replace("amplitude = 1\n", "amplitude = 1\norder = 1001\n"),
    "one node": small.replace('["ground", "main"]\nstiffness', '["main"]\nstiffness'),
    "two directions": small.replace("stiffness = 1\n", "stiffness = 1\nalong = { main = 1 }\n"),
    "values beside a range": small.replace("from = 0\nto", "values = [0, 1]\nfrom = 0\nto"),
    "damping that is true": small + "\n[damping]\nmodal = true\n",
    "half of Rayleigh's damping": small + "\n[damping]\nrayleigh = [0.1]\n",
    "two kinds of damping": small + "\n[damping]\nmodal = 0.1\nrayleigh = [0.1, 0.1]\n",
    "a name of two words": small.replace('name = "main"', 'name = "a b"'),
    "a repetition without end": small.replace('name = "main"', 'name = "main"\nrepeat = { i = [1] }'),
    "no mass": small.replace('[[mass]]\nname = "main"\nmass = 1\n', ""),
    "no excitation": small.replace('[excitation]\nfrequency = "r"\n\n[[excitation.force]]\non = "main"\namplitude = 1\n', ""),
    "no axis": small[: small.index("[[axis]]")],
    "a negative mass": small.replace("mass = 1\n", "mass = -1\n"),
    "an exact law with a slope": small.replace('force = "f"\n', 'force = "f"\nslope = 10\n'),
}
with tempfile.TemporaryDirectory() as folder:
    for what, text in wrong.items():
        assert text != small, what
        assert not validator.is_valid(tomllib.loads(text)), f"the schema accepts {what}"
        study = Path(folder) / "study.toml"
        study.write_text(text)
        assert frahm("check", study).returncode == 2, f"the reader accepts {what}"

def refused(named_texts):
    """Of each study the rule that it breaks, or "none", "schema" or "beyond" it, and the message; by two processes."""
    halves = [named_texts[::2], named_texts[1::2]]
    processes = [subprocess.Popen([refusals], stdin=subprocess.PIPE, stdout=subprocess.PIPE) for _ in halves]
    with concurrent.futures.ThreadPoolExecutor() as pool:
        packed = ["".join(f"{name}\0{text}\0" for name, text in half).encode() for half in halves]
        read = list(pool.map(lambda each: each[0].communicate(each[1])[0].decode().split("\0")[:-1], zip(processes, packed)))
    answers = [None] * len(named_texts)
    for start, words in enumerate(read):
        answers[start::2] = zip(words[::3], words[1::3], words[2::3])
    return answers


def keys_of(path):
    node = schema
    for step in path:
        node = own(node).get("properties", {}).get(step, {})
    return set(own(node).get("properties", {}))


# Reader and schema refuse the same mistakes, but for what is beyond a schema: each refusal says so itself
# (studies/reading/text/rules.hpp). That each key is read is shown by tests/studies/provenance/mutants_test.cpp.
here = Path(__file__).parent / "schema" / "studies"
in_all = "--all" in sys.argv
bases = sorted([*here.glob("*.toml"), *(paths if in_all else [])], key=lambda path: path.stat().st_size)
studies = {str(path): tomllib.loads(path.read_text()) for path in bases}
mistakes = [(name, "as it is", study) for name, study in studies.items()]
mistakes += mutants(studies, keys_of, WRONG + MORE_WRONG if in_all else WRONG)
answers = refused([(name, text_of(study)) for name, _, study in mistakes])
texts_of_wrong = []
for name, text in wrong_studies().items():
    name, rule = str(FOLDER / f"{name}.toml"), text.split()[3]
    try:
        mistakes.append((name, f"must break {rule}", tomllib.loads(text)))
    except tomllib.TOMLDecodeError:
        continue
    texts_of_wrong.append((name, text))
answers += refused(texts_of_wrong)
counts, unlike = collections.Counter(), []
for (name, what, study), (rule, knows, message) in zip(mistakes, answers):
    is_valid = validator.is_valid(study)
    if rule == "none":
        counts["accepted by both" if is_valid else "refused by the schema alone"] += 1
        if not is_valid:
            unlike.append((name, what, "refused by the schema alone"))
    elif not is_valid:
        counts["refused by both"] += 1
    else:
        counts[f"refused by the reader alone: {rule}"] += 1
        if knows == "schema":
            unlike.append((name, what, rule, message.split("\n")[0]))
    assert not what.startswith("must break ") or what == f"must break {rule}", (name, what, rule)
    is_right = rule == "none" or in_all and rule in ("wrong_file", "unreadable_file")  # of other results
    assert what != "as it is" or is_right and is_valid, (name, rule, message)
print(*(f"{count:6d} {what}" for what, count in sorted(counts.items())), sep="\n")
assert not unlike, "\n".join(map(str, unlike))
assert counts["refused by both"] > 2000, counts

# Each key is explained.
def explained(key):
    section, name, below = key
    section = section.replace("tune.records", "axis.records")  # the records of both are generated alike
    told = frahm("explain", f"{section}.{name}")
    assert told.returncode == 0 and below["description"] in told.stdout, (section, name, told)


with concurrent.futures.ThreadPoolExecutor(2) as pool:
    list(pool.map(explained, [key for key in keys("", schema) if key[1] != "repeat"]))
