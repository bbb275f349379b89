"""Studies and paths that the tests of the Python module share."""

import os
from pathlib import Path

source = Path(os.environ["FRAHM_SOURCE_DIR"])
program = os.environ["FRAHM_PROGRAM"]
studies = source / "studies"

MACHINE = {
    "study": {"schema": 1, "kind": "sweep", "title": "A machine on a rubbing guide", "units": "SI"},
    "parameters": {"speed": {"value": 600, "unit": "rpm"}, "F": 40, "k": {"value": 320, "unit": "kN/m"}},
    "mass": [{"name": "machine", "mass": 80}, {"name": "absorber", "mass": 6}],
    "element": [
        {"name": "mount", "type": "spring", "between": ["ground", "machine"], "stiffness": "k"},
        {"name": "mount_damper", "type": "damper", "between": ["ground", "machine"], "damping": 250},
        {"name": "guide", "type": "coulomb", "between": ["ground", "machine"], "force": "F"},
        {"name": "absorber_spring", "type": "spring", "between": ["machine", "absorber"], "stiffness": 22e3},
        {"name": "absorber_damper", "type": "damper", "between": ["machine", "absorber"], "damping": 60},
    ],
    "excitation": {"frequency": "speed", "force": [{"on": "machine", "amplitude": 100}]},
    "axis": [
        {"parameter": "F", "values": [0, 20, 40, 80]},
        {"parameter": "speed", "unit": "rpm", "from": 300, "to": 1200, "points": 91},
    ],
}
