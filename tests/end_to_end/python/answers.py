"""Tunings and identifications in one call."""

import os
import signal
import tempfile
import unittest
from pathlib import Path

import frahm
import numpy as np
from small_studies import MACHINE, studies

# Nishihara and Asami, J. Vib. Acoust. 124 (2002) 576, for a mass ratio of 0.05.
KNOWN = {"f": 0.952372, "zeta": 0.133938}
KNOWN_PEAK = 6.407921
PRINTED = 2e-6  # the digits that stand there


class Answers(unittest.TestCase):
    def test_a_tuning_has_the_known_optimum(self):
        tuned = frahm.Study.load(studies / "tuning" / "tune_classical.toml").tune(progress="none")
        self.assertEqual(tuned.outcome, "converged")
        for name, value in KNOWN.items():
            self.assertLess(abs(tuned.design[name] - value), PRINTED)
        self.assertLess(abs(tuned.objective - KNOWN_PEAK), PRINTED)
        self.assertLess(tuned.certificate_gap, 1e-6)
        self.assertEqual(tuned.peaks.shape[1], 2)
        self.assertLess(abs(tuned.peaks[:, 1].max() / tuned.objective - 1), 1e-6)
        self.assertIsNone(tuned.file)
        self.assertIn("zeta", str(tuned))
        self.assertNotIn(".h5", str(tuned))

    def test_the_optimum_is_a_point_of_its_study(self):
        study = frahm.Study.load(studies / "tuning" / "tune_classical.toml")
        tuned = study.tune(progress="none")
        omega, height = tuned.peaks[tuned.peaks[:, 1].argmax()]
        self.assertLess(abs(study.point(tuned.design, omega=omega)["main_peak"] / height - 1), 1e-9)

    def test_an_identification_has_estimates_with_intervals_and_a_study(self):
        study = frahm.Study.load(studies / "identification" / "identify_rig_forced.toml")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "found.h5"
            found = study.identify(file, progress="none")
            self.assertEqual(found.file, str(file))
            self.assertTrue(file.exists())
        self.assertEqual(found.outcome, "converged")
        with self.assertRaisesRegex(KeyError, f"no estimate '{next(iter(found))}x'; did you mean"):
            found[next(iter(found)) + "x"]
        for estimate in found.values():
            self.assertLess(estimate.low, estimate.value)
            self.assertLess(estimate.value, estimate.high)
        self.assertEqual(found.covariance.shape, (len(found), len(found)))
        np.testing.assert_allclose(np.sqrt(np.diag(found.covariance)), [each.standard_error for each in found.values()])
        self.assertEqual(found.study().kind, "sweep")

    def test_an_estimate_is_a_value_of_a_parameter_with_its_unit(self):
        study = frahm.Study.from_dict(MACHINE)  # k is in kN/m
        found = frahm.Estimate(value=300e3, low=299e3, high=301e3, standard_error=500.0, unit="N/m")
        value, unit = study.with_parameters(k=found).parameters["k"]
        self.assertEqual((round(value, 9), unit), (300, "kN/m"))
        self.assertEqual(study.point(k=found, speed=600)["machine_peak"], study.point(k=300, speed=600)["machine_peak"])
        rows = [study.response("speed", [500, 600], k=k)["machine_peak"] for k in ([found, found], [300, "300 kN/m"])]
        np.testing.assert_allclose(rows[0], rows[1], rtol=1e-12)
        unknown = frahm.Estimate(float("nan"), float("nan"), float("nan"), float("nan"), "N/m")
        with self.assertRaisesRegex(ValueError, "k: the data do not determine"):
            study.with_parameters(k=unknown)

    def test_estimates_of_the_rig_go_into_its_study(self):
        study = frahm.Study.load(studies / "identification" / "identify_rig_forced.toml")
        found = study.identify(progress="none")
        start = study.with_parameters(**found).parameters
        for name, estimate in found.items():
            self.assertEqual(start[name][0], estimate.value)  # the study's units are those of SI

    def test_an_edited_identification_replaces_no_file_unasked(self):
        study = frahm.Study.load(studies / "identification" / "identify_rig_forced.toml")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "found.h5"
            study.identify(file, progress="none")
            with self.assertRaises(frahm.ResumeRefused):
                study.with_parameters(K=8200).identify(file, progress="none")

    def test_another_kind_of_study_is_refused(self):
        study = frahm.Study.from_dict(MACHINE)
        with self.assertRaisesRegex(TypeError, r"tune\(\) has no option 'start'.*in \[tune\]"):
            frahm.Study.load(studies / "tuning" / "tune_classical.toml").tune(start=3)
        with self.assertRaisesRegex(frahm.StudyError, 'a sweep cannot be tuned; its kind must be "tune"'):
            study.tune()
        with self.assertRaises(frahm.StudyError) as refused:
            study.tune()
        self.assertEqual(refused.exception.rule, "other_kind")
        with self.assertRaisesRegex(frahm.StudyError, "cannot be identified"):
            study.identify()

    def test_what_is_stopped_has_no_answer(self):
        study = frahm.Study.load(studies / "tuning" / "tune_rig_schedule.toml")
        with self.assertRaisesRegex(TimeoutError, "time budget"):
            study.tune(time_budget=1e-3, progress="none")
        with self.assertRaisesRegex(frahm.StudyError, "t.toml: has the name of a study"):
            study.tune("t.toml", progress="none")

    def test_what_is_stopped_without_a_file_is_not_said_to_be_kept_in_one(self):
        text = (studies / "tuning" / "tune_classical.toml").read_text()
        study = frahm.Study.from_text(text.replace("[tune]", "[tune]\nstart = 2000"))
        reports = []

        def interrupt(report):
            if report["done"] > 0 and not reports:
                reports.append(report)
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaisesRegex(KeyboardInterrupt, r"^stopped by SIGINT: nothing is kept .*tune\(output\)") as told:
            study.tune(progress=interrupt, threads=1)
        self.assertNotIn("frahm-", str(told.exception))


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it
    unittest.main()
