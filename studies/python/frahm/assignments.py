"""Values of parameters in the form that the program reads: name=value."""

import numbers
from typing import Any, Iterable, Mapping, Union

Value = Union[float, str]
"""A number in the parameter's usual unit, or a text with a unit: 600, "600 rpm"."""


def assignments(values: Mapping[str, Value]) -> list[str]:
    """name=value for each parameter."""
    return [f"{name}={_text(name, value)}" for name, value in values.items()]


def is_axis(value: Any) -> bool:
    """Whether a parameter is given several values."""
    return isinstance(value, Iterable) and not isinstance(value, str) and getattr(value, "ndim", 1) > 0


def _text(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, numbers.Real) or getattr(value, "ndim", None) == 0:
        return repr(float(value))
    raise TypeError(f"{name}: a number or a text with a unit, not {type(value).__name__}")
