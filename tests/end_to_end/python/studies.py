"""Studies are read from files, texts and dictionaries, and refused in the words of the program."""

import copy
import pickle
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import frahm
import numpy as np
from small_studies import MACHINE, program, studies


class Studies(unittest.TestCase):
    def test_a_file_has_its_title_parameters_and_axes(self):
        study = frahm.Study.load(studies / "classics" / "regime_map.toml")
        self.assertEqual(study.kind, "sweep")
        self.assertTrue(study.title)
        self.assertIn("r", study.axes)
        self.assertIn("sweep", repr(study))

    def test_a_dictionary_is_the_file_that_it_stands_for(self):
        study = frahm.Study.from_dict(MACHINE)
        self.assertEqual(study.parameters, {"speed": (600.0, "rpm"), "F": (40.0, "N"), "k": (320.0, "kN/m")})
        np.testing.assert_array_equal(study.axes["F"], [0, 20, 40, 80])
        again = frahm.Study.from_text(study.text)
        self.assertEqual(again.parameters, study.parameters)
        self.assertIn("machine_peak", study.quantities)

    def test_a_dictionary_may_hold_numbers_and_arrays_of_numpy(self):
        changed = copy.deepcopy(MACHINE)
        changed["axis"][0]["values"] = np.array([0.0, 20.0])
        changed["mass"][0]["mass"] = np.float64(81)
        np.testing.assert_array_equal(frahm.Study.from_dict(changed).axes["F"], [0, 20])
        changed["mass"][0]["mass"] = None
        with self.assertRaisesRegex(frahm.StudyError, "mass: .*NoneType"):
            frahm.Study.from_dict(changed)
        changed["mass"][0]["mass"] = 10**20
        with self.assertRaisesRegex(frahm.StudyError, "mass.mass: a whole number beyond 64 bits; write it as a float"):
            frahm.Study.from_dict(changed)

    def test_what_is_no_dictionary_is_refused(self):
        with self.assertRaisesRegex(ValueError, "the file's name .*must not have a NUL character"):
            frahm.Study.load("a\0.toml")
        with self.assertRaisesRegex(TypeError, "a study: must be a dictionary with the sections of a file, not NoneType"):
            frahm.Study.from_dict(None)

    def test_a_dictionary_that_holds_itself_is_refused(self):
        endless = dict(MACHINE)
        endless["mass"] = [endless]
        deep = []
        for _ in range(200_000):
            deep = [deep]
        for wrong in (endless, dict(MACHINE, mass=deep)):
            with self.assertRaisesRegex(frahm.StudyError, "mass.*nested deeper than 16 levels"):
                frahm.Study.from_dict(wrong)

    def test_parameters_are_set_with_units_and_stay_set(self):
        study = frahm.Study.from_dict(MACHINE, speed="10 Hz").with_parameters(F=7)
        self.assertEqual(study.parameters["speed"], (600.0, "rpm"))
        self.assertEqual(study.with_parameters(F=8).parameters["F"][0], 8)
        self.assertEqual(study.parameters["F"][0], 7)

    def test_a_study_is_pickled_and_copied_with_what_was_set(self):
        study = frahm.Study.from_dict(MACHINE, "somewhere/machine.toml").with_parameters(F=7, speed="10 Hz")
        again = pickle.loads(pickle.dumps(study))
        self.assertEqual((again.text, again.name, again.parameters), (study.text, study.name, study.parameters))
        self.assertEqual(again.with_parameters(k=300).parameters["F"][0], 7)
        self.assertIs(copy.copy(study), study)
        self.assertIs(copy.deepcopy({"study": study})["study"], study)

    def test_a_mistake_is_told_in_the_words_of_the_program(self):
        wrong = copy.deepcopy(MACHINE)
        wrong["element"][0]["stifness"] = wrong["element"][0].pop("stiffness")
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(frahm.StudyError) as refused:
            path = Path(folder) / "wrong.toml"
            try:
                frahm.Study.from_dict(wrong, name=path)
            except frahm.StudyError:
                path.write_text(frahm._frahm.toml_text(wrong))
                told = subprocess.run([program, "check", path], capture_output=True, text=True)
                self.assertEqual(told.returncode, 2)
                raise
        self.assertEqual(told.stderr.strip(), f"frahm: {refused.exception}")
        self.assertIn('did you mean "stiffness"?', str(refused.exception))
        self.assertEqual(refused.exception.rule, "unknown_key")
        self.assertIsInstance(refused.exception, ValueError)

    def test_a_file_that_is_not_there_is_refused(self):
        with self.assertRaisesRegex(frahm.StudyError, "no_such.toml"):
            frahm.Study.load("no_such.toml")

    def test_a_name_or_text_that_is_not_utf_8_is_refused(self):
        with self.assertRaisesRegex(ValueError, "the file's name .*must be UTF-8"):
            frahm.Study.load(b"\xff.toml")
        with self.assertRaisesRegex(ValueError, "a study .*must be UTF-8"):
            frahm.Study.from_text("a = '\udc80'")
        with self.assertRaisesRegex(TypeError, "a study: must be a text, not int"):
            frahm.Study.from_text(3)

    def test_a_parameter_that_there_is_not_gets_the_nearest_word(self):
        study = frahm.Study.from_dict(MACHINE)
        for wrong in (lambda: study.point(sped=600), lambda: study.response("sped", [1]),
                      lambda: frahm.Study.from_dict(MACHINE, sped=3)):
            with self.assertRaisesRegex(frahm.StudyError, 'did you mean "speed"'):
                wrong()


class AnotherPython(unittest.TestCase):
    def test_a_package_that_is_built_for_another_python_says_which_one(self):
        package = Path(frahm.__file__).parent
        with tempfile.TemporaryDirectory() as folder:
            copy_of = Path(folder) / "frahm"
            copy_of.mkdir()
            for file in package.glob("*.py"):
                (copy_of / file.name).write_bytes(file.read_bytes())
            (copy_of / "_frahm.cpython-27-x86_64-linux-gnu.so").touch()
            ended = subprocess.run([sys.executable, "-c", "import frahm"], cwd=folder, env={"PYTHONPATH": folder},
                                   capture_output=True, text=True)
        self.assertNotEqual(ended.returncode, 0)
        last = ended.stderr.strip().splitlines()[-1]
        self.assertIn("frahm is built for Python 2.7", last)
        self.assertIn(f"this is Python {sys.version_info.major}.{sys.version_info.minor} ({sys.executable})", last)
        self.assertIn("-DPython_EXECUTABLE=", last)


if __name__ == "__main__":
    unittest.main()
