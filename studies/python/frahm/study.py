"""A study: a system and what is to be computed for it."""

import difflib
import inspect
import os
import tempfile
from dataclasses import replace
from types import MappingProxyType
from typing import Any, Callable, Mapping, Optional, Sequence, TypeVar, Union

import numpy as np

from . import _frahm
from .assignments import Value, assignments, file_name, is_axis, plain, short, values_of_axis, whole
from .identification import Identification, identification_of
from .point import Point, point_of
from .progress import Progress
from .response import Response, response_of
from .running import Result, run
from .tuning import Tuning, tuning_of

Path = Union[str, os.PathLike]
Kind = TypeVar("Kind")
MOST_INSTANTS = 10_000_000  # of a history, as of a motion's samples: some hundred megabytes


class Study:
    """A study that was read and checked. Made by load(), from_text() or from_dict(); never changed.

    It can be pickled, for other processes: it is read again there, with the tables beside its file.
    """

    def __init__(self, checked: _frahm.Study):
        self._study = checked

    @classmethod
    def load(cls, path: Path, **parameters: Value) -> "Study":
        """Reads a study file. parameters: values that replace those in the file.

        Raises StudyError for anything wrong in it, with the line, the rule and the nearest word.
        """
        return cls(_frahm.Study.load(file_name(path), assignments(parameters)))

    @classmethod
    def from_text(cls, text: str, name: Path = "study.toml", **parameters: Value) -> "Study":
        """Reads a study from a text. name: its file, for messages; tables are searched for next to it."""
        return cls(_frahm.Study.parse(plain(text, "a study"), file_name(name), assignments(parameters)))

    @classmethod
    def from_dict(cls, study: Mapping[str, Any], name: Path = "study.toml", **parameters: Value) -> "Study":
        """Makes a study from a dictionary with the sections of a study file; [[mass]] is a list of dictionaries.

        `text` is the file it stands for, to which the lines of messages belong.
        """
        if not isinstance(study, Mapping):
            raise TypeError(f"a study: must be a dictionary with the sections of a file, not {type(study).__name__}")
        return cls.from_text(_frahm.toml_text(dict(study)), name, **parameters)

    def __reduce__(self):
        return _read_again, (self.text, self.name, self._study.set)

    def __copy__(self) -> "Study":
        return self

    def __deepcopy__(self, memo: Any) -> "Study":
        return self

    def with_parameters(self, /, **parameters: Value) -> "Study":
        """The study with other values of parameters; those set before are kept unless set again."""
        kept = [each for each in self._study.set if each.split("=")[0] not in parameters]
        return Study(_frahm.Study.parse(self.text, self.name, kept + assignments(parameters)))

    @property
    def name(self) -> str:
        """The name of its file."""
        return self._study.name

    @property
    def text(self) -> str:
        """The study file."""
        return self._study.text

    @property
    def title(self) -> str:
        return self._study.title

    @property
    def kind(self) -> str:
        """As `kind` of [study] says it: "sweep", "tune" ..."""
        return self._study.kind

    @property
    def parameters(self) -> dict[str, tuple[float, str]]:
        """Value and unit of each number; a bare number given for it is read in that unit."""
        return {name: (value, unit) for name, value, unit in self._study.parameters()}

    @property
    def axes(self) -> dict[str, np.ndarray]:
        """The values of the parameters along the axes of its map."""
        return {name: values for name, _, values in self._study.axes()}

    @property
    def quantities(self) -> dict[str, str]:
        """All that a response is reported in, with its meaning."""
        return {name: f"{meaning} [{unit}]" for name, unit, meaning in self._study.quantities()}

    def point(self, at: Mapping[str, Value] = MappingProxyType({}), /, *, gradient: bool = False,
              responses: bool = False, history: Union[bool, int] = False, path: str = "fastest", **parameters: Value) -> Point:
        """The periodic response at one point, in full.

        parameters: the point; what it leaves out has the study's value. at: the same as a dictionary. gradient: the exact derivatives too.
        responses: every stable response that was found too.
        history: the motion over a period, at 513 instants or as many as are given. path: "general" finds
        every orbit by shooting. A point without a response has a status and a reason, and is no error.
        """
        self._refuse_misspelt(Study.point, parameters)
        if path not in ("fastest", "general"):
            raise ValueError(f"path={path!r}: must be \"fastest\" or \"general\"")
        samples = 513 if history is True else whole(history, "history", 0, MOST_INSTANTS)
        if samples == 1:
            raise ValueError(f"history={history}: must be at least 2 instants")
        place = {**self._dictionary(Study.point, at), **parameters}
        return point_of(self._study.point(assignments(place), path, samples, bool(gradient), bool(responses)))

    def response(self, row: Optional[str] = None, values: Optional[Sequence[Value]] = None, at: Mapping[str, Any] = MappingProxyType({}),
                 /, *, quantities: Union[str, Sequence[str], None] = None, threads: int = 0,
                 **parameters: Any) -> Response:
        """Periodic responses along a row, on all cores, as a map of the study would have them.

        row: the parameter that runs along it, most often the frequency. values: in its usual unit, or texts with a
        unit; none: those of the study's axis. parameters: of the other parameters a value, or several, each of which then makes
        an axis of the result before the row; at: the same as a dictionary. quantities: names or patterns ("*_peak"); none: those that the
        study records. threads: 0: one on each processor.
        """
        self._refuse_misspelt(Study.response, parameters)
        if row is None:
            raise TypeError("response() takes first the parameter along the row, and then its values: "
                            f"response({self._example()!r}, [...])")
        plain(row, "a parameter's name")
        others = {**self._dictionary(Study.response, at), **parameters}
        if row in others:
            raise ValueError(f"{row}: runs along the row, so it cannot have another value")
        axes = {name: given for name, given in others.items() if is_axis(given)}
        fixed = {name: given for name, given in others.items() if name not in axes}
        axes[row] = self._values_of_axis(row) if values is None else values
        arrays = {name: values_of_axis(name, given, self._study.in_usual_unit) for name, given in axes.items()}
        listed = [quantities] if isinstance(quantities, str) else list(quantities or [])
        wanted = [plain(each, "a quantity") for each in listed]
        given = [(name, array.tolist()) for name, array in arrays.items()]
        return response_of(arrays, self._study.rows(assignments(fixed), given, wanted, whole(threads, "threads", 0)))

    def run(self, output: Optional[Path] = None, *, from_result: Optional[Path] = None, threads: int = 0,
            fresh: bool = False, time_budget: Optional[float] = None, progress: Progress = "auto") -> Result:
        """Computes the study and writes its file, as `frahm run` does; one run at a time in a process.

        output: none: the study's name with .h5, in the working directory. from_result: a result whose points
        are taken over. fresh: discard what earlier runs left. time_budget [s]: stop after it. progress:
        "auto" shows it in terminals and notebooks, "none" is silent, a function gets each report.

        What is computed is kept: the same call goes on after an interruption, which raises KeyboardInterrupt.
        """
        return run(self._study, output, from_result, threads, fresh, time_budget, progress)

    def tune(self, output: Optional[Path] = None, **options: Any) -> Tuning:
        """Tunes the design of a study of kind "tune". output and options as of run(); without output no file
        is kept."""
        return self._in_file("tune", "tuned", output, options, tuning_of)

    def identify(self, output: Optional[Path] = None, **options: Any) -> Identification:
        """Identifies the model of a study of kind "identify". output and options as of run(); without output no
        file is kept."""
        return self._in_file("identify", "identified", output, options, identification_of)

    def _in_file(self, kind: str, done: str, output: Optional[Path], options: Mapping[str, Any],
                 read: Callable[[Result, bool], Kind]) -> Kind:
        if self.kind != kind:
            raise _refused("other_kind", f"{self.name}: {self._study.noun} cannot be {done}; its kind must be \"{kind}\"")
        of_run = _options(Study.run)
        unknown = [name for name in options if name not in of_run]
        if unknown:
            raise TypeError(f"{kind}() has no option {unknown[0]!r}, only output, {', '.join(of_run)}; "
                            f"the study says how, in [{kind}]")
        if output is not None:
            return read(_finished(self.run(output, **options)), True)
        with tempfile.TemporaryDirectory(prefix="frahm-") as folder:
            try:
                result = _finished(self.run(os.path.join(folder, f"{kind}.h5"), **options))
            except (TimeoutError, KeyboardInterrupt) as stopped:
                reason, _, kept = str(stopped).partition(": ")
                if folder not in kept:
                    raise
                raise type(stopped)(f"{reason}: nothing is kept without a file; {kind}(output) keeps what is computed, "
                                    "and the same call resumes from there") from None
            told = [line for line in result.table.splitlines() if folder not in line]  # that file goes
            return read(replace(result, table="\n".join(told) + "\n"), False)

    def _example(self) -> str:
        """A parameter of the study, for messages."""
        return next(reversed([*self.parameters, *self.axes]), "omega")

    def _dictionary(self, method: Callable[..., Any], given: Any) -> Mapping[str, Any]:
        if isinstance(given, Mapping):
            return given
        raise TypeError(f"{method.__name__}({short(given)}): a value needs the name of its parameter, such as "
                        f"{self._example()}={short(given)}; without a name only a dictionary is possible")

    def _refuse_misspelt(self, method: Callable[..., Any], given: Mapping[str, Any]) -> None:
        """Refuses what was meant as an option of a method but would be taken as a parameter."""
        for name in given:
            meant = difflib.get_close_matches(name, _options(method), 1)
            if name not in self.parameters and meant:
                raise TypeError(f"{method.__name__}() has no option {name!r}, and the study has no such parameter; "
                                f"did you mean {meant[0]!r}?")

    def _values_of_axis(self, row: str) -> np.ndarray:
        axes = self.axes
        if row not in axes:
            if row not in self.parameters:
                raise _refused("unknown_name", f"{row}: the study has no number of this name; it has {', '.join(self.parameters)}")
            raise _refused("missing_key", f"{row}: the study has no axis along it; give its values")
        return axes[row]

    def __repr__(self) -> str:
        return f"<frahm.Study {self.name}: {self._study.noun}{', ' + repr(self.title) if self.title else ''}>"


def _options(method: Callable[..., Any]) -> list[str]:
    """The names that can only be given as keywords."""
    return [name for name, each in inspect.signature(method).parameters.items() if each.kind is each.KEYWORD_ONLY]


def _refused(rule: str, message: str) -> _frahm.StudyError:
    error = _frahm.StudyError(message)
    error.rule = rule
    return error


def _read_again(text: str, name: str, parameters: Sequence[str]) -> Study:
    """A study in another process."""
    return Study(_frahm.Study.parse(text, name, parameters))


def _finished(result: Result) -> Result:
    if result.file is None:
        raise TimeoutError(" ".join(result.messages))
    return result
