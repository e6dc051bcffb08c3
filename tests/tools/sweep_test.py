#!/usr/bin/python3
"""tools/sweep with a stand-in for the program: what it runs, keeps and resumes."""
import csv
import pathlib
import tempfile
import unittest

import tool

# Writes a result whose height is the value of h, unless that is `bad`; notes its arguments in runs.txt.
PROGRAM = """#!/usr/bin/python3
import pathlib, sys
here = pathlib.Path(__file__).parent
words = sys.argv[1:]
settings = dict(word.split("=", 1) for flag, word in zip(words, words[1:]) if flag == "--set")
settings.pop("output.directory", None)
case = "".join(f"{key}: {value}\\n" for key, value in settings.items()) + pathlib.Path(words[1]).read_text()
if words[0] == "show":
    if settings.get("a.h") == "wrong":
        sys.exit("a.h: must be a number")
    sys.exit(print(case, end=""))
with open(here / "runs.txt", "a") as log:
    log.write(" ".join(words) + "\\n")
folder = pathlib.Path(words[words.index("--output") + 1])
folder.mkdir(exist_ok=True)
(folder / "case.yaml").write_text(case)
bad = settings["a.h"] == "bad"
height = 0 if bad else settings["a.h"]
(folder / "history.csv").write_text(f"step,time,dt,height_axis,iterations_projection\\n0,0,0,1,3\\n1,1,1,{height},3\\n")
(folder / "summary.json").write_text('{"status": "%s", "wall_seconds": 1.5}' % ("failed" if bad else "finished"))
sys.exit(3 if bad else 0)
"""


class SweepTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "quicksand"
        self.program.write_text(PROGRAM, encoding="utf-8")
        self.program.chmod(0o755)
        self.case = self.folder / "case.yaml"
        self.case.write_text("title: T\n", encoding="utf-8")
        self.out = self.folder / "out"

    def sweep(self, *over, options=()):
        words = [word for item in over for word in ("--over", item)]
        return tool.run("sweep", self.case, *words, "--out", self.out, "--program", self.program, "--threads", 1, *options)

    def runs(self):
        log = self.folder / "runs.txt"
        lines = log.read_text(encoding="utf-8").splitlines() if log.exists() else []
        log.unlink(missing_ok=True)
        return sorted(lines)

    def test_all_combinations_and_their_table(self):
        done = self.sweep("a.h=1,2", "b.w=[0,1],[0,2]", options=("--jobs", 2, "--set", "c=5"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.runs()), 4)
        with open(self.out / "sweep.csv", newline="", encoding="utf-8") as file:
            lines = list(csv.DictReader(file))
        self.assertEqual([(line["h"], line["w"], float(line["height_axis"])) for line in lines],
                         [("1", "[0,1]", 1), ("1", "[0,2]", 1), ("2", "[0,1]", 2), ("2", "[0,2]", 2)])
        self.assertNotIn("iterations_projection", lines[0])
        for line in lines:
            self.assertTrue((self.out / line["folder"] / "case.yaml").read_text(encoding="utf-8").startswith("c: 5\n"))
        self.assertTrue((self.out / "sweep.png").exists())

    def test_finished_runs_are_kept_until_the_case_changes(self):
        self.sweep("a.h=1,2")
        self.runs()
        done = self.sweep("a.h=1,2,3")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.runs()), 1)
        self.case.write_text("title: other\n", encoding="utf-8")
        self.sweep("a.h=1,2,3")
        runs = self.runs()
        self.assertEqual(len(runs), 3)
        self.assertTrue(all("--overwrite" in run for run in runs))

    def test_failed_runs_are_told_and_tried_again(self):
        done = self.sweep("a.h=1,bad")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("h = bad: failed with code 3", done.stdout)
        self.runs()
        self.sweep("a.h=1,bad")
        again = self.runs()
        self.assertEqual(len(again), 1)
        self.assertIn("--overwrite", again[0])

    def test_runs_that_left_a_checkpoint_are_resumed(self):
        self.sweep("a.h=1,bad")
        self.runs()
        (self.out / "h=bad" / "checkpoint_00000001.h5").touch()
        self.sweep("a.h=1,bad")
        again = self.runs()
        self.assertEqual(len(again), 1)
        self.assertIn("--resume", again[0])
        self.assertNotIn("--overwrite", again[0])
        self.case.write_text("title: other\n", encoding="utf-8")
        self.sweep("a.h=bad")
        self.assertIn("--overwrite", self.runs()[0])

    def test_says_what_is_wrong(self):
        for over, words in ((["a.h"], "is not KEY.PATH=VALUE"), (["a.h=1,1"], "names a value twice"), (["a.h=1,"], "is not"),
                            (["a.h=1,wrong"], "must be a number"), (["a.h=1", "a.h=2"], "the same key")):
            done = self.sweep(*over)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn(words, done.stderr)
        self.assertEqual(self.runs(), [])
        self.case.unlink()
        self.assertIn("there is no case file", self.sweep("a.h=1").stderr)


if __name__ == "__main__":
    unittest.main()
