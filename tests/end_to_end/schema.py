"""schema.py PROGRAM SOURCES REFUSALS [--all]: the JSON Schema of studies, against every study, the reader and what
it refuses.  --all: of mistakes in every study too, some twenty thousand, in minutes."""
import collections
import concurrent.futures
import json
import re
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


# The readers allow the keys of the table that the schema is printed from; each is one that a reader asks for.
tables = ("study_keys.cpp", "study_words.hpp")
readers = [*sources.glob("studies/reading/**/*.?pp"), sources / "solvers/mechanics/element_table.cpp"]
asked_somewhere = {word for each in readers if each.name not in tables for word in re.findall(r'"([\w.]+)"', each.read_text())}
asked_somewhere |= {part for word in asked_somewhere for part in word.split(".")}  # read_tables(..., "excitation.force")
unread = [f"{section}.{key}" for section, key, _ in keys("", schema) if key != "repeat" and key not in asked_somewhere]
assert not unread, f"no reader asks for {unread}"

# Every key that the reader asks for is in the schema.
asks = re.compile(r"\.(?:find|require|text|text_or|identifier|number|boolean_or|integer_or|choice|choice_as<[\w:]+>)\(\s*\"(\w+)\"")
all_keys = {key for _, key, _ in keys("", schema)} | set(schema["properties"])
of_values = {"value", "unit", "table", "of", "extremum"}  # of numbers, of parameters, and a column of data
for source in sorted(sources.glob("studies/reading/**/*.cpp")):
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

# What a schema cannot know.  Whole rules: of names that refer to one another, of values beside each other, of
# units and expressions, of the system as a whole, and of files.
BEYOND = set("""
unknown_name name_taken given_twice computed_parameter wrong_dependence wrong_node unknown_column
wrong_order wrong_law wrong_matrix floating_mass no_contact several_responses unfit_quantity unfit_axis unfit_for_method
unknown_unit wrong_dimension missing_unit ambiguous_unit two_units unit_in_dimensionless wrong_expression circular_definition
not_text not_toml not_finite unreadable_file wrong_file no_header wrong_row doubtful_row too_few too_large
""".split())
# Of the other rules, by what the reader says.
PARTLY_BEYOND = [
    ("out_of_range", r" at .* = |within|scenario|record \"", "a value that follows from parameters"),
    ("out_of_range", r"outside|times the rod|is not a value of this axis|below the force|if there is a static_force", "one value beside another"),
    ("out_of_range", r"of the distribution lies between|mode: is|to a mean of 0", "one number of a distribution beside another"),
    ("out_of_range", r"point \d+.*must be|force .* at 0|at rest a damper|falls at velocity", "the points of a table together"),
    ("out_of_range", r"along: .* the size of a factor must be", "the size of a factor, which has a unit"),
    ("out_of_range", r"numbers must rise|spacing = \"log\"|too low for the ground", "the ends of a range beside each other"),
    ("out_of_range", r"height|searches up to|weight: |has no value", "numbers behind expressions, or of a list"),
    ("wrong_length", r"stiffnesses|ratios are given|names? (is|are) given|heights for|cannot advance together|: .*csv", "lists of one length"),
    ("empty", r"has no stop on either side", "infinity, which JSON has not"),
    ("wrong_type", r"path of a dataset|whole number, found the number", "columns of HDF5; 3.0 is whole for JSON"),
    ("not_a_name", r"\{", "{i} in a name, without its repeat"),
    ("wrong_type", r"found the text \"\{", "{n} for a number, without its repeat"),
    ("missing_key", r"\"frequency\"|\"duration\" is missing|\"band\" is missing|\"file\" is missing", "what depends on other sections"),
    ("missing_key", r"columns|reference_frequency|added_mass|static_displacement|force / stiffness", "what depends on the columns of the data"),
    ("missing_key", r"the uncertain parameters are missing", "an empty list of what is uncertain"),
    ("missing_section", r"of order 1 or more|nothing moves|\[excitation\] and none was measured|\[\[initial\]\]", "what other sections ask for"),
    ("other_kind", r"without an \[\[axis\]\]|over records|over a band|axis of records|a tuning must have samples", "forms of a kind"),
    ("key_without_use", r"has no effect: |\"crank\" to be cut|cut at this order|shows this response|constant, so it has no", "what this system makes useless"),
    ("key_without_use", r"fitted, so a|it is tuned|runs over the band|follow it|cannot be combined with time|order 0", "a name or a column beside another"),
    ("key_without_use", r"has no use here; it is the mass added", "what depends on the columns of the data"),
    ("key_without_use", r"over records|under records|of samples|needs samples|belongs to files|\[\[excitation.record\]\]|is a scenario", "records and samples of other sections"),
    ("key_without_use", r"\[\[design\]\]|schedule|there is no band|a variance has no|a variance under white noise|belongs to (start|objective)", "forms of a tuning"),
]


def why_beyond(rule, message):
    if rule in BEYOND:
        return rule
    said = message.split("\n")[0]
    return next((why for of, pattern, why in PARTLY_BEYOND if of == rule and re.search(pattern, said)), None)


def refused(named_texts):
    """Of each study the rule that it breaks, or "none", and the message; by two processes."""
    halves = [named_texts[::2], named_texts[1::2]]
    processes = [subprocess.Popen([refusals], stdin=subprocess.PIPE, stdout=subprocess.PIPE) for _ in halves]
    with concurrent.futures.ThreadPoolExecutor() as pool:
        packed = ["".join(f"{name}\0{text}\0" for name, text in half).encode() for half in halves]
        read = list(pool.map(lambda each: each[0].communicate(each[1])[0].decode().split("\0")[:-1], zip(processes, packed)))
    answers = [None] * len(named_texts)
    for start, words in enumerate(read):
        answers[start::2] = zip(words[::2], words[1::2])
    return answers


def keys_of(path):
    node = schema
    for step in path:
        node = own(node).get("properties", {}).get(step, {})
    return set(own(node).get("properties", {}))


# Reader and schema refuse the same mistakes, but for what a schema cannot know.
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
for (name, what, study), (rule, message) in zip(mistakes, answers):
    is_valid = validator.is_valid(study)
    if rule == "none":
        counts["accepted by both" if is_valid else "refused by the schema alone"] += 1
        if not is_valid:
            unlike.append((name, what, "refused by the schema alone"))
    elif not is_valid:
        counts["refused by both"] += 1
    else:
        why = why_beyond(rule, message)
        counts[f"refused by the reader alone: {why}"] += 1
        if not why:
            unlike.append((name, what, rule, message.split("\n")[0]))
    assert not what.startswith("must break ") or what == f"must break {rule}", (name, what, rule)
    assert what != "as it is" or rule == "none" and is_valid, (name, rule, message)
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
