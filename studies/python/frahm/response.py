"""Periodic responses along rows of points, in memory."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np

from .near import Quantities

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Response(Mapping[str, np.ndarray]):
    """Quantities over the points of one axis or more: a mapping of name to array, with `dims` as its axes.

    Floats are in SI, NaN where there is no value; counts are integers, -1 where there is none; flags are
    names: status "ok", guide_regime "one_stop".
    """

    dims: tuple[str, ...]  #: the axes, the row last
    coords: Mapping[str, np.ndarray]  #: of each axis, as given
    arrays: Mapping[str, np.ndarray]
    units: Mapping[str, str]  #: of axes and quantities
    meanings: Mapping[str, str]  #: of the quantities, in words
    reasons: Mapping[tuple[int, ...], str]  #: why points failed, by their index

    def __getitem__(self, quantity: str) -> np.ndarray:
        return self.arrays[quantity]

    def __iter__(self):
        return iter(self.arrays)

    def __len__(self) -> int:
        return len(self.arrays)

    def to_xarray(self) -> "xarray.Dataset":
        """The response as a labelled dataset."""
        import xarray

        def attributes(name: str) -> dict[str, str]:
            found = {"units": self.units.get(name, ""), "long_name": self.meanings.get(name, name)}
            return {key: text for key, text in found.items() if text}

        return xarray.Dataset(
            {name: (self.dims, array, attributes(name)) for name, array in self.arrays.items()},
            {name: (name, array, attributes(name)) for name, array in self.coords.items()},
        )

    def __repr__(self) -> str:
        sizes = ", ".join(f"{name}: {len(self.coords[name])}" for name in self.dims)
        return f"<frahm.Response ({sizes}): {', '.join(self.arrays)}>"


def response_of(axes: Mapping[str, np.ndarray], found: tuple[list[Any], list[str], dict[int, str]]) -> Response:
    """The response from what the compiled part found."""
    variables, units_of_axes, reasons = found
    shape = tuple(len(values) for values in axes.values())
    values: Quantities[np.ndarray] = Quantities()
    for name, array, _, _, flags in variables:
        if flags:
            array = _named(array, dict((number, meaning) for meaning, number in flags))
        values[name] = array.reshape(shape)
    return Response(
        dims=tuple(axes),
        coords=dict(axes),
        arrays=values,
        units=dict(zip(axes, units_of_axes)) | {name: unit for name, _, unit, _, _ in variables},
        meanings={name: meaning for name, _, _, meaning, _ in variables},
        reasons={tuple(int(i) for i in np.unravel_index(index, shape)): reason for index, reason in reasons.items()},
    )


def _named(numbers: np.ndarray, meanings: Mapping[int, str]) -> np.ndarray:
    words = np.array([meanings.get(number, "") for number in range(max(meanings) + 1)])
    return words[numbers]
