"""Rows have the values of the map that `frahm run` makes."""

import tempfile
import unittest
from pathlib import Path

import frahm
import numpy as np
from small_studies import MACHINE, studies

OF_MAP = 2e-12  # relative to the largest of the row: the map rounds to known digits

PHASE = 1e-11  # [rad]: of an amplitude far below the largest of its row


class Rows(unittest.TestCase):
    def compare(self, row, ds):
        for name, values in row.items():
            recorded = ds[name]
            if "flag_meanings" in recorded.attrs:
                np.testing.assert_array_equal(values, frahm.names(recorded).values, err_msg=name)
            elif name not in ("residual", "error_bound", "energy_balance"):
                np.testing.assert_allclose(values, recorded.values, rtol=OF_MAP, err_msg=name,
                                           atol=OF_MAP * np.nanmax(np.abs(recorded.values)))

    def test_a_whole_map_in_one_call_is_the_map(self):
        study = frahm.Study.from_dict(MACHINE)
        with tempfile.TemporaryDirectory() as folder:
            with study.run(Path(folder) / "machine.h5", progress="none").open() as file:
                ds = file.load()
        row = study.response("speed", F=study.axes["F"])
        self.assertEqual(row.dims, ("F", "speed"))
        self.assertEqual(row["machine_peak"].shape, (4, 91))
        self.assertEqual(set(row), set(ds.data_vars))
        self.compare(row, ds)
        labelled = row.to_xarray()
        self.assertEqual(labelled.machine_peak.attrs["units"], "m")
        self.assertEqual(labelled.speed.attrs["units"], "rpm")
        self.assertEqual(float(labelled.machine_peak.sel(F=20, speed=600)), row["machine_peak"][1, 30])

    def test_a_fine_row_is_that_of_the_map_as_near_as_the_guide_says(self):
        fine = {**MACHINE, "axis": [MACHINE["axis"][0], {**MACHINE["axis"][1], "points": 901}]}
        study = frahm.Study.from_dict(fine)
        with tempfile.TemporaryDirectory() as folder:
            with study.run(Path(folder) / "machine.h5", progress="none").open() as file:
                ds = file.load()
        row = study.response("speed", F=study.axes["F"])
        for name in set(row) - {"residual", "error_bound", "energy_balance"}:
            if row[name].dtype.kind != "f":
                continue
            difference, recorded = abs(row[name] - ds[name].values), abs(ds[name].values)
            most = PHASE if name.endswith("_phase") else OF_MAP * np.nanmax(recorded, axis=-1, keepdims=True)
            self.assertTrue((np.isnan(difference) | (difference <= most)).all(), name)

    def test_the_result_does_not_depend_on_the_threads(self):
        study = frahm.Study.from_dict(MACHINE)
        values = np.linspace(300, 1200, 1001)
        one, two = (study.response("speed", values, quantities="*_peak", F=[20, 80], threads=n) for n in (1, 2))
        self.assertEqual(set(one), {"machine_peak", "absorber_peak", "status"})
        for name in one:
            np.testing.assert_array_equal(one[name], two[name])

    def test_a_row_may_run_along_any_parameter(self):
        study = frahm.Study.from_dict(MACHINE)
        row = study.response("F", [0, 40], speed="10 Hz")
        for i, force in enumerate((0, 40)):
            peak = study.point(F=force, speed=600)["machine_peak"]
            self.assertLessEqual(abs(row["machine_peak"][i] - peak), OF_MAP * peak)

    def test_a_sweep_of_the_frequency_stays_on_the_branch_of_its_map(self):
        text = (studies / "stops" / "machine_on_stops.toml").read_text()
        text = text.replace('[compare]\nshow = "down"\n', "").replace("branches = true", "")
        study = frahm.Study.from_text(text)
        with tempfile.TemporaryDirectory() as folder:
            with study.run(Path(folder) / "stops.h5", progress="none").open() as file:
                ds = file.load()
        row = study.response("r")
        jump = np.diff(ds.machine_peak.values)
        self.assertLess(jump.min(), -1)  # there is one to miss
        np.testing.assert_allclose(row["machine_peak"], ds.machine_peak.values, rtol=OF_MAP)
        with self.assertRaisesRegex(frahm.StudyError, "sweeps the frequency"):
            study.response("D", [1, 2])

    def test_values_may_be_texts_with_units(self):
        study = frahm.Study.from_dict(MACHINE)
        told = study.response("speed", ["10 Hz", 660, "720 rpm"], F=["20 N", "0.04 kN"])
        np.testing.assert_allclose(told.coords["speed"], [600, 660, 720], rtol=OF_MAP)
        np.testing.assert_allclose(told.coords["F"], [20, 40], rtol=OF_MAP)
        plain = study.response("speed", [600, 660, 720], F=[20, 40])
        np.testing.assert_allclose(told["machine_peak"], plain["machine_peak"], rtol=OF_MAP)
        with self.assertRaisesRegex(frahm.StudyError, 'speed=10 Hzz'):
            study.response("speed", ["10 Hzz"])
        with self.assertRaisesRegex(TypeError, r"takes first the parameter along the row, and then its values: response\("):
            study.response(speed=["10 Hz", "11 Hz"])

    def test_points_without_a_response_have_a_reason(self):
        free = {**MACHINE, "element": [each for each in MACHINE["element"] if not each["name"].endswith("damper")]}
        natural = np.sqrt(np.linalg.eigvals([[342e3 / 80, -22e3 / 80], [-22e3 / 6, 22e3 / 6]]).min()) * 30 / np.pi
        row = frahm.Study.from_dict(free).response("speed", [300, natural, 400], F=0)
        self.assertEqual(row["status"][0], "ok")
        self.assertNotEqual(row["status"][1], "ok")

    def test_wrong_values_and_names_are_refused(self):
        study = frahm.Study.from_dict(MACHINE)
        with self.assertRaisesRegex(frahm.StudyError, 'did you mean "machine_peak"'):
            study.response("speed", quantities=["machine_pek"])
        with self.assertRaisesRegex(KeyError, "did you mean 'machine_peak'"):
            study.response("speed", [600])["machine_pek"]
        with self.assertRaises(frahm.StudyError) as refused:
            study.response("k")
        self.assertEqual(refused.exception.rule, "missing_key")
        with self.assertRaises(frahm.StudyError) as refused:
            study.response("omega")
        self.assertEqual(refused.exception.rule, "unknown_name")
        with self.assertRaisesRegex(TypeError, r"response\(\) has no option 'quantity'.*did you mean 'quantities'"):
            study.response("speed", quantity="machine_peak")
        with self.assertRaisesRegex(frahm.StudyError, r'^response\(\) "damping=3.0": no parameter is called "damping"'):
            study.response("speed", damping=3)
        with self.assertRaisesRegex(frahm.StudyError, "no values"):
            study.response("speed", [])
        with self.assertRaises(ValueError):
            study.response("speed", [[1, 2], [3, 4]])
        with self.assertRaisesRegex(TypeError, "speed=.*1j.*list of numbers"):
            study.response("speed", [1j])
        for missing in ([600, None], np.array([600, None], dtype=object)):
            with self.assertRaisesRegex(TypeError, "speed=.*None.*must be a number or a list of numbers"):
                study.response("speed", missing)
        for no_number in ([True], [600, False], [b"1"], np.array([True])):
            with self.assertRaisesRegex(TypeError, "speed=.*must be a number or a list of numbers"):
                study.response("speed", no_number)
        with self.assertRaisesRegex(TypeError, "F=.*None.*must be a number or a list of numbers"):
            study.response("speed", [600], F=[0, None])
        with self.assertRaisesRegex(ValueError, "speed: runs along the row"):
            study.response("speed", [600], speed=700)
        with self.assertRaisesRegex(TypeError, "a parameter's name: must be a text, not int"):
            study.response(3, [1])
        with self.assertRaisesRegex(TypeError, "a quantity: must be a text, not int"):
            study.response("speed", [600], quantities=[3])
        for threads, error in ((-1, ValueError), (10**30, ValueError), ("2", TypeError), (1.5, TypeError)):
            with self.assertRaisesRegex(error, "threads="):
                study.response("speed", [600], threads=threads)

    def test_values_may_come_from_a_generator(self):
        study = frahm.Study.from_dict(MACHINE)
        np.testing.assert_array_equal(study.response("speed", (rpm for rpm in (500, 600)))["machine_peak"],
                                      study.response("speed", [500, 600])["machine_peak"])


if __name__ == "__main__":
    unittest.main()
