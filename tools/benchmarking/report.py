"""Tables and plots of what was measured."""
import csv
import math

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

SHORT = {"convection": "convect", "mac_projection": "MAC", "redistribute_volume": "volume",
         "redistribute_momentum": "momentum", "diffusion": "diffusion", "projection": "pressure"}


def exponent(rows):
    """Slope of log cost per cell and step over log cells between the two largest sizes."""
    (a, b) = sorted(rows, key=lambda row: row["cells"])[-2:]
    return 1 + math.log(b["cost"] / a["cost"]) / math.log(b["cells"] / a["cells"])


class Report:
    """Collects tables; write() makes bench.txt, bench.md, a csv file per table, and plots."""

    def __init__(self, folder, machine):
        self.folder, self.machine, self.tables = folder, machine, []

    def add(self, name, title, head, rows):
        self.tables.append((title, head, rows))
        with open(self.folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([head] + rows)

    def kernels(self, rows):
        triad = {row["threads"]: row["bytes"] / row["seconds"] for row in rows if row["kernel"].startswith("triad")}
        one = {row["kernel"]: row["seconds"] for row in rows if row["threads"] == 1}
        table = []
        for row in rows:
            bandwidth = row["bytes"] / row["seconds"]
            efficiency = one[row["kernel"]] / row["seconds"] / row["threads"]
            table.append([row["kernel"], row["threads"], f"{1e9 * row['seconds']:.2f}", f"{1e9 * row['spread']:.2f}",
                          f"{row['bytes']:.0f}", f"{bandwidth / 1e9:.1f}", f"{100 * bandwidth / triad[row['threads']]:.0f} %",
                          f"{100 * efficiency:.0f} %"])
        self.add("kernels", "Kernels against the triad (spread: standard deviation)",
                 ["kernel", "threads", "ns/cell", "spread", "bytes/cell", "GB/s", "of triad", "efficiency"], table)
        self.plot_roofline([row for row in rows if row["threads"] == 1], triad[1])

    def plot_roofline(self, rows, bandwidth):
        figure, axes = pyplot.subplots(figsize=(7, 5), layout="constrained")
        for row in rows:
            axes.loglog(row["bytes"], 1e9 * row["seconds"], "o", color="tab:blue")
            axes.annotate(" " + row["kernel"], (row["bytes"], 1e9 * row["seconds"]), fontsize=6)
        limits = [min(row["bytes"] for row in rows), max(row["bytes"] for row in rows)]
        axes.loglog(limits, [1e9 * bytes_ / bandwidth for bytes_ in limits], "k--", label="triad")
        axes.set(xlabel="bytes per cell", ylabel="ns per cell", title="Kernels on one thread")
        axes.legend()
        figure.savefig(self.folder / "kernels.png", dpi=150)

    def cases(self, rows):
        head = ["case", "h or cells", "cells", "steps", "us/cell/step", "spread", "user", *SHORT.values(), "linear it.",
                "doubles/cell", "whole run, s"]
        table = [[row["group"], row["size"], row["cells"], row["steps"], f"{row['cost']:.2f}", f"{row['spread']:.2f}",
                  f"{row['user']:.2f}", *(f"{row['phases'][phase]:.2f}" for phase in SHORT), f"{row['linear']:.1f}",
                  f"{row['memory']:.0f}" if row["cells"] > 1e5 else "-", f"{row['seconds']:.1f}" if row["whole"] else "-"]
                 for row in rows]
        self.add("cases", "Cases on one thread, microseconds per cell and step", head, table)
        groups = {}
        for row in rows:
            groups.setdefault(row["group"], []).append(row)
        self.add("size", "Cost against size: exponent of the time of a step over cells, two largest sizes",
                 ["case", "exponent"], [[name, f"{exponent(of)}"[:5]] for name, of in groups.items() if len(of) > 1])
        figure, axes = pyplot.subplots(figsize=(7, 5), layout="constrained")
        for name, of in groups.items():
            axes.loglog([row["cells"] for row in of], [row["cost"] for row in of], "o-", label=name)
        axes.set(xlabel="cells", ylabel="microseconds per cell and step", title="One thread")
        axes.legend(fontsize=8)
        figure.savefig(self.folder / "cases.png", dpi=150)

    def threads(self, rows):
        one = {(row["group"], row["size"]): row for row in rows if row["threads"] == 1}
        table = []
        for row in rows:
            alone = one[row["group"], row["size"]]
            same = "yes" if alone["last"] == row["last"] else "NO"
            table.append([row["group"], row["size"], row["threads"], f"{row['cost']:.2f}", f"{row['spread']:.2f}",
                          f"{alone['cost'] / row['cost']:.2f}",
                          *(f"{alone['phases'][phase] / max(row['phases'][phase], 1e-9):.2f}" for phase in SHORT), same])
        self.add("threads", "Threads (bound): speed-up as a whole and by phase",
                 ["case", "h or cells", "threads", "us/cell/step", "spread", "speed-up", *SHORT.values(), "same result"], table)

    def write(self):
        text, markdown = [], []
        for key, value in self.machine:
            text.append(f"{key + ':':14}{value}")
            markdown.append(f"* {key}: {value}")
        for title, head, rows in self.tables:
            widths = [max(len(str(row[k])) for row in [head] + rows) for k in range(len(head))]
            text += ["", title] + ["  ".join(str(v).ljust(w) for v, w in zip(row, widths)) for row in [head] + rows]
            markdown += ["", f"### {title}", "", "| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
            markdown += ["| " + " | ".join(str(v) for v in row) + " |" for row in rows]
        (self.folder / "bench.txt").write_text("\n".join(text) + "\n", encoding="utf-8")
        (self.folder / "bench.md").write_text("\n".join(markdown) + "\n", encoding="utf-8")
        print("\n".join(text))
        print(f"\nbench: tables and plots are in {self.folder}")
