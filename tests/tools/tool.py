"""Runs the Python tools inside the test's own process, which saves the start of each."""
import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import subprocess
import sys

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))


def load(name):
    """The tool of that name as a module."""
    if name not in sys.modules:
        loader = importlib.machinery.SourceFileLoader(name, str(TOOLS / name))
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
        loader.exec_module(module)
        sys.modules[name] = module
    return sys.modules[name]


def run(name, *arguments):
    """What the tool's main() prints and returns for these arguments."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = load(name).main([str(argument) for argument in arguments])
        except SystemExit as end:
            code = end.code
    return subprocess.CompletedProcess([name, *arguments], code, out.getvalue(), err.getvalue())
