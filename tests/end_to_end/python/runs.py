"""Runs inside Python: their progress, their interruption, and other users of HDF5 in the same process."""

import contextlib
import copy
import io
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import unittest
from pathlib import Path

import frahm
from small_studies import MACHINE, program, studies

LONG = copy.deepcopy(MACHINE)  # a second of one thread
LONG["axis"] = [{"parameter": "F", "from": 1, "to": 200, "points": 901},
                {"parameter": "speed", "unit": "rpm", "from": 300, "to": 1200, "points": 301}]


def in_a_process(script, *arguments):
    """Runs a script in a Python of its own."""
    return subprocess.run([sys.executable, "-c", textwrap.dedent(script), *map(str, arguments)], text=True,
                          capture_output=True, cwd=Path(__file__).parent,
                          env={**os.environ, "PYTHONPATH": os.environ["PYTHONPATH"] + f":{Path(__file__).parent}"})


class Runs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.file = Path(temporary.name) / "machine.h5"

    def test_a_run_tells_its_reports_its_table_and_its_file(self):
        reports = []
        result = frahm.Study.from_dict(MACHINE, k=300).run(self.file, progress=reports.append)
        self.assertEqual(result.outcome, "done")
        self.assertEqual(reports[-1]["event"], "end")
        self.assertEqual({each["points"] for each in reports}, {4 * 91})
        self.assertIn("machine_peak", str(result))
        with result.open() as ds:
            self.assertIn("python: frahm run study.toml --set k=300.0", ds.attrs["history"])
        again = frahm.Study.from_dict(MACHINE, k=300).run(self.file, progress="none")
        self.assertIn("everything is computed already; fresh=True computes it again", str(again))

    def test_progress_is_a_line_that_is_written_over_where_that_can_be(self):
        class Terminal(io.StringIO):
            def isatty(self):
                return True

        for stream, begins in ((Terminal(), "\r["), (io.StringIO(), "[")):
            with contextlib.redirect_stderr(stream):
                frahm.Study.from_dict(MACHINE).run(self.file, fresh=True)
            self.assertTrue(stream.getvalue().startswith(begins), stream.getvalue())
            self.assertIn("100.0 %  364/364 points", stream.getvalue())
            self.assertTrue(stream.getvalue().endswith("\n"))

    def test_another_study_at_the_output_is_refused_with_advice(self):
        frahm.Study.from_dict(MACHINE).run(self.file, progress="none")
        with self.assertRaisesRegex(frahm.ResumeRefused, "(?s)k.*another output, or discard .* with fresh=True"):
            frahm.Study.from_dict(MACHINE, k=300).run(self.file, progress="none")
        frahm.Study.from_dict(MACHINE, k=300).run(self.file, fresh=True, progress="none")

    def test_a_place_that_cannot_be_written_is_an_error_of_the_system(self):
        with self.assertRaisesRegex(OSError, "no_such_folder"):
            frahm.Study.from_dict(MACHINE).run("no_such_folder/x.h5", progress="none")

    def test_a_signal_that_is_ignored_does_not_stop_a_run(self):
        def interrupt(report):
            os.kill(os.getpid(), signal.SIGINT)

        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            self.assertEqual(frahm.Study.from_dict(MACHINE).run(self.file, progress=interrupt).outcome, "done")
            self.assertIs(signal.getsignal(signal.SIGINT), signal.SIG_IGN)
        finally:
            signal.signal(signal.SIGINT, before)

    def test_an_exception_of_the_function_for_reports_stops_the_run_and_keeps_what_is_computed(self):
        study, kept = frahm.Study.from_dict(LONG), []

        def fail(report):
            if report["done"] > 0:
                kept.append(report["done"])
                raise ZeroDivisionError("of the caller")

        with self.assertRaisesRegex(ZeroDivisionError, "of the caller"):
            study.run(self.file, threads=1, progress=fail)
        self.assertEqual(len(kept), 1)
        self.assertFalse(self.file.exists())
        reports = []
        study.run(self.file, progress=reports.append)
        self.assertGreaterEqual(reports[0]["resumed"], kept[0])

    def test_after_an_exception_with_the_last_report_nothing_is_computed_anew(self):
        def fail(report):
            if report["event"] == "end":
                raise SystemExit(3)

        with self.assertRaises(SystemExit):
            frahm.Study.from_dict(MACHINE).run(self.file, progress=fail)
        reports = []
        frahm.Study.from_dict(MACHINE).run(self.file, progress=reports.append)
        self.assertEqual(reports[0]["resumed"], 4 * 91)
        self.assertTrue(self.file.exists())

    def test_a_terminal_that_is_gone_does_not_end_the_run(self):
        class Gone(io.StringIO):
            def write(self, text):
                raise BrokenPipeError

        with contextlib.redirect_stderr(Gone()):
            self.assertEqual(frahm.Study.from_dict(MACHINE).run(self.file).outcome, "done")

    def test_a_dataset_that_is_left_open_does_not_hinder_another_run(self):
        import h5py
        import xarray

        study = frahm.Study.from_dict(MACHINE)
        study.run(self.file, progress="none")
        left_open = [frahm.open(self.file), xarray.open_dataset(self.file, engine="h5netcdf"),
                     h5py.File(self.file), h5py.File(self.file)]
        first = float(left_open[0].machine_peak[1, 2])
        self.assertIn("computed already", str(study.run(self.file, progress="none")))
        study.with_parameters(k=300).run(self.file, fresh=True, progress="none")
        again = frahm.open(self.file)
        more = copy.deepcopy(MACHINE)
        more["axis"][0]["values"] = [0, 10, 20, 40, 80]
        grown = frahm.Study.from_dict(more, k=300).run(self.file.with_name("more.h5"), from_result=self.file, progress="none")
        self.assertIn("91 computed", str(grown))
        self.assertEqual(float(left_open[1].machine_peak[1, 2]), first)  # the file that was opened
        self.assertNotEqual(float(again.machine_peak[1, 2]), first)
        for each in [again, *left_open]:
            each.close()

    def test_a_damaged_file_does_not_end_the_interpreter(self):
        study = frahm.Study.from_dict(MACHINE)
        study.run(self.file, progress="none")
        whole, damaged = self.file.read_bytes(), self.file.with_name("damaged.h5")
        refused = 0
        heap = whole.index(b"GCOL")  # of the references to scales; inside it HDF5 may search without end, for the 5 s it gets
        places = [each for each in range(1000, 20_000, 500) if not heap - 40 < each < heap + 4096]
        for place in (*places, heap, heap + 8):
            damaged.write_bytes(whole[:place] + bytes(each ^ 0xFF for each in whole[place : place + 40]) + whole[place + 40 :])
            told = subprocess.run([program, "status", damaged], text=True, capture_output=True)
            try:
                frahm.open(damaged).close()
            except OSError as error:
                refused += 1
                self.assertIn("damaged.h5", str(error))
                # Where the check refuses it; a library that is served a pointer into nowhere may meet any end.
                if error.__cause__ is None and "ends in" not in str(error) + told.stderr:
                    self.assertEqual(f"frahm: {error}\n", told.stderr)
        self.assertGreater(refused, 5)
        damaged.write_bytes(whole[:2000])
        for wrong in (lambda: study.run(self.file.with_name("x.h5"), from_result=damaged, progress="none"),
                      lambda: frahm.open(damaged)):
            with self.assertRaisesRegex(OSError, "damaged.h5"):
                wrong()

    def test_a_time_budget_stops_it_and_the_same_call_goes_on(self):
        study = frahm.Study.from_dict(LONG)
        first = study.run(self.file, time_budget=0.05, threads=1, progress="none")
        self.assertEqual((first.outcome, first.file), ("stopped", None))
        with self.assertRaises(FileNotFoundError):
            first.open()

    def test_an_interruption_keeps_what_is_computed(self):
        # The interruption comes with the first report that has points done, from inside the run.
        study, before = frahm.Study.from_dict(LONG), signal.getsignal(signal.SIGINT)
        kept = []

        def interrupt(report):
            if report["done"] > 0 and not kept:
                kept.append(report["done"])
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaisesRegex(KeyboardInterrupt, "stopped by SIGINT.* kept next to"):
            study.run(self.file, threads=1, progress=interrupt)
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        self.assertFalse(self.file.exists())
        reports = []
        study.run(self.file, progress=reports.append)
        self.assertGreaterEqual(reports[0]["resumed"], kept[0])
        self.assertTrue(self.file.exists())

    def test_a_termination_keeps_what_is_computed_and_ends_the_process(self):
        done = in_a_process("""
            import os, signal, sys
            import frahm
            from runs import LONG

            def terminate(report):
                if report["done"] > 0:
                    os.kill(os.getpid(), signal.SIGTERM)

            frahm.Study.from_dict(LONG).run(sys.argv[1], threads=1, progress=terminate)
            print("not ended")
            """, self.file)
        self.assertEqual((done.returncode, done.stdout), (-signal.SIGTERM, ""), done.stderr)
        self.assertTrue(list(self.file.parent.glob("*.frahm-log")))

    def test_a_second_run_at_the_same_time_is_refused(self):
        study, began, tried = frahm.Study.from_dict(MACHINE), threading.Event(), threading.Event()

        def hold(report):  # the run cannot end before its report is taken
            began.set()
            tried.wait()

        running = threading.Thread(target=study.run, args=[self.file], kwargs={"progress": hold})
        running.start()
        began.wait()
        try:
            with self.assertRaisesRegex(RuntimeError, "already under way"):
                study.run(self.file.with_name("other.h5"), progress="none")
        finally:
            tried.set()
            running.join()
        self.assertTrue(self.file.exists())

    def test_a_growing_map_takes_points_over(self):
        frahm.Study.from_dict(MACHINE).run(self.file, progress="none")
        more = copy.deepcopy(MACHINE)
        more["axis"][0]["values"] = [0, 10, 20, 40, 80]
        result = frahm.Study.from_dict(more).run(self.file.with_name("more.h5"), from_result=self.file, progress="none")
        self.assertRegex(str(result), r"reused +364 points of .*machine.h5, 91 computed")

    def test_a_motion_has_no_map_but_a_group(self):
        study = frahm.Study.load(studies / "lecture" / "lecture_free_vibration.toml")
        result = study.run(self.file, progress="none")
        with result.open("decay") as decay:
            self.assertGreater(decay.sizes["time"], 10)
        with self.assertRaisesRegex(ValueError, "has no map; name one of its groups: .*decay"):
            result.open()
        with self.assertRaisesRegex(ValueError, "has no group 'optimum'; it has .*decay"):
            result.open("optimum")

    def test_open_tells_flags_by_name(self):
        with frahm.Study.from_dict(MACHINE).run(self.file, progress="none").open() as ds:
            self.assertTrue((frahm.names(ds.status) == "ok").all())
            self.assertEqual(frahm.names(ds.guide_regime).dims, ("F", "speed"))
            with self.assertRaisesRegex(ValueError, "is not a flag"):
                frahm.names(ds.machine_peak)
        with self.assertRaisesRegex(TypeError, "names: .*not int"):
            frahm.names(3)

    def test_what_is_no_result_is_refused_in_plain_words(self):
        study = self.file.with_suffix(".toml")
        study.write_text(frahm.Study.from_dict(MACHINE).text)
        for error, words, wrong in (
            (IsADirectoryError, "is a folder", self.file.parent),
            (FileNotFoundError, "there is no such file", self.file),
            (frahm.StudyError, r"is a study; frahm.Study.load reads it, and its run\(\) makes a result, such as machine.h5", study),
            (OSError, "points.py: cannot open the file: file signature not found", Path(__file__).with_name("points.py")),
            (ValueError, "the file's name 'a.*b': must not have a NUL", "a\0b"),
            (TypeError, "the file's name: must be a text or a path, not int", 3),
        ):
            with self.assertRaisesRegex(error, words):
                frahm.open(wrong)
        result = frahm.Study.load(study).run(self.file, progress="none")
        with self.assertRaisesRegex(TypeError, "group: must be a text, not int"):
            frahm.open(result.file, 3)
        with self.assertRaisesRegex(ValueError, "no group 'provenanc'; it has .*provenance"):
            result.open("provenanc")

    def test_a_value_of_a_parameter_that_runs_along_an_axis_is_for_points_alone(self):
        study = frahm.Study.from_dict(MACHINE, F=90)
        self.assertEqual(study.point().parameters["F"][0], 90)
        with self.assertRaisesRegex(frahm.StudyError, '^F=90.0: "F" runs along an axis of the map; change the axis'):
            study.run(self.file, progress="none")

    def test_messages_have_the_words_of_python(self):
        decay = frahm.Study.load(studies / "lecture" / "lecture_free_vibration.toml")
        study = frahm.Study.from_dict(MACHINE)
        study.run(self.file, progress="none")
        other = study.with_parameters(k=300)
        for error, words, wrong in (
            (frahm.StudyError, r"has no periodic response; use run\(\)$", decay.point),
            (frahm.StudyError, "no points to reuse .*from_result is for maps",
             lambda: decay.run(self.file.with_name("x.h5"), from_result=self.file, progress="none")),
            (frahm.StudyError, r"is a result; name the study it was made from \(frahm.open opens results\)",
             lambda: frahm.Study.load(self.file)),
            (OSError, "is not a result of frahm; name another output, or remove it",
             lambda: study.run(__file__, progress="none")),
            (frahm.ResumeRefused, "leave out from_result",
             lambda: other.run(self.file.with_name("x.h5"), from_result=self.file, progress="none")),
        ):
            with self.assertRaisesRegex(error, words) as told:
                wrong()
            self.assertNotRegex(str(told.exception), r"(?<!\S)--?[a-z]")

    def test_points_without_a_response_are_told_as_calls(self):
        from frahm.words import of_python

        self.assertEqual(of_python('    frahm point a b.toml --at "w=250 rpm,F=7" --set "k=3"'),
                         '    study.point(w="250 rpm", F=7)')

    def test_wrong_options_are_refused_by_their_name(self):
        study = frahm.Study.from_dict(MACHINE)
        for error, words, wrong in (
            (TypeError, "threads='2'", {"threads": "2"}),
            (ValueError, "threads=-3: must be from 0 to", {"threads": -3}),
            (TypeError, "fresh='no': must be True or False", {"fresh": "no"}),
            (ValueError, "progress=3: must be", {"progress": 3}),
            (TypeError, "time_budget='1s': must be a number of seconds", {"time_budget": "1s"}),
            (ValueError, "time_budget=0: must be above 0", {"time_budget": 0}),
            (ValueError, "time_budget=nan: must be above 0", {"time_budget": float("nan")}),
            (ValueError, "the file's name .*must be UTF-8", {"from_result": b"\xff.h5"}),
        ):
            with self.assertRaisesRegex(error, words):
                study.run(self.file, **wrong)
        with self.assertRaisesRegex(ValueError, "the file's name .*must be UTF-8"):
            study.run(b"\xff.h5")

    def test_hdf5_serves_h5py_in_the_same_process_whoever_comes_first(self):
        # A file left open by h5py at the end of the process has to be whole.
        for first in ("frahm", "h5py"):
            done = in_a_process("""
                import sys
                import importlib
                first, folder = sys.argv[1:]
                importlib.import_module(first)
                import frahm, h5py
                from small_studies import MACHINE
                def run():
                    frahm.Study.from_dict(MACHINE).run(folder + "/map.h5", fresh=True, progress="none")
                if first == "frahm":
                    run()
                left_open = h5py.File(folder + f"/{first}.h5", "w")
                left_open["x"] = list(range(1000))
                run()
                with h5py.File(folder + "/map.h5") as file:
                    assert file["machine_peak"].shape == (4, 91)
                try:
                    h5py.File(folder + "/no_such.h5")
                except OSError as error:
                    assert "no_such.h5" in str(error)
                sys.stdout.write("whole")
                """, first, self.file.parent)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "whole", ""), first)
            read = in_a_process("""
                import sys, h5py
                print(h5py.File(sys.argv[1])["x"][:].sum())
                """, self.file.parent / f"{first}.h5")
            self.assertEqual(read.stdout.strip(), "499500", (first, read.stderr))

    def test_blas_has_its_threads_back_after_a_run(self):
        done = in_a_process("""
            import ctypes, glob, sys
            import frahm
            from small_studies import MACHINE
            blas = [line.split()[-1] for line in open("/proc/self/maps") if "openblas" in line]
            if not blas:
                sys.exit(0)
            library = ctypes.CDLL(blas[0])
            library.openblas_set_num_threads(2)
            frahm.Study.from_dict(MACHINE).run(sys.argv[1], progress="none")
            assert library.openblas_get_num_threads() == 2
            """, self.file)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it
    unittest.main()
