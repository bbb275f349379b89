"""Unknown names, and the nearest known ones."""

from difflib import get_close_matches
from typing import Iterable, TypeVar

Value = TypeVar("Value")


def nearest(word: object, words: Iterable[str]) -> str:
    """The hint added to the message about an unknown word; empty if no known word is near."""
    found = get_close_matches(word, list(words), n=1) if isinstance(word, str) else []
    return f"; did you mean {found[0]!r}?" if found else ""


def no_such(what: str, word: object, words: Iterable[str]) -> KeyError:
    return KeyError(f"there is no {what} {word!r}{nearest(word, words)}")


class Named(dict[str, Value]):
    """A dictionary whose error for an unknown name gives the nearest known one."""

    what = "name"

    def __missing__(self, name: object) -> Value:
        raise no_such(self.what, name, self)


class Quantities(Named[Value]):
    what = "quantity"


class Parameters(Named[Value]):
    what = "parameter"


class Estimates(Named[Value]):
    what = "estimate"


class Columns(Named[Value]):
    what = "column"
