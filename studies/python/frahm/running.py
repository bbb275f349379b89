"""Runs: maps, tunings, motions and identifications, with their files."""

import numbers
import os
import re
import signal
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

from . import _frahm
from .assignments import file_name, short, whole
from .dataset import open as open_result
from .progress import Progress, Reports
from .words import of_python

if TYPE_CHECKING:
    import xarray

OUTCOMES = {0: "done", 3: "some_failed", 4: "stopped", 7: "not_converged"}


@dataclass(frozen=True)
class Result:
    """A run that has ended."""

    outcome: str  #: "done", "some_failed" (points), "stopped" (by the time budget), "not_converged" (a tuning, a fit)
    file: Optional[str]  #: the result; None where it was stopped before
    table: str  #: the short table that the program prints
    messages: list[str]  #: notes and warnings

    def open(self, group: Optional[str] = None) -> "xarray.Dataset":
        """The result as an xarray dataset, see frahm.open()."""
        if self.file is None:
            raise FileNotFoundError(f"the run has no result: {' '.join(self.messages)}")
        return open_result(self.file, group)

    def __str__(self) -> str:
        return self.table

    def __repr__(self) -> str:
        return f"<frahm.Result {self.outcome}: {self.file}>"


def run(
    study: _frahm.Study,
    output: Optional[str],
    from_result: Optional[str],
    threads: int,
    fresh: bool,
    time_budget: Optional[float],
    progress: Progress,
) -> Result:
    reports = Reports(progress)
    path = file_name(output) if output is not None else os.path.splitext(os.path.basename(study.name))[0] + ".h5"
    taken_over = file_name(from_result) if from_result is not None else ""
    if not isinstance(fresh, bool):  # "no" would discard what is computed
        raise TypeError(f"fresh={fresh!r}: must be True or False")
    code, table = _frahm.run(
        study, path, taken_over, whole(threads, "threads", 0), fresh, _budget(time_budget), _command(study, path), reports.line
    )
    if reports.raised is not None:
        raise reports.raised
    if code == 4:
        _pass_on(reports.messages)
    return Result(OUTCOMES[code], None if code == 4 else path, of_python(table), reports.messages)


def _budget(seconds: Any) -> Optional[float]:
    """A time budget [s]; None: without one."""
    if seconds is None:
        return None
    if not isinstance(seconds, numbers.Real) or isinstance(seconds, bool):
        raise TypeError(f"time_budget={short(seconds)}: must be a number of seconds")
    if not 0 < seconds <= sys.float_info.max:
        raise ValueError(f"time_budget={short(seconds)}: must be above 0 and finite [s]")
    return float(seconds)


def _pass_on(messages: list[str]) -> None:
    """The signal that stopped the run takes effect: Ctrl-C as KeyboardInterrupt, another as if there had been
    no run."""
    stopped = [match for line in messages if (match := re.match(r"stopped by (SIG\w+)", line))]
    if not stopped:
        return
    if stopped[0][1] == "SIGINT":
        raise KeyboardInterrupt(stopped[0].string)
    signal.raise_signal(getattr(signal, stopped[0][1]))


def _command(study: _frahm.Study, output: str) -> str:
    """The command given in the provenance of the result."""
    changes = "".join(f" --set {each}" for each in study.set)
    return f"python: frahm run {study.name}{changes} -o {output}"
