"""A model identified from measurements."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Mapping, Optional

import numpy as np

from . import _frahm
from .dataset import names, open as open_result
from .estimate import Estimate
from .near import Estimates
from .running import Result

if TYPE_CHECKING:
    import xarray

    from .study import Study


@dataclass(frozen=True)
class Identification(Mapping[str, Estimate]):
    """A model found from data: a mapping of its estimates."""

    outcome: str  #: "converged" or "not_converged"
    method: str
    estimates: Mapping[str, Estimate]
    covariance: np.ndarray  #: of the estimates in their order
    fit: Mapping[str, float]  #: of each record: 100 (1 - misfit / scatter of the data) [percent]
    notes: list[str]
    dataset: "xarray.Dataset"  #: everything that the file has, the data and the fit among it
    table: str  #: the short table that the program prints
    file: Optional[str]  #: the result, where one was asked for
    _study: str = ""
    _why_no_study: str = ""

    def __getitem__(self, name: str) -> Estimate:
        return self.estimates[name]

    def __iter__(self):
        return iter(self.estimates)

    def __len__(self) -> int:
        return len(self.estimates)

    def study(self) -> "Study":
        """A study with the estimates in it, ready to run."""
        from .study import Study

        if not self._study:
            raise _frahm.StudyError(self._why_no_study)
        return Study.from_text(self._study, "identified.toml")

    def __str__(self) -> str:
        return self.table

    def __repr__(self) -> str:
        return f"<frahm.Identification {self.outcome}: {', '.join(f'{n} = {e}' for n, e in self.estimates.items())}>"


def identification_of(result: Result, keep: bool) -> Identification:
    """The model from the file of a run. keep: whether the file stays."""
    with open_result(result.file, "identification") as file:
        found = file.load()

    def estimate(name: str) -> Estimate:
        numbers = [float(found[each]) if each in found else np.nan
                   for each in (name, f"{name}_low", f"{name}_high", f"{name}_standard_error")]
        unit = found[name].attrs.get("units", "")
        return Estimate(*numbers, unit="" if unit == "1" else unit)

    estimates = found.attrs["estimates"].split()
    study, why_none = "", ""
    try:
        study = _frahm.identified_study(result.file)
    except (_frahm.StudyError, OSError) as error:
        why_none = str(error)
    return Identification(
        outcome=str(names(found.outcome).values),
        method=found.attrs["method"],
        estimates=Estimates((name, estimate(name)) for name in estimates),
        covariance=np.array([found[f"{name}_covariance"].values for name in estimates if f"{name}_covariance" in found]),
        fit=dict(zip(found.attrs.get("records", "").split(), np.atleast_1d(found["nrmse"].values).tolist()))
        if "nrmse" in found else {},
        notes=[line for line in found.attrs.get("notes", "").split("\n") if line],
        dataset=found,
        table=result.table,
        file=result.file if keep else None,
        _study=study,
        _why_no_study=why_none,
    )
