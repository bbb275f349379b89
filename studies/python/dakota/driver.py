"""Driver for Dakota: the worst of several peaks of an absorber's main mass, with exact gradients.

Dakota calls it as `python3 driver.py PARAMETERS RESULTS` (see absorber.in). The variables are parameters of the study by
their names; the functions are the peaks at these frequencies. Another study needs other constants only.
"""

import math
import re
import sys
from pathlib import Path

import frahm

STUDY = Path(__file__).resolve().parents[2] / "tuning" / "tune_classical.toml"
QUANTITY = "main_peak"
FREQUENCY = "omega"
FREQUENCIES = [0.70 + 0.05 * i for i in range(12)]  # one function each


def read_parameters(path):
    """The variables by name, what is wanted of each function, and the variables of the gradient.

    Wanted are sums of 1 (value) and 2 (gradient), as in Dakota's active set vector.
    """
    lines = [line.split() for line in Path(path).read_text().splitlines() if line.strip()]
    variables, wanted, by = {}, [], []
    for number, tag in lines[1:]:
        if tag.startswith("ASV_"):
            wanted.append(int(number))
        elif tag.startswith("DVV_"):
            by.append(int(number))
        elif not re.fullmatch("functions|derivative_variables|analysis_components|eval_id", tag) and len(variables) < int(
                lines[0][0]):
            variables[tag] = float(number)
    return variables, wanted, [list(variables)[i - 1] for i in by]


def results(variables, wanted, by):
    """The lines of the results file: values, then gradients."""
    study = frahm.Study.load(STUDY)
    points = [study.point(gradient=bool(asked & 2), **{FREQUENCY: at}, **variables)
              for at, asked in zip(FREQUENCIES, wanted)]
    if not all(point.ok and math.isfinite(point[QUANTITY]) for point in points):
        return ["FAIL"]
    lines = [f"{point[QUANTITY]:.16e} peak_{i}" for i, (point, asked) in enumerate(zip(points, wanted), 1) if asked & 1]
    for point, asked in zip(points, wanted):
        if asked & 2:
            lines.append("[ " + " ".join(f"{point.gradient[QUANTITY][name]:.16e}" for name in by) + " ]")
    return lines


if __name__ == "__main__":
    Path(sys.argv[2]).write_text("\n".join(results(*read_parameters(sys.argv[1]))) + "\n")
