"""The figures that tests record, as tables in markdown."""
import csv

COLUMNS = ["test", "of", "quantity", "measured", "kind", "reference", "bound", "source"]


def read_figures(path):
    """Rows of a file of tests/support/figures.hpp as dictionaries, the last of each kept."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = [dict(zip(COLUMNS, row)) for row in csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE) if row]
    latest = {(row["test"], row["of"], row["quantity"], row["source"], row["reference"]): row for row in rows}
    return list(latest.values())


def number(text):
    """A value with four digits."""
    return f"{float(text):.4g}"


def cells(row):
    """What the table says of a figure: measured, reference with its source, how far apart, how far allowed, whether it holds."""
    measured, reference, bound = (float(row[name]) for name in ("measured", "reference", "bound"))
    if row["kind"] == "relative":
        off = measured / reference - 1
        return number(measured), number(reference), f"{100 * off:+.2g} %", f"± {100 * bound:.3g} %", abs(off) <= bound
    if row["kind"] == "absolute":
        off = measured - reference
        return number(measured), number(reference), f"{off:+.2g}", f"± {bound:.3g}", abs(off) <= bound
    if row["kind"] == "at most":
        return number(measured), "", "", f"≤ {bound:.3g}", measured <= bound
    return number(measured), "", "", f"≥ {bound:.3g}", measured >= bound


def tables(rows):
    """One table per suite of tests."""
    suites = {}
    for row in rows:
        suites.setdefault(row["test"].split(".")[0].rpartition("/")[2], []).append(row)
    lines = []
    for suite, members in sorted(suites.items()):
        lines += [f"### {suite}", "", "| case | quantity | measured | reference | difference | bound | source | test |",
                  "| --- | --- | --- | --- | --- | --- | --- | --- |"]
        for row in sorted(members, key=lambda row: (row["of"], row["test"])):
            measured, reference, off, bound, holds = cells(row)
            text = [row["of"], row["quantity"], measured if holds else f"**{measured}**", reference, off, bound, row["source"],
                    f"`{row['test'].split('.')[1]}`"]
            lines.append("| " + " | ".join(word.replace("|", "\\|") for word in text) + " |")
        lines.append("")
    return "\n".join(lines)


def page(rows, when):
    """What is appended to the page of verification."""
    broken = sum(not cells(row)[4] for row in rows)
    said = "All are within their bounds." if broken == 0 else f"{broken} are beyond their bounds, in bold."
    return f"## Figures of this build\n\n{len(rows)} figures, measured {when}. {said}\n\n{tables(rows)}"
