#!/usr/bin/python3
"""The documentation: its links, what it says of the sources, its example in Python, and the tool that builds it."""
import pathlib
import re
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import tool  # noqa: E402
from documentation import figures, links  # noqa: E402
from documentation.pages import Page  # noqa: E402
from documentation.site import Site  # noqa: E402

ROOT = tool.TOOLS.parent
SOURCES = [path for path in (ROOT / "src").rglob("*") if path.suffix in (".cpp", ".hpp")]


def rows(page, until="\0"):
    """Cells of the tables of a page up to a heading, as text with its code marks."""
    lines = (ROOT / "docs" / page).read_text(encoding="utf-8").split(until)[0].splitlines()
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))] for line in lines
            if line.startswith("|") and not line.startswith("| ---")]


class Repository(unittest.TestCase):
    def test_links_anchors_and_paths_are_there(self):
        self.assertEqual(links.problems(ROOT), [])

    def test_theory_names_functions_of_the_files_beside_them(self):
        """A file named after functions in a cell of the table holds them; any other function is somewhere in src/."""
        everything = "\n".join(path.read_text(encoding="utf-8") for path in SOURCES)
        everything += "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests/support").glob("*.hpp"))
        named = 0
        for cell in [cells[-1] for cells in rows("theory.md")]:
            for part in cell.split(";"):
                codes = re.findall(r"`([^`]+)`", part)
                files = [ROOT / base / code for code in codes for base in ("src", ".") if (ROOT / base / code).is_file()]
                text = "\n".join(file.with_suffix(suffix).read_text(encoding="utf-8") for file in files
                                 for suffix in (".hpp", ".cpp") if file.with_suffix(suffix).exists())
                for code in codes:
                    if "/" in code or "." in code:
                        continue
                    named += 1
                    name = code.split("::")[-1]
                    self.assertTrue(re.search(rf"\b{name}\b", text or everything), f"{code} is not in {files or 'src/'}")
        self.assertGreater(named, 30)
        for name in re.findall(r"`(\w+)`", (ROOT / "docs/theory.md").read_text(encoding="utf-8")):
            self.assertTrue(re.search(rf"\b{name}\b", everything), f"{name} is not in src/")

    def test_listed_messages_are_those_of_the_sources(self):
        sources = "\n".join(path.read_text(encoding="utf-8") for path in SOURCES)
        sources = re.sub(r'"\s*\n\s*"', "", sources).replace('\\"', '"')
        # The last table is about what happens without a message.
        listed = [cell for cells in rows("troubleshooting.md", until="## Otherwise") for cell in re.findall(r"`([^`]+)`", cells[0])]
        self.assertGreater(len(listed), 40)
        self.assertEqual([text for text in listed if text not in sources], [])

    def test_python_example_runs(self):
        text = (ROOT / "docs/results.md").read_text(encoding="utf-8")
        example = re.search(r"```python\n(import csv.*?)```", text, re.DOTALL)[1]
        import h5py
        import numpy as np
        with tempfile.TemporaryDirectory() as folder:
            with h5py.File(pathlib.Path(folder) / "fields_00000000.h5", "w") as file:
                file.attrs["time"] = 0.5
                file["grid/z"] = np.linspace(0, 1.5, 7)
                file["fields/phi_slurry"] = np.repeat([[1.0], [1.0], [1.0], [0.5], [0.0], [0.0]], 4, axis=1)
                file["fields/velocity"] = np.full((6, 4, 2), 0.1)
            (pathlib.Path(folder) / "history.csv").write_text("step,radius_base\n0,0.25\n1,0.35\n", encoding="utf-8")
            printed = []
            exec(example.replace("results/slug_e", folder), {"print": lambda *words: printed.append(" ".join(words))})
        self.assertIn("t = 0.50  height 0.8750  speed 0.1414", printed[0])
        self.assertEqual(printed[1], "base radius at the end: 0.35")


