#!/usr/bin/python3
"""tools/report on a small made-up result."""
import html.parser
import pathlib
import tempfile
import unittest

import numpy as np

import tool
from results import write_crater, write_history, write_snapshot, write_summary


class Reader(html.parser.HTMLParser):
    """Collects what a page shows and what it asks for."""

    def __init__(self):
        super().__init__()
        self.text, self.sources, self.open = "", [], []

    def handle_starttag(self, tag, attributes):
        self.sources += [value for name, value in attributes if name in ("src", "href")]
        if tag not in ("img", "meta"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data + "\n"


class ReportTest(unittest.TestCase):
    def test_one_page_with_everything_in_it(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_crater(folder)
            write_summary(folder)
            write_history(folder, ["step,time,dt,volume_sand,height_axis", "1,0.1,0.1,2,1.25", "2,0.2,0.1,2,1.5"])
            (folder / "events.csv").write_text("step,time,event,bubble\n3,0.123456789,vented,2\n", encoding="utf-8")
            write_snapshot(folder, 0, {"x": np.linspace(0, 1, 9), "z": np.linspace(0, 1, 9)})
            write_snapshot(folder, 8, {"x": np.linspace(0, 1, 17), "z": np.linspace(0, 1, 9)})
            done = tool.run("report", folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("report.html", done.stdout)
            page = Reader()
            page.feed((folder / "report.html").read_text(encoding="utf-8"))
            self.assertEqual(page.open, [])
            self.assertEqual(len(page.sources), 3)
            for source in page.sources:
                self.assertTrue(source.startswith("data:image/png;base64,"))
            for words in ("finished", "16 x 8", "changed during the run", "1e-15", "fallbacks 2", "vented", "0.12346",
                          "open depth", "x_min: symmetry"):
                self.assertIn(words, page.text)
            self.assertFalse((folder / "pictures").exists())

    def test_says_what_is_wrong(self):
        with tempfile.TemporaryDirectory() as folder:
            done = tool.run("report", folder)
            self.assertEqual(done.returncode, 2)
            self.assertIn("neither field files nor a history", done.stderr)
            done = tool.run("report", pathlib.Path(folder) / "none")
            self.assertIn("there is no folder", done.stderr)


if __name__ == "__main__":
    unittest.main()
