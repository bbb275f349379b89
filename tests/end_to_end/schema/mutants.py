"""Studies with one mistake each, made of valid ones: a key less or more, another type, another number."""
import copy
import json
import math

WRONG = (True, "a b", [], {}, -1, 10**9, [1, 2, 3])
MORE_WRONG = ("", 1, 0, 1.5, [1], [[1, 2]], ["a b"], [True], {"a b": 1}, {"value": "a"}, {"value": -1})
DECIDERS = ("kind", "type", "law", "distribution", "profile", "method", "objective", "generate", "shape")


def written(value):
    """As TOML, tables in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return "inf" if value == math.inf else "-inf" if value == -math.inf else repr(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return "{" + ", ".join(f"{json.dumps(key)} = {written(each)}" for key, each in value.items()) + "}"


def text_of(study):
    return "".join(f"{json.dumps(key)} = {written(value)}\n" for key, value in study.items())


def tables(value, path=(), place=()):
    """All tables of a study: names of the sections on the way, where it stands, and the table."""
    if isinstance(value, dict):
        yield path, place, value
        for key, below in value.items():
            yield from tables(below, (*path, key), (*place, key))
    elif isinstance(value, list):
        for number, below in enumerate(value):
            yield from tables(below, path, (*place, number))


def changed(study, place, change):
    result = copy.deepcopy(study)
    table = result
    for step in place:
        table = table[step]
    change(table)
    return result


def form_of(table):
    return " ".join(f"{key} = {table[key]}" for key in DECIDERS if isinstance(table.get(key), str))


def mutants(studies, keys_of, wrong_values=WRONG):
    """Of each key of each form of a section once, from the first study that has it.  studies: by path.
    keys_of(path): the keys that a section may have.  Yields path, what was done, study."""
    examples = {}  # values of keys, to put where they are not
    for study in studies.values():
        for path, _, table in tables(study):
            for key, value in table.items():
                examples.setdefault((path, key), value)
    done = set()

    def new(*what):
        if what in done:
            return False
        done.add(what)
        return True

    for name, study in studies.items():
        for path, place, table in tables(study):
            form, known = form_of(table), keys_of(path)
            of_kind = form + form_of(study.get("study", {}))
            if known and new(path, form, "unknown"):
                yield name, f"{path}: a key nobody knows", changed(study, place, lambda each: each.update(frobnicate=1))
            for key in table:
                label = key if not known or key in known else "*"
                if new(path, of_kind, label, "removed"):
                    yield name, f"{path} {key} removed", changed(study, place, lambda each: each.pop(key))
                if known and new(path, form, label, "misspelt"):
                    yield name, f"{path} {key} misspelt", changed(study, place, lambda each: each.update({key + "e": each.pop(key)}))
                for wrong in wrong_values:
                    if wrong != table[key] and new(path, form, label, repr(wrong)):
                        yield name, f"{path} {key} = {written(wrong)}", changed(study, place, lambda each: each.update({key: copy.deepcopy(wrong)}))
                if isinstance(table[key], list):
                    for what, other in (("halved", table[key][:1]), ("doubled", table[key] * 2)):
                        if new(path, form, label, what):
                            yield name, f"{path} {key} {what}", changed(study, place, lambda each: each.update({key: copy.deepcopy(other)}))
            for key in known - set(table):
                if (path, key) in examples and new(path, of_kind, key, "added"):
                    yield name, f"{path} {key} added", changed(study, place, lambda each: each.update({key: copy.deepcopy(examples[path, key])}))
