"""OpenMDAO: an absorber tuned for the least worst peak, with frahm's exact derivatives.

`PeriodicPeaks` is a component for any study: its inputs are parameters, its output a quantity at several frequencies.
Run it where OpenMDAO is installed:  python3 absorber.py
"""

from pathlib import Path

import frahm
import numpy as np
import openmdao.api as om

STUDY = Path(__file__).resolve().parents[2] / "tuning" / "tune_classical.toml"


class PeriodicPeaks(om.ExplicitComponent):
    """A quantity of the periodic response over frequencies, by parameters of a study."""

    def initialize(self):
        self.options.declare("study", types=frahm.Study)
        self.options.declare("inputs", types=list, desc="parameters of the study")
        self.options.declare("quantity", types=str)
        self.options.declare("frequency", types=str, desc="the parameter of the excitation frequency")
        self.options.declare("frequencies", desc="in its usual unit")

    def setup(self):
        for name in self.options["inputs"]:
            self.add_input(name, val=self.options["study"].parameters[name][0])
        self.add_output(self.options["quantity"], shape=len(self.options["frequencies"]))
        self.declare_partials("*", "*")

    def compute(self, inputs, outputs):
        outputs[self.options["quantity"]] = [point[self.options["quantity"]] for point in self.points(inputs, False)]

    def compute_partials(self, inputs, partials):
        quantity = self.options["quantity"]
        gradients = [point.gradient[quantity] for point in self.points(inputs, True)]
        for name in self.options["inputs"]:
            partials[quantity, name] = np.array([[gradient[name]] for gradient in gradients])

    def points(self, inputs, gradient):
        at = {name: float(np.ravel(inputs[name])[0]) for name in self.options["inputs"]}
        points = [self.options["study"].point(gradient=gradient, **{self.options["frequency"]: frequency}, **at)
                  for frequency in self.options["frequencies"]]
        for frequency, point in zip(self.options["frequencies"], points):
            if not point.ok:
                raise om.AnalysisError(f"at {frequency} {at}: {point.status}: {point.reason}")
        return points


def absorber():
    """The problem: least t with every peak below t."""
    frequencies = np.linspace(0.6, 1.3, 141)
    problem = om.Problem()
    problem.model.add_subsystem(
        "peaks",
        PeriodicPeaks(study=frahm.Study.load(STUDY), inputs=["f", "zeta"], quantity="main_peak", frequency="omega",
                      frequencies=frequencies),
        promotes=["*"])
    problem.model.add_subsystem(
        "below", om.ExecComp("excess = main_peak - t", excess=np.zeros(141), main_peak=np.zeros(141), t=1.0,
                             has_diag_partials=False),
        promotes=["*"])
    problem.model.add_design_var("f", lower=0.3, upper=1.5)
    problem.model.add_design_var("zeta", lower=0.01, upper=0.6)
    problem.model.add_design_var("t", lower=0.0, ref=10.0)
    problem.model.add_constraint("excess", upper=0.0)
    problem.model.add_objective("t")
    problem.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-8)
    problem.setup()
    problem.set_val("f", 0.9)
    problem.set_val("zeta", 0.2)
    problem.set_val("t", 15.0)
    return problem


if __name__ == "__main__":
    problem = absorber()
    problem.run_driver()
    print({name: float(problem.get_val(name)[0]) for name in ("f", "zeta", "t")})
    print("on these frequencies; the optimum over all of them is f = 0.952372, zeta = 0.133938, peak 6.407921")
