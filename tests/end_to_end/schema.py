"""schema.py PROGRAM SOURCES: the JSON Schema of studies, against every study, the reader and what it refuses."""
import json
import re
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import jsonschema

program, sources = sys.argv[1], Path(sys.argv[2])


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
    return next((each for each in node.get("anyOf", []) if "properties" in each and "$ref" not in node), node)


def keys(section, node):
    node = own(node)
    found = []
    for key, below in node.get("properties", {}).items():
        if section:
            found.append((section, key, below))
        if "properties" in own(below):
            found += keys(f"{section}.{key}" if section else key, below)
    return found


# The readers allow the keys of the table that the schema is printed from; each is one that a reader asks for.
tables = ("study_keys.cpp", "study_words.hpp")
readers = [*sources.glob("studies/reading/*.?pp"), sources / "solvers/mechanics/element_table.cpp"]
asked_somewhere = {word for each in readers if each.name not in tables for word in re.findall(r'"([\w.]+)"', each.read_text())}
asked_somewhere |= {part for word in asked_somewhere for part in word.split(".")}  # read_tables(..., "excitation.force")
unread = [f"{section}.{key}" for section, key, _ in keys("", schema) if key != "repeat" and key not in asked_somewhere]
assert not unread, f"no reader asks for {unread}"

# Every key that the reader asks for is in the schema.
asks = re.compile(r"\.(?:find|require|text|text_or|identifier|number|boolean_or|integer_or|choice|choice_as<[\w:]+>)\(\s*\"(\w+)\"")
all_keys = {key for _, key, _ in keys("", schema)} | set(schema["properties"])
of_values = {"value", "unit", "table", "of", "extremum"}  # of numbers, of parameters, and a column of data
for source in sorted(sources.glob("studies/reading/*.cpp")):
    asked = set(asks.findall(source.read_text()))
    assert asked <= all_keys | of_values, (source, asked - all_keys - of_values)

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
}
with tempfile.TemporaryDirectory() as folder:
    for what, text in wrong.items():
        assert text != small, what
        assert not validator.is_valid(tomllib.loads(text)), f"the schema accepts {what}"
        study = Path(folder) / "study.toml"
        study.write_text(text)
        assert frahm("check", study).returncode == 2, f"the reader accepts {what}"

# Each key is explained.
for section, key, below in keys("", schema):
    if key == "repeat":
        continue
    told = frahm("explain", f"{section}.{key}")
    assert told.returncode == 0 and below["description"] in told.stdout, (section, key, told)
