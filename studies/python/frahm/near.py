"""Names that there are not, and the nearest of those that there are."""

from difflib import get_close_matches
from typing import Iterable, TypeVar

Value = TypeVar("Value")


def nearest(word: object, words: Iterable[str]) -> str:
    """What is added to the message about a word that there is not; empty where none is near."""
    found = get_close_matches(word, list(words), n=1) if isinstance(word, str) else []
    return f"; did you mean {found[0]!r}?" if found else ""


def no_such(what: str, word: object, words: Iterable[str]) -> KeyError:
    return KeyError(f"there is no {what} {word!r}{nearest(word, words)}")


class Named(dict[str, Value]):
    """A dictionary that tells the nearest name for one that it has not."""

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
