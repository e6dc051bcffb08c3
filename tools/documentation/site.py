"""The pages as a site of static files that opens without a network or a server."""
import html
import os
import shutil

from pygments.formatters import HtmlFormatter

from .links import documents, is_external
from .pages import Page, source_page

LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".py": "python", ".yaml": "yaml", ".cmake": "cmake", ".json": "json", ".sh": "bash"}
PICTURES = (".png", ".svg", ".jpg")

STYLE = """
:root { --ink: #20262e; --faint: #5d6875; --line: #d9dee4; --accent: #17456b; --back: #fff; --side: #f5f7f9; }
* { box-sizing: border-box; }
body { margin: 0; color: var(--ink); background: var(--back); font: 16px/1.55 system-ui, "DejaVu Sans", sans-serif; display: flex; }
nav { flex: 0 0 17rem; height: 100vh; position: sticky; top: 0; overflow-y: auto; padding: 1.4rem 1.2rem; background: var(--side);
  border-right: 1px solid var(--line); font-size: 0.9rem; }
nav .name { font-weight: 700; font-size: 1.1rem; display: block; margin-bottom: 0.8rem; color: var(--ink); }
nav ul { list-style: none; margin: 0; padding: 0; } nav ul ul { padding-left: 0.9rem; }
nav li { margin: 0.25rem 0; } nav a { color: var(--faint); } nav a:hover, nav .here > a { color: var(--accent); }
nav .here > a { font-weight: 600; }
main { flex: 1 1 auto; min-width: 0; max-width: 62rem; padding: 1.6rem 2.4rem 4rem; }
a { color: var(--accent); text-decoration: none; } a:hover { text-decoration: underline; }
h1 { line-height: 1.2; } h2 { margin-top: 2.2rem; border-bottom: 1px solid var(--line); padding-bottom: 0.2rem; } h3 { margin-top: 1.7rem; }
code { font: 0.88em ui-monospace, "DejaVu Sans Mono", monospace; background: var(--side); padding: 0.1em 0.25em; border-radius: 3px; }
pre { background: var(--side); border: 1px solid var(--line); border-radius: 5px; padding: 0.8rem 1rem; overflow-x: auto; line-height: 1.4; }
pre code { background: none; padding: 0; }
img { max-width: 100%; height: auto; }
table { border-collapse: collapse; display: block; overflow-x: auto; font-size: 0.92rem; margin: 1rem 0; }
th, td { border: 1px solid var(--line); padding: 0.3rem 0.6rem; text-align: left; vertical-align: top; } th { background: var(--side); }
blockquote { margin: 1rem 0; padding-left: 1rem; border-left: 3px solid var(--line); color: var(--faint); }
@media (max-width: 60rem) { body { display: block; } nav { height: auto; position: static; } nav ul ul { display: none; } main { padding: 1rem; } }
@media print { nav { display: none; } }
"""


def page_name(root, path):
    """The HTML file of a markdown file."""
    name = path.relative_to(root).as_posix()
    if name == "README.md":
        return "index.html"
    return name.removeprefix("docs/").removesuffix(".md").lower() + ".html"


class Site:
    """All pages of a repository, and the files that they link to."""

    def __init__(self, root, out):
        self.root, self.out = root.resolve(), out
        self.pages = {path.resolve(): path for path in documents(root)}
        self.titles = {}
        self.linked = set()  # files and folders of the repository that pages link to

    def address(self, page, target, here):
        """Where a link of a page leads in the site. `here`: the HTML file that holds it."""
        if is_external(target):
            return target
        file, _, fragment = target.partition("#")
        mark = "#" + fragment if fragment else ""
        if not file:
            return mark
        aim = (page.parent / file).resolve()
        if aim in self.pages:
            name = page_name(self.root, aim)
        elif aim.suffix in PICTURES:
            name = "files/" + aim.relative_to(self.root).as_posix()
            self.copy(aim, name)
        else:
            self.linked.add(aim)
            name = self.file_name(aim)
        return os.path.relpath(name, os.path.dirname(here) or ".") + mark

    def file_name(self, path):
        name = "files/" + path.relative_to(self.root).as_posix()
        return name + ("/index.html" if path.is_dir() else ".html")

    def copy(self, path, name):
        (self.out / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, self.out / name)

    def navigation(self, here, headings):
        lines = ["<nav>", f'<a class="name" href="{os.path.relpath("index.html", os.path.dirname(here) or ".")}">Quicksand</a>', "<ul>"]
        for path in self.pages:
            name = page_name(self.root, path)
            current = name == here
            link = os.path.relpath(name, os.path.dirname(here) or ".")
            lines.append(f'<li{" class=here" if current else ""}><a href="{link}">{html.escape(self.titles[path])}</a>')
            if current:
                parts = [f'<li><a href="#{mark}">{html.escape(text)}</a></li>' for level, text, mark, _ in headings if level == 2]
                lines.append("<ul>" + "".join(parts) + "</ul>")
            lines.append("</li>")
        return "\n".join(lines + ["</ul>", "</nav>"])

    def write(self, name, title, body, headings=()):
        text = (f'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
                f'<meta name="viewport" content="width=device-width, initial-scale=1">\n<title>{html.escape(title)} - Quicksand</title>\n'
                f"<style>{STYLE}{HtmlFormatter(style='friendly').get_style_defs('.code')}</style>\n</head>\n<body>\n"
                f"{self.navigation(name, headings)}\n<main>\n{body}\n</main>\n</body>\n</html>\n")
        (self.out / name).parent.mkdir(parents=True, exist_ok=True)
        (self.out / name).write_text(text, encoding="utf-8")

    def write_linked(self):
        """Pages of the linked source files and folders, and of what these folders list."""
        done = set()
        while self.linked - done:
            path = (self.linked - done).pop()
            done.add(path)
            title = path.relative_to(self.root).as_posix()
            here = self.file_name(path)
            if path.is_dir():
                entries = [entry for entry in sorted(path.iterdir()) if not entry.name.startswith((".", "__"))]
                self.linked.update(entry for entry in entries if entry.is_dir() or entry.suffix not in PICTURES)
                items = [f'<li><a href="{self.address(path / "x", entry.name, here)}">{html.escape(entry.name)}</a></li>'
                         for entry in entries]
                body = f"<h1>{html.escape(title)}</h1>\n<ul>{''.join(items)}</ul>"
            else:
                try:
                    text = path.read_text(encoding="utf-8")
                except UnicodeDecodeError:
                    continue
                language = LANGUAGES.get(path.suffix) or {"CMakeLists.txt": "cmake"}.get(path.name)
                if language is None and text.startswith("#!"):
                    language = "python" if "python" in text.split("\n", 1)[0] else "bash"
                body = f"<h1>{html.escape(title)}</h1>\n{source_page(text, language)}"
            self.write(here, title, body)

    def build(self, additions):
        """Writes all pages. \\param additions: markdown to append, by the name of the page's file below the root"""
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir(parents=True)
        parsed = {}
        for path in self.pages:
            name = path.relative_to(self.root).as_posix()
            more = additions.get(name)
            parsed[path] = Page(path, path.read_text(encoding="utf-8") + "\n" + more if more else None)
            self.titles[path] = parsed[path].title
        for path, page in parsed.items():
            name = page_name(self.root, path)
            body = page.html(lambda target, path=path, name=name: self.address(path, target, name))
            self.write(name, page.title, body, page.headings)
        self.write_linked()
