"""Installs the project into a temporary folder and uses what is there as a stranger would: the program, its manual page,
completion in bash, and the libraries in a program of one's own.

usage: install_test.py BUILD_FOLDER CMAKE
"""
import csv
import io
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD, CMAKE = sys.argv[1:3]
ROOT = pathlib.Path(__file__).resolve().parents[2]


def output_of(*command, **options):
    """What a command prints; an error with its messages where it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="quicksand_install_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix = cls.folder / "prefix"
        output_of(CMAKE, "--install", BUILD, "--prefix", cls.prefix)
        cls.program = cls.prefix / "bin/quicksand"

    def test_program_runs_a_shipped_case(self):
        case = self.prefix / "share/quicksand/configs/slug/case_e.yaml"
        self.assertIn("16 x 48", output_of(self.program, "check", case))

    def test_version_is_that_of_the_project(self):
        version = re.search(r"project\(quicksand VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(output_of(self.program, "--version").split()[1], version)
        self.assertIn(f'"quicksand {version}"', (self.prefix / "share/man/man1/quicksand.1").read_text())
        config = next(self.prefix.glob("lib*/**/quicksandConfigVersion.cmake")).read_text()
        self.assertIn(f'"{version}"', config)

    def test_manual_names_every_command_and_option(self):
        page = (self.prefix / "share/man/man1/quicksand.1").read_text().replace("\\-", "-")
        words = set(re.findall(r"^  quicksand ([a-z]+)|(--[a-z-]+)", output_of(self.program, "--help"), re.MULTILINE))
        self.assertGreater(len(words), 12)
        for command, option in words:
            self.assertIn(f".SS {command}" if command else f"\\fB{option}\\fR", page)

    def test_manual_is_sound(self):
        if shutil.which("groff"):
            page = self.prefix / "share/man/man1/quicksand.1"
            done = subprocess.run(["groff", "-man", "-ww", "-z", page], capture_output=True, text=True)
            self.assertEqual(done.stderr, "")

    def complete(self, *words):
        """What bash offers for the last word."""
        script = f"""
            source {self.prefix}/share/bash-completion/completions/quicksand
            complete -p quicksand > /dev/null
            cd {self.prefix}/share/quicksand/configs/slug
            COMP_WORDS=({self.program} "$@")
            COMP_CWORD=$#
            _quicksand
            printf '%s\\n' "${{COMPREPLY[@]}}"
        """
        return output_of("bash", "-c", script, "bash", *words).split()

    def test_completion_of_commands(self):
        self.assertIn("run", self.complete(""))
        self.assertEqual(self.complete("sch"), ["schema"])
        self.assertEqual(self.complete("help", "inf"), ["info"])

    def test_completion_of_options(self):
        self.assertEqual(self.complete("run", "case_e.yaml", "--res"), ["--resume"])
        self.assertEqual(sorted(self.complete("check", "--")), ["--help", "--set", "--strict"])

    def test_completion_of_case_files(self):
        self.assertIn("case_e.yaml", self.complete("run", ""))
        self.assertEqual(self.complete("run", "--set", ""), [])

    def test_headers_show_no_other_library(self):
        for header in (self.prefix / "include").rglob("*.hpp"):
            self.assertIsNone(re.search(r"#include [<\"](Eigen|hdf5|yaml-cpp|_?hypre|HYPRE|mpi|udunits)", header.read_text()),
                              header)

    def test_driver_of_ones_own(self):
        build = self.folder / "driver"
        cache = (pathlib.Path(BUILD) / "CMakeCache.txt").read_text()
        compilers = [f"-D{name}={re.search(name + ':[A-Z]+=(.*)', cache)[1]}"
                     for name in ("CMAKE_C_COMPILER", "CMAKE_CXX_COMPILER")]
        output_of(CMAKE, "-S", self.prefix / "share/quicksand/examples/driver", "-B", build,
                  f"-DCMAKE_PREFIX_PATH={self.prefix}", *compilers)
        output_of(CMAKE, "--build", build)
        rows = list(csv.DictReader(io.StringIO(output_of(build / "dam_break"))))
        front = {float(row["time"]): float(row["front"]) for row in rows}
        energy = [float(row["energy"]) for row in rows]
        self.assertEqual(front[0], 1)
        # At first p = 0 on the column's face and top makes p harmonic, with this gradient on the face in the lowest row.
        acceleration = sum(2 * math.tanh(k) / k * math.cos(k / 64) for k in ((n + 0.5) * math.pi for n in range(20000)))
        self.assertAlmostEqual(front[0.25], 1 + acceleration * 0.25**2 / 2, delta=0.01)
        # No front outruns that of shallow water on a dry floor.
        for time, place in front.items():
            self.assertLessEqual(place, 1 + 2 * time)
        for value in energy:
            self.assertAlmostEqual(value / energy[0], 1, delta=5e-3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
