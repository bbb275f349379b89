"""The studies of the folder `wrong`, each a base with a few changed lines; bases.txt there says how they are written."""
from pathlib import Path

FOLDER = Path(__file__).parent / "wrong"


def changed(name, base, changes):
    """The lines of a base with the changes of a case."""
    lines, at, anchored = list(base), len(base), False
    for change in changes:
        mark, space, rest = change.partition(" ")
        parts = (space + rest).split(" / ")
        parts[0] = parts[0][1:]
        if mark[0] in "+*":
            times = int(mark[1:] or 1)
            lines[at:at] = [part.replace("{i}", str(i + 1)) if mark[0] == "*" else part for i in range(times) for part in parts]
            at += times * len(parts)
            continue
        for part in parts:
            start = at if anchored else 0
            if part not in lines[start:] or not anchored and lines.count(part) > 1:
                raise ValueError(f"{name}: its base has this line not at all or not once: {part}")
            at, anchored = lines.index(part, start), True
            if mark == "-":
                del lines[at]
            else:
                at += 1
    return lines


def wrong_studies():
    """The text of each study by its name; its first line says how it must be refused."""
    bases, cases = {}, []
    for path in sorted(FOLDER.glob("*.txt")):
        body = []
        for line in path.read_text("utf-8").split("\n"):
            if line[:1] in " @-+*":
                body.append(line)
            elif line.startswith("base "):
                base, body = line[5:], bases.setdefault(line[5:], [])
            elif line.startswith("of "):
                base = line[3:]
            elif not line.startswith("#"):
                name, _, expected = line.partition(" | ")
                body = []
                cases.append((name, expected, base, body))
    texts = {}
    for name, expected, base, changes in cases:
        lines = "\n".join(line[2:] for line in bases[base]).rstrip("\n").split("\n")
        lines = changed(name, lines, filter(None, changes))
        texts[name] = "\n".join([f"# expect: {expected}", *lines, ""])
    assert len(texts) == len(cases), "two wrong studies have one name"
    return texts
