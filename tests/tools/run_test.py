#!/usr/bin/python3
"""tools/run with stand-ins for the program and the other tools: which command it ends up with."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"

# Shows the case with the last output.directory that is set; notes what it is to run.
PROGRAM = """#!/bin/bash
if [ "$1" = show ]; then
  directory=results/case
  for argument in "$@"; do [[ "$argument" == output.directory=* ]] && directory="${argument#*=}"; done
  printf 'title: T\\noutput:\\n  directory: %s\\n' "$directory"
else
  echo "ran: $*"
fi
"""


class RunTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.script("tools/setup", "#!/bin/bash\n")
        self.script("tools/build", "#!/bin/bash\n")
        self.script("tools/plot", '#!/bin/bash\necho "drew: $1"\n')
        self.script("build/quicksand", PROGRAM)
        shutil.copy(TOOLS / "run", self.folder / "tools/run")
        (self.folder / "my.yaml").write_text("title: T\n", encoding="utf-8")

    def script(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def result(self, status=None, directory="results/case"):
        folder = self.folder / directory
        folder.mkdir(parents=True)
        (folder / "case.yaml").write_text("title: T\n", encoding="utf-8")
        (folder / "history.csv").write_text("step\n", encoding="utf-8")
        if status:
            (folder / "summary.json").write_text(f'{{\n  "status": "{status}"\n}}\n', encoding="utf-8")

    def run_case(self, *options):
        return subprocess.run(["tools/run", "my.yaml", *options], cwd=self.folder, capture_output=True, text=True,
                              check=False)

    def test_runs_and_draws(self):
        done = self.run_case("--threads", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, "ran: run my.yaml --threads 2\ndrew: results/case\n")

    def test_keeps_a_finished_run(self):
        self.result("finished")
        for options in ((), ("--set", "output.directory=results/case")):
            done = self.run_case(*options)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("ran:", done.stdout)
            self.assertIn("drew: results/case", done.stdout)

    def test_settings_do_not_change_a_finished_run(self):
        self.result("finished")
        for options in (("--set", "time.end=1"), ("--set=time.end=1",)):
            done = self.run_case(*options)
            self.assertEqual(done.returncode, 2)
            self.assertIn("--overwrite", done.stderr)
            self.assertEqual(done.stdout, "")
        self.assertIn("ran: run my.yaml --set time.end=1 --overwrite",
                      self.run_case("--set", "time.end=1", "--overwrite").stdout)

    def test_repeats_a_run_that_did_not_finish(self):
        for status in ("failed", "interrupted", None):
            directory = f"results/{status}"
            self.result(status, directory)
            done = self.run_case("--output", directory)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"ran: run my.yaml --overwrite --output {directory}", done.stdout)

    def test_goes_on_from_a_checkpoint(self):
        self.result("interrupted")
        (self.folder / "results/case/checkpoint_00000007.h5").write_text("", encoding="utf-8")
        self.assertIn("ran: run my.yaml --resume --threads 2", self.run_case("--threads", "2").stdout)
        self.assertIn("ran: run my.yaml --overwrite", self.run_case("--overwrite").stdout)

    def test_leaves_other_folders_to_the_program(self):
        (self.folder / "results/case").mkdir(parents=True)
        (self.folder / "results/case/case.yaml").write_text("title: mine\n", encoding="utf-8")
        self.assertIn("ran: run my.yaml\n", self.run_case().stdout)

    def test_last_output_directory_counts(self):
        done = self.run_case("--set", "output.directory=a", "--set=output.directory=b")
        self.assertIn("drew: b", done.stdout)
        self.assertIn("drew: c", self.run_case("--output", "c", "--set", "output.directory=a").stdout)


if __name__ == "__main__":
    unittest.main()
