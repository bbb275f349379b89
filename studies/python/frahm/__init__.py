"""Exact periodic responses of vibrating systems with dry friction and inerters.

    import frahm

    study = frahm.Study.load("machine.toml")
    point = study.point(speed="600 rpm", F=40, gradient=True)
    point["machine_peak"], point.gradient["machine_peak"]["F"]
    row = study.response("speed", range(300, 1201, 2), F=[0, 20, 40])
    result = study.run("machine.h5")
    ds = frahm.open("machine.h5")

Numbers are in the unit that the study uses for the parameter; a text may have one of its own: "10 Hz".
The interpreter is free while frahm computes.
"""

try:
    from ._frahm import ResumeRefused, StudyError
except ModuleNotFoundError as error:
    from .built_for import explained

    raise explained(error) from None
from .dataset import names, open
from .estimate import Estimate
from .identification import Identification
from .point import FoundResponse, Point
from .response import Response
from .running import Result
from .study import Study
from .tuning import Tuning

__all__ = [
    "Estimate",
    "FoundResponse",
    "Identification",
    "Point",
    "Response",
    "Result",
    "ResumeRefused",
    "Study",
    "StudyError",
    "Tuning",
    "names",
    "open",
]