class Tool(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "docs").mkdir()
        (self.root / "src/core").mkdir(parents=True)
        (self.root / "src/core/grid.hpp").write_text("// a grid\n", encoding="utf-8")

    def write(self, readme, guide="# Guide\n"):
        (self.root / "README.md").write_text(readme, encoding="utf-8")
        (self.root / "docs/guide.md").write_text(guide, encoding="utf-8")

    def test_sound_pages_have_no_problems(self):
        self.write("# A\n[one](docs/guide.md#two--three) [two](#a) `core/grid.hpp` `src/core` [web](https://example.org)\n",
                   "# Guide\n## Two & three\n[back](../README.md) [code](../src/core/grid.hpp) `grid.hpp` `core/*.{hpp,h*}`\n")
        self.assertEqual(links.problems(self.root), [])

    def test_everything_broken_is_named(self):
        self.write("# A\n\n[one](docs/gone.md) [two](docs/guide.md#nowhere) `core/gone.hpp` `gone.cpp` ![p](docs/p.png)\n\n"
                   "```\ntools/gone --all\n```\n")
        found = links.problems(self.root)
        self.assertEqual(len(found), 6, found)
        for text in ("README.md:3: there is no docs/gone.md", "README.md:3: docs/guide.md#nowhere names no heading",
                     "README.md:3: there is no core/gone.hpp", "README.md:3: there is no file gone.cpp",
                     "README.md:5: there is no tools/gone"):
            self.assertIn(text, found)

    def test_anchors_are_those_of_github(self):
        page = Page(self.root / "x.md", "# `grid`\n## Pressure at surfaces, and interfaces\n## ParaView, VisIt\n## `grid`\n")
        self.assertEqual([mark for _, _, mark, _ in page.headings],
                         ["grid", "pressure-at-surfaces-and-interfaces", "paraview-visit", "grid-1"])

    def test_site_holds_pages_and_linked_files(self):
        self.write("# A\n[guide](docs/guide.md#b) [code](src/core/grid.hpp) [folder](src/core)\n\n| a | b |\n|---|---|\n| 1 | 2 |\n",
                   "# Guide\n## B\n[back](../README.md)\n")
        out = self.root / "out"
        Site(self.root, out).build({"docs/guide.md": "## Added\n"})
        index = (out / "index.html").read_text(encoding="utf-8")
        self.assertIn('href="guide.html#b"', index)
        self.assertIn("<table>", index)
        self.assertIn('href="index.html"', (out / "guide.html").read_text(encoding="utf-8"))
        self.assertIn("Added", (out / "guide.html").read_text(encoding="utf-8"))
        self.assertIn("a grid", (out / "files/src/core/grid.hpp.html").read_text(encoding="utf-8"))
        # Every link of every page leads to a file of the site.
        for page in out.rglob("*.html"):
            for target in re.findall(r'(?:href|src)="([^"#:]+)["#]', page.read_text(encoding="utf-8")):
                self.assertTrue((page.parent / target).exists(), f"{page}: {target}")

    def test_figures_become_tables(self):
        path = self.root / "figures.tsv"
        path.write_text("Slug.Stops\tslug E\theight\t0.72\trelative\t0.717\t0.015\tVOF\n"
                        "Tube.Exact\ttube\terror\t2e-5\tat most\t0\t1e-5\texact\n"
                        "Slug.Stops\tslug E\theight\t0.7238\trelative\t0.717\t0.015\tVOF\n", encoding="utf-8")
        page = figures.page(figures.read_figures(path), "today")
        self.assertIn("2 figures, measured today. 1 are beyond their bounds", page)
        self.assertIn("| slug E | height | 0.7238 | 0.717 | +0.95 % | ± 1.5 % | VOF | `Stops` |", page)
        self.assertIn("| tube | error | **2e-05** |  |  | ≤ 1e-05 | exact | `Exact` |", page)


if __name__ == "__main__":
    unittest.main()
