"""The progress of a run: on a terminal, in a notebook, or for a function of your own."""

import json
import sys
import time
from typing import Any, Callable, Optional, TextIO, Union

from .words import of_python

Progress = Union[str, Callable[[dict[str, Any]], None]]
""""auto", "none", or a function that gets each report: points, done, failed, percent, seconds_left ...; for a tuning evaluations"""

SECONDS_BETWEEN_LINES = 30  # where a line cannot be written over, as the program does


def in_notebook() -> bool:
    """Whether this process is the kernel of a notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


class Reports:
    """Takes the lines that a run writes: reports are shown, other lines kept and shown below them."""

    def __init__(self, progress: Progress):
        if not callable(progress) and progress not in ("auto", "none"):
            raise ValueError(f"progress={progress!r}: must be \"auto\", \"none\" or a function")
        self.messages: list[str] = []
        self.raised: Optional[BaseException] = None  # by the function for reports
        self._told: Optional[Callable[[dict[str, Any]], None]] = progress if callable(progress) else None
        self._quiet = progress == "none"
        self._notebook = in_notebook()
        self._out: TextIO = sys.stdout if self._notebook else sys.stderr  # stderr is red in notebooks
        self._redraws = self._notebook or self._out.isatty()
        self._next = 0.0

    def line(self, text: str) -> bool:
        """Takes a line. Returns whether the run is to stop: the function for reports has raised."""
        if text.startswith("{"):
            self._report(json.loads(text))
        else:
            self._message(of_python(text))
        return self.raised is not None

    def _message(self, text: str) -> None:
        self.messages.append(text)
        if not self._quiet and self._told is None:
            print(text, file=self._out, flush=True)

    def _report(self, report: dict[str, Any]) -> None:
        last = report.get("event") == "end"
        if self._told is not None and self.raised is None:
            try:
                self._told(report)
            except BaseException as error:  # given to the caller when the run has stopped
                self.raised = error
        if self._told is not None or self._quiet:
            return
        if self._redraws:
            self._out.write("\r" + _line(report).ljust(79) + ("\n" if last else ""))
        elif last or time.monotonic() >= self._next:
            self._next = time.monotonic() + SECONDS_BETWEEN_LINES
            self._out.write(_line(report) + "\n")
        self._out.flush()


def _line(report: dict[str, Any]) -> str:
    full = int(report["percent"] / 5)
    line = f"[{'=' * full}{'-' * (20 - full)}] {report['percent']:5.1f} %  {report['done']}/{report['points']} {report.get('counted', 'points')}"
    if report.get("stage"):
        line = f"{report['stage']} {line}"
    if report.get("evaluations"):
        line += f"  {report['evaluations']} evaluations in {_readable(report['seconds'])}"
    elif report.get("points_per_second"):
        line += f"  {report['points_per_second']:.3g} points/s"
    if report.get("seconds_left"):
        line += f"  {_readable(report['seconds_left'])} left"
    if report.get("failed"):
        line += f"  {report['failed']} without a result"
    return line


def _readable(seconds: float) -> str:
    whole = int(seconds) + 1
    if whole < 60:
        return f"{whole} s"
    return f"{whole // 60} min {whole % 60} s" if whole < 3600 else f"{whole // 3600} h {whole % 3600 // 60} min"
