"""Kernels one by one, by Google Benchmark."""
import json
import os
import subprocess


def measure(program, full, thread_counts):
    """Returns a list of dicts: name, size, threads, seconds per cell, bytes per cell, spread."""
    sizes = ["2", "512", "3", "96"] if full else ["2", "256", "3", "48"]
    rows = []
    for threads in thread_counts:
        command = [program, "--benchmark_format=json", "--benchmark_repetitions=5", "--benchmark_min_time=0.05",
                   "--benchmark_report_aggregates_only=true", str(threads)] + sizes
        text = subprocess.run(command, check=True, capture_output=True, text=True,
                              env=dict(os.environ, OMP_PROC_BIND="true")).stdout
        by_name = {}
        for entry in json.loads(text)["benchmarks"]:
            by_name.setdefault(entry["run_name"], {})[entry["aggregate_name"]] = entry
        unit = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}
        for name, entry in by_name.items():
            median = entry["median"]
            scale = unit[median["time_unit"]] / median["cells"]
            rows.append({"kernel": name, "threads": threads, "cells": int(median["cells"]),
                         "seconds": median["real_time"] * scale, "spread": entry["stddev"]["real_time"] * scale,
                         "bytes": median["bytes_per_cell"]})
    return rows
