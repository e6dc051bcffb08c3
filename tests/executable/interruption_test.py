#!/usr/bin/python3
"""Runs that are interrupted, killed or starved of disk: what they leave and say, and what comes of resuming them.

usage: interruption_test.py PROGRAM CONFIGS [--slow]
"""
import json
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

# Small and quick, with enough steps to be caught in one; fields and checkpoints often.
OUTPUT = "output={{directory: {0}, fields: {{every: {1}}}, checkpoint: {{every: {2}}}}}"
CFL = "time={{end: {0}, cfl: 0.3, max_step: 0.005}}"
CASES = {
    "slug/case_e": 1.0,
    "slug/case_e_bingham": 0.2,
    "bubbles/free_ball": 1.2,
    "slug/case_e_3d": 0.06,
}
# The bubble grows out of a first grid, goes on to a second, and at a given time to a third.
SETTINGS = {
    "bubbles/free_ball": [
        "bubbles.0.pressure=60",
        "regrid={bubble_cells: 10}",
        "stages=[{until: 1, grid: {x: {from: 0, to: 6.25, cells: 50}, z: {from: 0, to: 6.25, cells: 50}}}]",
    ],
}


class InterruptionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def command(self, case, *options, end=None, every=None):
        end = end or CASES[case]
        every = every or end / 5
        settings = [CFL.format(end), OUTPUT.format("R", every, every), *SETTINGS.get(case, [])]
        return [PROGRAM, "run", f"{CONFIGS}/{case}.yaml", *(f"--set={setting}" for setting in settings), "--threads", "1",
                *options]

    def start(self, arguments, **options):
        return subprocess.Popen(arguments, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                **options)

    def finish(self, arguments, **options):
        process = self.start(arguments, **options)
        out, err = process.communicate(timeout=600)
        return process.returncode, out + err

    def end_after(self, arguments, seconds, number):
        """Sends a signal after a while. Returns the exit code."""
        process = self.start(arguments)
        try:
            process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(number)
            process.communicate(timeout=600)
        return process.returncode

    def results(self):
        """Content of all files but the summary, which tells times of the day."""
        files = {}
        for path in sorted((self.folder / "R").iterdir()):
            if path.name != "summary.json" and not path.name.startswith("checkpoint_"):
                files[path.name] = path.read_bytes()
        return files

    def whole_run(self, case):
        """Results and duration of an uninterrupted run."""
        begin = time.monotonic()
        code, text = self.finish(self.command(case))
        self.assertEqual(code, 0, text)
        results = self.results()
        duration = time.monotonic() - begin
        shutil.rmtree(self.folder / "R")
        return results, duration

    def expect_same(self, expected):
        found = self.results()
        self.assertEqual(sorted(found), sorted(expected))
        for name in expected:
            self.assertTrue(found[name] == expected[name], f"{name} differs")

    def interrupt_and_resume(self, case, points):
        expected, duration = self.whole_run(case)
        for point in range(points):
            moment = random.uniform(0.05, 0.9) * duration
            with self.subTest(case=case, point=point, moment=moment):
                code = self.end_after(self.command(case), moment, signal.SIGTERM)
                self.assertIn(code, (0, 128 + signal.SIGTERM, -signal.SIGTERM))
                if code < 0:  # before the program listens
                    shutil.rmtree(self.folder / "R", ignore_errors=True)
                    continue
                self.assertTrue(list((self.folder / "R").glob("checkpoint_*.h5")))
                code, text = self.finish(self.command(case, "--resume"))
                self.assertEqual(code, 0, text)
                self.expect_same(expected)
            shutil.rmtree(self.folder / "R", ignore_errors=True)

    def kill_and_resume(self, case, times):
        """Kills a run during output, many times, each time going on from where it was."""
        command = self.command(case, every=CASES[case] / 60)
        code, text = self.finish(command)
        self.assertEqual(code, 0, text)
        expected = self.results()
        shutil.rmtree(self.folder / "R")
        kills = 0
        resume = []
        while kills < times:
            code = self.end_after(command + resume, random.uniform(0.01, 0.12), signal.SIGKILL)
            folder = self.folder / "R"
            resume = ["--resume"] if folder.exists() and list(folder.glob("checkpoint_*.h5")) else ["--overwrite"]
            if code == 0:
                self.expect_same(expected)
                resume = ["--overwrite"]
                continue
            self.assertEqual(code, -signal.SIGKILL)
            kills += 1
            for path in folder.glob("[!.]*.h5") if folder.exists() else []:
                code, text = self.finish([PROGRAM, "info", str(path)])
                self.assertEqual(code, 0, f"after kill {kills}: {text}")
            self.assertLessEqual(len(list(folder.glob("checkpoint_*.h5"))), 3)
        code, text = self.finish(command + resume)
        self.assertEqual(code, 0, text)
        self.expect_same(expected)
        self.assertFalse(list((self.folder / "R").glob(".*")), "files left half written")

    def test_interrupted_run_resumes_to_the_same_files(self):
        for case in CASES if SLOW else ["slug/case_e"]:
            self.interrupt_and_resume(case, 10 if SLOW else 1)

    def test_killed_run_resumes_to_the_same_files(self):
        self.kill_and_resume("slug/case_e", 200 if SLOW else 4)

    @unittest.skipUnless("--slow" in sys.argv, "slow")
    def test_second_thread_resumes_to_the_same_files(self):
        expected, duration = self.whole_run("slug/case_e_3d")
        code = self.end_after(self.command("slug/case_e_3d"), duration / 2, signal.SIGINT)
        self.assertIn(code, (0, 128 + signal.SIGINT))
        command = self.command("slug/case_e_3d", "--resume")
        command[command.index("--threads") + 1] = "2"
        code, text = self.finish(command)
        self.assertEqual(code, 0, text)
        self.expect_same(expected)

    def test_full_disk_ends_the_run_and_spares_its_files(self):
        code, text = self.finish(self.command("slug/case_e"), preexec_fn=limit_files)
        self.assertEqual(code, 4, text)
        self.assertIn("checkpoint_", text)
        files = [path for path in (self.folder / "R").iterdir() if path.suffix == ".h5"]
        self.assertTrue(files)
        for path in files:
            self.assertEqual(self.finish([PROGRAM, "info", str(path)])[0], 0)
        self.assertFalse(list((self.folder / "R").glob(".*")), "files left half written")

    def test_failed_run_leaves_the_states_before_and_after(self):
        code, text = self.finish(self.command("slug/case_e_bingham", "--set", "solver.viscous_max_iterations=1", "--set",
                                              "solver.viscous_tolerance=1e-9", "--set", "guard.halvings=2"))
        self.assertEqual(code, 3, text)
        self.assertEqual(text.count("trying again"), 2)
        names = sorted(path.name for path in (self.folder / "R").glob("failed_*"))
        self.assertEqual(names, ["failed_fields_00000000.h5", "failed_fields_00000001.h5"])
        for name in names:
            self.assertIn(f"R/{name}", text)
            self.assertEqual(self.finish([PROGRAM, "info", f"R/{name}"])[0], 0)

    def test_peak_memory_is_not_that_of_the_program_that_started_the_run(self):
        mine = bytearray(b"x") * (600 << 20)
        code, text = self.finish(self.command("slug/case_e", end=0.02))
        self.assertEqual(code, 0, text)
        summary = json.loads((self.folder / "R/summary.json").read_text(encoding="utf-8"))
        self.assertLess(summary["peak_memory_MiB"], 550)
        self.assertEqual(len(mine), 600 << 20)

    def test_removed_folder_ends_the_run(self):
        process = self.start(self.command("slug/case_e", every=0.05, end=40))
        while not (self.folder / "R/fields_00000000.h5").exists():
            time.sleep(0.01)
        (self.folder / "R").rename(self.folder / "elsewhere")
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 4, out + err)
        self.assertRegex(err, "R/.*: (folder R does not exist|cannot )")


def limit_files():
    """No file longer than a field file: writing a checkpoint fails as on a full disk."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT, LIMIT))


LIMIT = 100_000

if __name__ == "__main__":
    PROGRAM, CONFIGS = sys.argv[1:3]
    SLOW = "--slow" in sys.argv
    random.seed(1)
    unittest.main(argv=[sys.argv[0]])
