"""The drivers for Dakota and OpenMDAO: what they give an optimiser, and with OpenMDAO itself where it is installed."""

import importlib.util
import subprocess
import sys
import tempfile
import types
import unittest
from pathlib import Path

import numpy as np
from small_studies import studies

STEP = 1e-6
DIFFERENCES = 1e-6  # relative to the largest derivative: error of central differences
DAKOTA = studies / "python" / "dakota" / "driver.py"
OPENMDAO = studies / "python" / "openmdao" / "absorber.py"

# As Dakota writes it: standard format, tags behind the numbers.
PARAMETERS = """                     2 variables
  {f:.16e} f
  {zeta:.16e} zeta
                    12 functions
{wanted}
                     2 derivative_variables
                     1 DVV_1:f
                     2 DVV_2:zeta
                     0 analysis_components
                     1 eval_id
"""


def answer_to_dakota(f, zeta, asked):
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder) / "parameters.in", Path(folder) / "results.out"
        wanted = "\n".join(f"{asked:22d} ASV_{i}:peak_{i}" for i in range(1, 13))
        given.write_text(PARAMETERS.format(f=f, zeta=zeta, wanted=wanted))
        subprocess.run([sys.executable, DAKOTA, given, made], check=True)
        return made.read_text().splitlines()


def module_of(path, name):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def stand_in_for_openmdao():
    """As much of openmdao.api as a component alone needs."""

    class Options(dict):
        def declare(self, name, **_):
            self.setdefault(name, None)

    class ExplicitComponent:
        def __init__(self, **options):
            self.options = Options()
            self.initialize()
            self.options.update(options)

    api = types.ModuleType("openmdao.api")
    api.ExplicitComponent, api.AnalysisError = ExplicitComponent, ValueError
    return {"openmdao": types.ModuleType("openmdao"), "openmdao.api": api}


class Drivers(unittest.TestCase):
    def test_dakota_gets_values_and_exact_gradients(self):
        lines = answer_to_dakota(0.9, 0.2, 3)
        self.assertEqual(len(lines), 24)
        values = [float(line.split()[0]) for line in lines[:12]]
        gradients = np.array([[float(each) for each in line.strip("[] ").split()] for line in lines[12:]])
        for column, (df, dzeta) in enumerate(((STEP, 0), (0, STEP))):
            more, less = (np.array([float(line.split()[0]) for line in answer_to_dakota(0.9 + s * df, 0.2 + s * dzeta, 1)])
                          for s in (1, -1))
            differences = (more - less) / (2 * STEP)
            np.testing.assert_allclose(gradients[:, column], differences, atol=DIFFERENCES * abs(differences).max())
        self.assertTrue(all(value > 0 for value in values))

    def test_dakota_is_told_of_a_point_without_a_response(self):
        driver = module_of(DAKOTA, "driver")
        driver.QUANTITY = "residual"
        driver.FREQUENCIES = [0.0]
        with self.assertRaises(ValueError):  # a frequency out of range is a mistake of the study, told as one
            driver.results({"f": 0.9, "zeta": 0.2}, [1], [])

    @unittest.skipIf(importlib.util.find_spec("openmdao"), "with OpenMDAO itself below")
    def test_the_component_of_openmdao_has_the_partials_of_its_outputs(self):
        before = dict(sys.modules)
        sys.modules.update(stand_in_for_openmdao())
        try:
            module = module_of(OPENMDAO, "absorber")
        finally:
            for name in ("openmdao", "openmdao.api"):
                sys.modules.pop(name)
            self.assertEqual(set(before) - set(sys.modules), set())
        import frahm

        component = module.PeriodicPeaks(study=frahm.Study.load(module.STUDY), inputs=["f", "zeta"], quantity="main_peak",
                                         frequency="omega", frequencies=[0.8, 0.9, 1.1])
        at, partials = {"f": np.array([0.9]), "zeta": np.array([0.2])}, {}
        component.compute_partials(at, partials)
        for name in at:
            outputs = []
            for step in (STEP, -STEP):
                found = {}
                component.compute({**at, name: at[name] + step}, found)
                outputs.append(np.array(found["main_peak"]))
            differences = (outputs[0] - outputs[1]) / (2 * STEP)
            np.testing.assert_allclose(partials["main_peak", name][:, 0], differences,
                                       atol=DIFFERENCES * abs(differences).max())

    @unittest.skipUnless(importlib.util.find_spec("openmdao"), "OpenMDAO is not installed")
    def test_openmdao_finds_the_known_absorber(self):
        problem = module_of(OPENMDAO, "absorber").absorber()
        problem.run_driver()
        # Over a grid of frequencies the worst peak is a little below the true one.
        self.assertLess(abs(problem.get_val("t")[0] / 6.407921 - 1), 1e-2)


if __name__ == "__main__":
    unittest.main()
