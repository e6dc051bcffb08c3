"""Whole runs of cases: cost per cell and step, by phase."""
import dataclasses
import json
import os
import re
import resource
import statistics
import subprocess

BYTES_PER_DOUBLE = 8


class CaseError(Exception):
    """A run that failed."""


@dataclasses.dataclass
class Job:
    """A case at one size, as far as it is run."""
    group: str
    case: str
    size: str
    settings: list
    whole: bool = False  # whether it runs to the end that counts, so that its time is a result


def slug(letter, n, end, whole=False):
    """Slug of the report's Table 2 with h = 1/n, steps of CFL number 0.3."""
    return Job(f"slug {letter.upper()}, axisymmetric", f"slug/case_{letter}", f"1/{n}",
               [f"grid.x.cells={n // 2}", f"grid.z.cells={3 * n // 2}", f"time.end={end}"], whole)


def planar(n, end):
    return Job("sloshing, planar", "bench/tank", f"{n} x {2 * n}", [f"grid.x.cells={n}", f"grid.z.cells={2 * n}", f"time.end={end}"])


def space(n, end):
    return Job("overturning, 3-D", "bench/overturning_3d", f"{n}^3",
               [f"grid.{axis}.cells={n}" for axis in "xyz"] + [f"time.end={end}"])


def space_slug(n, end):
    return Job("slug E, 3-D", "slug/case_e_3d", f"1/{2 * n}",
               [f"grid.x.cells={n}", f"grid.y.cells={n}", f"grid.z.cells={3 * n}", f"time.end={end}"])


def jobs(full):
    """The sizes of the tables; short runs from the start where whole ones would take too long."""
    chosen = [slug(letter, n, 4, True) for letter in "bde" for n in (32, 64)]
    chosen += [slug(letter, 128, 0.3) for letter in "bde"] + [planar(64, 0.2), planar(128, 0.1)]
    chosen += [space(32, 0.05), space(64, 0.03), space_slug(16, 0.05)]
    if full:
        chosen += [slug(letter, 256, 0.1) for letter in "bde"] + [planar(256, 0.06), planar(512, 0.05)]
        chosen += [space(96, 0.02), space(128, 0.015), space(160, 0.012), space_slug(32, 0.03)]
    return chosen


def thread_jobs(full):
    return [slug("b", 128, 0.3), slug("e", 128, 0.1), space(100 if full else 64, 0.02)]


class Runner:
    """Runs jobs several times and keeps the medians."""

    def __init__(self, program, configs, folder, repeat):
        self.program, self.configs, self.folder, self.repeat = program, configs, folder, repeat
        folder.mkdir(parents=True, exist_ok=True)
        # Of a run on a few cells: the program and its libraries.
        self.base_mebibytes = self.run_once(space(4, 0.02), 1)["peak_memory_MiB"]

    def case_file(self, job):
        """The case with steps by CFL number in place of Table 2's small ones, and hardly any output."""
        text = (self.configs / f"{job.case}.yaml").read_text(encoding="utf-8")
        text = re.sub(r"\n  step: [^\n]*", "\n  cfl: 0.3\n  max_step: 0.005", text)
        path = self.folder / f"{job.case.replace('/', '_')}.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    def run_once(self, job, threads):
        out = self.folder / "result"
        command = [self.program, "run", self.case_file(job), "--output", out, "--overwrite", "--quiet", "--threads",
                   str(threads), "--fixed-threads", "--set", "output.fields.every=1000"]
        for setting in job.settings:
            command += ["--set", setting]
        environment = dict(os.environ, OMP_NUM_THREADS=str(threads), OMP_PROC_BIND="true")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise CaseError(f"{job.case}, {job.size}: {done.stderr.strip()}")
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        summary["user_seconds"] = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        summary["last"] = (out / "history.csv").read_text(encoding="utf-8").strip().split("\n")[-1]
        return summary

    def measure(self, job, threads):
        """A dict of medians; costs in microseconds per cell and step."""
        runs = [self.run_once(job, threads) for _ in range(self.repeat)]
        first = runs[0]
        if any(run["last"] != first["last"] for run in runs):
            raise CaseError(f"{job.case}, {job.size}: runs differ")
        cell_steps = first["cells"] * first["steps"]
        costs = [1e6 * run["step_seconds"] / cell_steps for run in runs]
        memory = (first["peak_memory_MiB"] - self.base_mebibytes) * 2**20 / BYTES_PER_DOUBLE / first["cells"]
        return {"group": job.group, "size": job.size, "threads": threads, "cells": first["cells"], "steps": first["steps"],
                "whole": job.whole, "seconds": statistics.median(run["wall_seconds"] for run in runs),
                "cost": statistics.median(costs), "spread": max(costs) - min(costs),
                "user": statistics.median(1e6 * run["user_seconds"] / cell_steps for run in runs), "memory": memory,
                "phases": {name: statistics.median(run["phases"][name]["microseconds_per_cell_step"] for run in runs)
                           for name in first["phases"]},
                "linear": first["phases"]["diffusion"]["linear_iterations"] / first["steps"], "last": first["last"]}
