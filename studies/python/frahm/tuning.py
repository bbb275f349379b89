"""The optimum of a tuning."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Mapping, Optional, Union

import numpy as np

from .dataset import names, open as open_result
from .near import Parameters
from .running import Result

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Tuning:
    """A tuned design, with its proof."""

    outcome: str  #: "converged", "not_converged", "infeasible", "unbounded", "failed" or "stopped"
    reason: str  #: why the work ended
    design: Mapping[str, Union[float, np.ndarray]]  #: of a schedule its values at `knots`; in the unit of the bounds
    knots: Mapping[str, np.ndarray]  #: of each schedule, in the unit of the band
    objective: float
    certificate_gap: Optional[float]  #: relative excess of the true worst peak over the bound
    kkt_residual: float
    peaks: Optional[np.ndarray]  #: frequency and height of each local maximum at the optimum
    dataset: "xarray.Dataset"  #: everything that the file has of the optimum
    table: str  #: the short table that the program prints
    file: Optional[str]  #: the result, where one was asked for

    def __str__(self) -> str:
        return self.table

    def __repr__(self) -> str:
        design = ", ".join(f"{name}={value:g}" if np.ndim(value) == 0 else f"{name}: schedule of {len(value)} knots"
                           for name, value in self.design.items())
        return f"<frahm.Tuning {self.outcome}: {design}; objective {self.objective:g}>"


def tuning_of(result: Result, keep: bool) -> Tuning:
    """The optimum from the file of a run. keep: whether the file stays."""
    with open_result(result.file, "optimum") as file:
        optimum = file.load()

    def number(name: str) -> Optional[float]:
        return float(optimum[name]) if name in optimum else None

    design = {name: optimum[name].values for name in optimum.attrs["parameters"].split(",")}
    return Tuning(
        outcome=str(names(optimum.outcome).values),
        reason=optimum.attrs["reason"],
        design=Parameters((name, float(value) if value.ndim == 0 else value) for name, value in design.items()),
        knots={name: optimum[f"knots_{name}"].values for name in design if f"knots_{name}" in optimum.variables},
        objective=float(optimum.objective),
        certificate_gap=number("certificate_gap"),
        kkt_residual=float(optimum.kkt_residual),
        peaks=_peaks(optimum),
        dataset=optimum,
        table=result.table,
        file=result.file if keep else None,
    )


def _peaks(optimum: "xarray.Dataset") -> Optional[np.ndarray]:
    place = f"peak_{optimum.attrs.get('band_parameter')}"
    if place not in optimum.variables:
        return None
    return np.column_stack([optimum[place].values, optimum["peak_value"].values])
