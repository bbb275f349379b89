"""The periodic response at one point."""

from dataclasses import dataclass, field
from typing import Any, Mapping, Optional, Union

import numpy as np

from .near import Columns, Parameters, Quantities

QuantityValue = Union[float, int, str, None]


@dataclass(frozen=True)
class Stretch:
    """A part of the period in which no contact changes its state."""

    start: float  #: omega t [rad]
    length: float  #: [rad]
    contacts: Mapping[str, str]  #: of each element with friction: "sticks", "slides +", "slides -"


@dataclass(frozen=True)
class FoundResponse:
    """A stable response of a point, of several that may have been found."""

    is_shown: bool  #: as the response of the point
    period_multiple: int  #: periods of the excitation that it takes
    mirror_of: Optional[int]  #: index of an earlier one, of which it is -x(t + T/2)
    peaks: Mapping[str, float]  #: of masses and signals
    multipliers: list[complex]  #: over its own period, the largest first; none where an event only just happens
    state: Mapping[str, float]  #: at omega t = 0: of masses displacement and velocity, of some elements the force
    units: Mapping[str, str]  #: of peaks and state


@dataclass(frozen=True)
class Point(Mapping[str, QuantityValue]):
    """The periodic response at one point: a mapping of its quantities.

    A quantity is a float [SI], an int of a count, a name of a flag ("one_stop"); NaN or None where it has no
    value.
    """

    status: str  #: "ok", "grazing", "several", "failed" ...
    reason: str  #: why there is no response; else empty
    residual: float  #: of the periodic condition, relative
    why_no_error_bound: str  #: why it is not known how many digits are right; empty where `error_bound` is
    continuum: str  #: if it is one of a continuum of responses: why, and which one; else empty
    newton_iterations: int
    found_by: str  #: "event phases" or "shooting"
    parameters: Mapping[str, tuple[float, str]]  #: value and unit of each number of the study
    quantities: Mapping[str, QuantityValue]
    units: Mapping[str, str]  #: of the quantities and of the columns of the history
    meanings: Mapping[str, str]  #: of the quantities, in words
    stretches: list[Stretch]  #: over the period
    history: Optional[Mapping[str, np.ndarray]]  #: over the period: "time" [s], "main_displacement" ...
    #: Exact derivatives, of quantity by parameter: in SI per unit in which a bare number of the parameter is
    #: read; NaN where there is none. None: not asked for.
    gradient: Optional[Mapping[str, Mapping[str, float]]]
    why_no_gradient: Mapping[str, str] = field(default_factory=dict)  #: of quantities; "" for all of them
    responses: Optional[list[FoundResponse]] = None  #: every stable one that was found; None: not asked for

    @property
    def ok(self) -> bool:
        """Whether there is a response."""
        return self.status in ("ok", "grazing", "several")

    def __getitem__(self, quantity: str) -> QuantityValue:
        return self.quantities[quantity]

    def __iter__(self):
        return iter(self.quantities)

    def __len__(self) -> int:
        return len(self.quantities)

    def __repr__(self) -> str:
        at = ", ".join(f"{name}={value:g}{' ' + unit if unit else ''}" for name, (value, unit) in self.parameters.items())
        return f"<frahm.Point {self.status} at {at}; {len(self.quantities)} quantities>"


def response_of(found: tuple) -> FoundResponse:
    is_shown, multiple, mirror_of, peaks, multipliers, state = found
    return FoundResponse(
        is_shown,
        multiple,
        mirror_of,
        {name: value for name, value, _ in peaks},
        list(multipliers),
        {name: value for name, value, _ in state},
        {name: unit for name, _, unit in [*peaks, *state]},
    )


def point_of(found: Mapping[str, Any]) -> Point:
    """The point from what the compiled part found."""
    history, units = None, {name: unit for name, _, unit, _ in found["quantities"]}
    if found["history"] is not None:
        history, units_of_history = Columns(found["history"][0]), found["history"][1]
        units |= units_of_history | {"time": "s"}
    gradient, why_none = None, {}
    if found["gradient"] is not None:
        derivatives, why_none, reason = found["gradient"]
        gradient = Quantities((quantity, Parameters(by)) for quantity, by in derivatives.items())
        if reason:
            why_none = {"": reason}
    return Point(
        status=found["status"],
        reason=found["reason"],
        residual=found["residual"],
        why_no_error_bound=found["why_no_error_bound"],
        continuum=found["continuum"],
        newton_iterations=found["newton_iterations"],
        found_by=found["found_by"],
        parameters=found["parameters"],
        quantities=Quantities((name, value) for name, value, _, _ in found["quantities"]),
        units=units,
        meanings={name: meaning for name, _, _, meaning in found["quantities"]},
        stretches=[Stretch(*each) for each in found["stretches"]],
        history=history,
        gradient=gradient,
        why_no_gradient=why_none,
        responses=None if found["responses"] is None else [response_of(each) for each in found["responses"]],
    )
