"""A page of HTML that needs no other file."""
import base64
import html
import pathlib

STYLE = """
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #20262e; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: 0; } h2 { font-size: 1.15rem; margin-top: 2.2rem; border-bottom: 1px solid #d8dce0; }
table { border-collapse: collapse; margin: .8rem 0; font-variant-numeric: tabular-nums; }
td, th { padding: .15rem .8rem .15rem 0; text-align: right; white-space: nowrap; } th { font-weight: 600; border-bottom: 1px solid #d8dce0; }
td:first-child, th:first-child { text-align: left; }
img { max-width: 100%; display: block; margin: 1rem 0; } figure { margin: 0; } figcaption { color: #5b6570; font-size: .9rem; }
pre { background: #f4f6f8; padding: .8rem; overflow-x: auto; font-size: .85rem; } .aside { color: #5b6570; }
.good { color: #2f7a45; } .bad { color: #b5483f; font-weight: 600; }
@media print { body { margin: 0; } }
"""


def escaped(value):
    return html.escape(str(value))


def number(value):
    """A figure for reading: five digits, nothing where there is none."""
    if value is None:
        return ""
    return escaped(value) if isinstance(value, (str, int)) else f"{value:.5g}"


class Page:
    """Sections one after the other."""

    def __init__(self, title):
        self.title = title
        self.parts = []

    def heading(self, text):
        self.parts.append(f"<h2>{escaped(text)}</h2>")

    def paragraph(self, text, look="aside"):
        self.parts.append(f'<p class="{look}">{escaped(text)}</p>')

    def table(self, head, rows):
        cells = "".join(f"<th>{escaped(name)}</th>" for name in head)
        lines = "".join("<tr>" + "".join(f"<td>{number(cell)}</td>" for cell in row) + "</tr>" for row in rows)
        self.parts.append(f"<table><tr>{cells}</tr>{lines}</table>")

    def picture(self, path, caption):
        data = base64.b64encode(pathlib.Path(path).read_bytes()).decode()
        self.parts.append(f'<figure><img alt="{escaped(caption)}" src="data:image/png;base64,{data}">'
                          f"<figcaption>{escaped(caption)}</figcaption></figure>")

    def text_file(self, name, text):
        self.parts.append(f"<details><summary>{escaped(name)}</summary><pre>{escaped(text)}</pre></details>")

    def html(self):
        return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escaped(self.title)}</title>'
                f"<style>{STYLE}</style></head><body><h1>{escaped(self.title)}</h1>\n" + "\n".join(self.parts)
                + "\n</body></html>\n")
