"""A point has the numbers of `frahm point`, and exact derivatives."""

import json
import math
import multiprocessing
import subprocess
import threading
import time
import unittest

import frahm
import numpy as np
from small_studies import MACHINE, program, studies

SAME = 1e-12  # relative: the same computation, told twice
STEP = 1e-5  # relative, of central differences
DIFFERENCES = 1e-6  # relative: their error

ATLAS = studies / "rig" / "rig_atlas.toml"


def between_stops(w, stops, more={}):
    """A damped mass between two stops, driven at w."""
    return frahm.Study.from_dict({
        "study": {"schema": 1, "kind": "sweep", "units": "dimensionless"},
        "parameters": {"w": w},
        "mass": [{"name": "main", "mass": 1}],
        "element": [{"name": "spring", "type": "spring", "between": ["ground", "main"], "stiffness": 1},
                    {"name": "damper", "type": "damper", "between": ["ground", "main"], "damping": 0.1},
                    {"name": "stops", "type": "gap", "between": ["ground", "main"], **stops}],
        "excitation": {"frequency": "w", "force": [{"on": "main", "amplitude": 1}]},
        "axis": [{"parameter": "w", "values": [w]}],
        **more,
    })


class Points(unittest.TestCase):
    def test_every_quantity_is_that_of_the_program(self):
        told = subprocess.run([program, "point", ATLAS, "--at", "omega=250 rpm,I=6.36", "--json"],
                              capture_output=True, text=True, check=True)
        expected = json.loads(told.stdout)
        point = frahm.Study.load(ATLAS).point(omega="250 rpm", I=6.36)
        self.assertTrue(point.ok)
        self.assertEqual(point.status, expected["status"])
        self.assertEqual(set(point), set(expected["quantities"]))
        for name, quantity in expected["quantities"].items():
            value = quantity.get("meaning", quantity["value"])
            if isinstance(value, float) and isinstance(point[name], float):
                self.assertLessEqual(abs(point[name] - value), SAME * abs(value), name)
            elif value is None:
                self.assertTrue(point[name] is None or np.isnan(point[name]), name)
            else:
                self.assertEqual(point[name], value, name)
            self.assertEqual(point.units[name], quantity["unit"])
        self.assertEqual(len(point.stretches), len(expected["stretches"]))

    def test_derivatives_are_those_of_differences_in_the_units_of_the_parameters(self):
        study = frahm.Study.from_dict(MACHINE)
        at = {"speed": 600.0, "F": 40.0, "k": 320.0}  # rpm, N, kN/m
        point = study.point(gradient=True, **at)
        for name, value in at.items():
            step = STEP * value
            more, less = (study.point(**{**at, name: value + each})["machine_peak"] for each in (step, -step))
            exact = point.gradient["machine_peak"][name]
            self.assertLess(abs((more - less) / (2 * step) - exact), DIFFERENCES * abs(exact), name)
        self.assertNotIn("status", point.gradient)

    def test_the_history_is_a_period_whose_largest_displacement_is_the_peak(self):
        point = frahm.Study.from_dict(MACHINE).point(history=2001, F=20)
        history = point.history
        self.assertEqual(history["time"].shape, (2001,))
        self.assertAlmostEqual(history["time"][-1], 60 / 600, places=12)
        self.assertLess(abs(np.abs(history["machine_displacement"]).max() / point["machine_peak"] - 1), 1e-5)
        self.assertEqual(point.units["guide_force"], "N")
        self.assertIsNone(frahm.Study.from_dict(MACHINE).point().history)

    def test_a_wrong_word_gets_the_nearest_one(self):
        point = frahm.Study.from_dict(MACHINE).point()
        with self.assertRaisesRegex(KeyError, "did you mean 'machine_peak'"):
            point["machine_pek"]
        point = frahm.Study.from_dict(MACHINE).point(gradient=True, history=True)
        for wrong, words in ((lambda: point.gradient["machine_peek"], "no quantity .* did you mean 'machine_peak'"),
                             (lambda: point.gradient["machine_peak"]["sped"], "no parameter .* did you mean 'speed'"),
                             (lambda: point.history["machine_displacment"], "did you mean 'machine_displacement'"),
                             (lambda: point["nothing like it"], "no quantity 'nothing like it'\"$")):
            with self.assertRaisesRegex(KeyError, words):
                wrong()
        with self.assertRaisesRegex(ValueError, "fastest"):
            frahm.Study.from_dict(MACHINE).point(path="slow")

    def test_wrong_values_are_refused_by_their_name(self):
        study = frahm.Study.from_dict(MACHINE)
        for error, words, wrong in (
            (ValueError, "speed='600,F=1'.*comma", {"speed": "600,F=1"}),  # it would set F
            (ValueError, "'F=1,speed'", {"F=1,speed": 600}),
            (TypeError, "F: .*not bool", {"F": True}),
            (ValueError, "F=1000.*finite", {"F": 10**400}),
            (ValueError, "speed .*UTF-8", {"speed": "600 \ud800"}),
            (TypeError, "history=2.5: must be a whole number", {"history": 2.5}),
            (ValueError, "history=1000.*from 0 to", {"history": 10**30}),
            (ValueError, "history=1000000000: must be from 0 to 10000000", {"history": 10**9}),  # gigabytes
        ):
            with self.assertRaisesRegex(error, words):
                study.point(**wrong)
        with self.assertRaisesRegex(TypeError, r"point\(600\): a value needs the name of its parameter"):
            study.point(600)
        with self.assertRaisesRegex(ValueError, "speed .*must not have a NUL character"):
            study.point(speed="600\0")
        self.assertEqual(study.point(F=np.array(7)).parameters["F"][0], 7)

    def test_processes_give_the_same_numbers(self):
        study = frahm.Study.from_dict(MACHINE, speed="10 Hz").with_parameters(F=30)
        places = [{"speed": speed} for speed in (450, 600, 620, 900)]
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            found = pool.map(study.point, places)
            with self.assertRaises(frahm.StudyError) as refused:
                pool.map(study.point, [{"sped": 600}])
        self.assertEqual(refused.exception.rule, "unknown_name")
        for point, at in zip(found, places):
            alone = study.point(at)
            self.assertEqual(point.parameters, alone.parameters)
            np.testing.assert_equal(point.quantities, alone.quantities)

    def test_a_point_without_an_error_bound_says_why(self):
        damped = frahm.Study.from_dict(MACHINE).point()
        self.assertGreater(damped["error_bound"], 0)
        self.assertEqual(damped.why_no_error_bound, "")
        undamped = frahm.Study.from_dict({
            "study": {"schema": 1, "kind": "sweep", "units": "dimensionless"},
            "parameters": {"w": 1.00001},
            "mass": [{"name": "main", "mass": 1}],
            "element": [{"name": "spring", "type": "spring", "between": ["ground", "main"], "stiffness": 1}],
            "excitation": {"frequency": "w", "force": [{"on": "main", "amplitude": 1}]},
            "axis": [{"parameter": "w", "values": [1.00001]}],
        }).point()
        self.assertEqual(undamped.status, "ok")
        self.assertTrue(math.isnan(undamped["error_bound"]))
        self.assertIn("nothing damps", undamped.why_no_error_bound)

    def test_every_stable_response_is_told_with_its_state_and_multipliers(self):
        point = between_stops(1.6, {"clearance": 1, "stiffness": 4, "tension": True}).point(responses=True)
        self.assertEqual(point.status, "several")
        small, large = sorted(point.responses, key=lambda each: each.peaks["main_peak"])
        self.assertIsInstance(small, frahm.FoundResponse)
        # The small one never reaches the stops; the large one by harmonic pieces, twice.
        self.assertLess(abs(small.peaks["main_peak"] / abs(1 / complex(1 - 1.6**2, 0.16)) - 1), 1e-12)
        self.assertLess(abs(small.state["main_displacement"] / (1 / complex(1 - 1.6**2, 0.16)).real - 1), 1e-10)
        self.assertLess(abs(large.peaks["main_peak"] - 2.4531427), 1e-7)
        self.assertEqual([large.is_shown, small.is_shown], [True, False])
        self.assertEqual(large.peaks["main_peak"], point["main_peak"])
        for each in (small, large):
            self.assertEqual((each.period_multiple, each.mirror_of), (1, None))
            # The damper alone shrinks areas of states: the multipliers' product is exp(-c T/m).
            self.assertLess(abs(np.prod(each.multipliers) / np.exp(-0.1 * 2 * np.pi / 1.6) - 1), 1e-9)
        self.assertIsNone(frahm.Study.from_dict(MACHINE).point().responses)
        alone, = frahm.Study.from_dict(MACHINE).point(responses=True).responses
        self.assertTrue(alone.is_shown)

    def test_both_responses_of_a_mirror_pair_are_told(self):
        point = between_stops(1.55, {"clearance": 0.2, "stiffness": 20}, {"orbits": {"starts": 1}}).point(responses=True)
        self.assertEqual((point.status, point["coexisting"], point["unsettled"]), ("several", 2, 0))
        first, second = point.responses
        self.assertEqual((first.mirror_of, second.mirror_of), (None, 0))
        # By a Dormand-Prince integration of order 8 from event to event, closed by Newton's method.
        expected = [(0.272924906208, 0.519404108301), (0.300964902483, -0.428737100728)]
        found = sorted((each.state["main_displacement"], each.state["main_velocity"]) for each in point.responses)
        self.assertLess(np.abs(np.subtract(found, expected)).max(), 1e-8)
        for each in point.responses:
            self.assertLess(abs(each.peaks["main_peak"] - 0.354874840919), 1e-8)
            self.assertLess(abs(np.prod(each.multipliers) / np.exp(-0.1 * 2 * np.pi / 1.55) - 1), 1e-9)

    def test_a_motion_is_refused(self):
        study = frahm.Study.load(studies / "lecture" / "run_up.toml")
        with self.assertRaisesRegex(frahm.StudyError, "has no periodic response"):
            study.point()

    def test_other_threads_of_python_go_on_while_it_computes(self):
        study = frahm.Study.load(ATLAS)
        end, ticks = threading.Event(), []

        def tick():
            while not end.is_set():
                ticks.append(time.monotonic())
                time.sleep(1e-3)

        ticking = threading.Thread(target=tick)
        ticking.start()
        began = time.monotonic()
        study.response("omega", np.linspace(150, 350, 20001), I=[4.72, 6.36, 8, 10], FP=0.0419, threads=1)
        ended = time.monotonic()
        end.set()
        ticking.join()
        during = [each for each in ticks if began < each < ended]
        # A tick each millisecond where the interpreter is free, none where it is held; a busy machine has fewer.
        self.assertGreater(len(during), 10 * (ended - began))


if __name__ == "__main__":
    unittest.main()
