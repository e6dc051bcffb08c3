#!/usr/bin/python3
"""tools/check_layers on small made-up trees."""
import importlib.machinery
import importlib.util
import pathlib
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_layers"
loader = importlib.machinery.SourceFileLoader("check_layers", str(TOOL))
check_layers = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_layers", loader))
loader.exec_module(check_layers)


class CheckLayersTest(unittest.TestCase):
    def problems(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return check_layers.check(pathlib.Path(folder))

    def test_good_tree(self):
        self.assertEqual(self.problems({
            "core/hdf5_file.cpp": "#include <hdf5.h>\n",
            "core/loop.hpp": "#pragma omp simd\n",
            "solvers/a.cpp": '#include <HYPRE_struct_ls.h>\n#include <mpi.h>\n#include "core/grid.hpp"\n',
            "app/main.cpp": '#include "physics/flow.hpp"\n',
        }), [])

    def test_each_rule(self):
        for files, words in [
            ({"core/a.hpp": '#include "physics/flow.hpp"\n'}, "a layer above"),
            ({"core/a.hpp": '#include "grid.hpp"\n'}, "not written from src"),
            ({"core/a.hpp": "#include <hdf5.h>\n"}, "belongs in a .cpp"),
            ({"app/a.cpp": "#include <yaml-cpp/yaml.h>\n"}, "belongs in a .cpp file of src/core"),
            ({"solvers/a.cpp": "#include <HYPRE.h>\n", "solvers/b.cpp": "#include <_hypre_utilities.h>\n"}, "more than one"),
            ({"physics/a.cpp": "  # pragma omp parallel\n"}, "OpenMP pragma"),
            ({"physics/a.cpp": "\n" * 401}, "401 lines"),
            ({"extra/a.cpp": ""}, "not in one of the layers"),
        ]:
            found = self.problems(files)
            self.assertEqual(len(found), 1, found)
            self.assertIn(words, found[0])


if __name__ == "__main__":
    unittest.main()
