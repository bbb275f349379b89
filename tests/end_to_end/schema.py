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


# Every key that the schema allows is known to the reader, in a study that has the section.
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


def with_key(text, section, key):
    """The study with the key in the first such section, or None if it has none."""
    last = re.escape(section.split(".")[-1])
    line = f"{key} = 1"
    head = re.search(rf"^\[\[?{re.escape(section)}\]?\][^\n]*\n", text, re.M)
    if head:
        body = text[head.end():].split("\n[")[0]
        if re.search(rf"^{re.escape(key)}\b", body, re.M):
            return None
        return text[:head.end()] + line + "\n" + text[head.end():]
    inline = re.search(rf"^{last}\s*=\s*\{{", text, re.M) if "." in section else None
    return text[:inline.end()] + f" {line}," + text[inline.end():] if inline else None


def has_key(text, section, key):
    node = tomllib.loads(text)
    for part in section.split("."):
        while isinstance(node, list):
            node = next((each for each in node if isinstance(each, dict) and part in each), {})
        node = node.get(part, {}) if isinstance(node, dict) else {}
    tables = node if isinstance(node, list) else [node]
    return any(isinstance(each, dict) and key in each for each in tables)


def known_to_reader(section, key):
    """Whether a shipped study has the key, or the reader does not call it unknown; None where no study has its section."""
    if key == "repeat" or any(has_key(text, section, key) for text in texts.values()):
        return True
    tried = False
    with tempfile.TemporaryDirectory() as folder:
        for path, text in texts.items():
            other = with_key(text, section, key)
            if other is None:
                continue
            tried = True
            study = Path(folder) / "study.toml"
            study.write_text(other)
            if "unknown key" not in frahm("check", study).stderr:
                return True
    return False if tried else None


unknown, untried = [], []
for section, key, _ in keys("", schema):
    answer = known_to_reader(section, key)
    if answer is None:
        untried.append(f"{section}.{key}")
    elif not answer:
        unknown.append(f"{section}.{key}")
assert not unknown, f"the schema allows keys that the reader does not know: {unknown}"
print("not in any shipped study:", untried)
assert len(untried) <= 12, untried

# Every key that the reader asks for is in the schema.
asks = re.compile(r"\.(?:find|require|text|text_or|identifier|number|boolean_or|integer_or|choice_or)\(\s*\"(\w+)\"")
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
