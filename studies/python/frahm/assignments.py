"""Values of parameters in the form that the program reads: name=value."""

import numbers
import os
from typing import Any, Callable, Iterable, Mapping, Union

import numpy as np

from .estimate import Estimate

Value = Union[float, str, Estimate]
"""A number in the parameter's usual unit, a text with a unit, or an estimate, which has one: 600, "600 rpm"."""


def assignments(values: Mapping[str, Value]) -> list[str]:
    """name=value for each parameter."""
    return [f"{_name(name)}={_text(name, value)}" for name, value in values.items()]


def is_axis(value: Any) -> bool:
    """Whether a parameter is given several values."""
    return isinstance(value, Iterable) and not isinstance(value, (str, bytes)) and getattr(value, "ndim", 1) > 0


def values_of_axis(name: str, given: Any, number: Callable[[str, str], float]) -> np.ndarray:
    """The values of a parameter along an axis; also a single one.

    number: what a text with a unit is in the parameter's usual unit, of a name and the text.
    """
    _name(name)
    listed = list(given) if is_axis(given) and not hasattr(given, "__array__") else given
    if isinstance(listed, (str, Estimate)):
        listed = [listed]
    if isinstance(listed, list):
        listed = [number(name, _text(name, each)) if isinstance(each, (str, Estimate)) else each for each in listed]
    try:
        objects = np.asarray(listed)
        each_of = listed if isinstance(listed, list) else objects.flat if objects.dtype == object else []
        # NumPy would make them numbers.
        if objects.dtype.kind in "bS" or any(isinstance(each, (type(None), bool, bytes)) for each in each_of):
            raise TypeError
        array = np.atleast_1d(np.asarray(listed, dtype=float))
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name}={short(given)}: must be a number or a list of numbers, or texts with a unit") from None
    if array.ndim != 1:
        raise ValueError(f"{name}: must be a list of values, not an array of {array.ndim} dimensions")
    return array


def file_name(path: Union[str, os.PathLike]) -> str:
    """A path as the program takes it."""
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise TypeError(f"the file's name: must be a text or a path, not {type(path).__name__}")
    return plain(os.fsdecode(path), "the file's name")


def plain(text: Any, what: str) -> str:
    """A text that the program can read."""
    if not isinstance(text, str):
        raise TypeError(f"{what}: must be a text, not {type(text).__name__}")
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{what} {short(text)}: must be UTF-8") from None
    if "\0" in text:
        raise ValueError(f"{what} {short(text)}: must not have a NUL character")
    return text


def whole(value: Any, name: str, least: int, most: int = 2**31 - 1) -> int:
    """A whole number; most: by default what the program can count to."""
    if not isinstance(value, numbers.Integral):
        raise TypeError(f"{name}={short(value)}: must be a whole number")
    if not least <= value <= most:
        raise ValueError(f"{name}={short(value)}: must be from {least} to {most}")
    return int(value)


def short(value: Any) -> str:
    """A value in a message."""
    shown = repr(value)
    return shown if len(shown) <= 60 else shown[:57] + "..."


def _name(name: Any) -> str:
    plain(name, "a parameter's name")
    if "=" in name or "," in name:
        raise ValueError(f"{short(name)}: no parameter has this name; give one name and its value")
    return name


def _text(name: str, value: Any) -> str:
    if isinstance(value, Estimate):
        return value.setting(name)
    if isinstance(value, str):
        if "," in plain(value, name):
            raise ValueError(f"{name}={short(value)}: must be one value, without a comma")
        return value
    single = value.item() if getattr(value, "ndim", None) == 0 else value  # also a 0-d array
    if isinstance(single, numbers.Real) and not isinstance(single, bool):
        try:
            return repr(float(single))
        except OverflowError:
            raise ValueError(f"{name}={short(value)}: must be a finite number") from None
    raise TypeError(f"{name}: must be a number or a text with a unit, not {type(value).__name__}")
