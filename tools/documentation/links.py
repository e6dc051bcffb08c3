"""Whether what pages point to is there: files and anchors of links, paths and file names in code."""
import re

from .pages import Page

# Folders of the repository, and those of src/, which text names without it.
TOP = ("src", "tests", "tools", "configs", "docs", "cmake", "bench", "examples", ".ci")
LAYERS = ("core", "solvers", "physics", "app")
PATH = re.compile(rf"(?:\.\./)*(?:{'|'.join(re.escape(folder) for folder in TOP + LAYERS)})/(?:[\w./*-]|\{{[^{{}}]*\}})+")
FILE = re.compile(r"^[\w-]+\.(?:cpp|hpp)$|^[\w-]+_test\.py$")
SHELL = ("", "sh", "bash", "console")


def documents(root):
    """The pages of a repository, in the order in which they are read."""
    first = ["README.md", "docs/user_guide.md"]
    last = ["CONTRIBUTING.md", "CHANGELOG.md"]
    found = sorted(path.relative_to(root).as_posix() for path in [*root.glob("*.md"), *root.glob("docs/**/*.md")])
    order = [name for name in first if name in found]
    order += [name for name in found if name not in first + last]
    return [root / name for name in order + [name for name in last if name in found]]


def is_external(target):
    return re.match(r"[a-z][a-z0-9+.-]*:", target) is not None


def braces(pattern):
    """What {a,b} in a path stands for."""
    match = re.search(r"\{([^{}]*)\}", pattern)
    if not match:
        return [pattern]
    return [one for word in match[1].split(",")
            for one in braces(pattern[:match.start()] + word.strip() + pattern[match.end():])]


def is_there(root, name):
    """Whether a path of the text names something in the repository; stars stand for anything, cases go without .yaml."""
    for base in (root, root / "src", root / "docs", root / "configs"):
        if all(any(base.glob(one)) if "*" in one else (base / one).exists() or (base / f"{one}.yaml").exists()
               for one in braces(name.rstrip("./"))):
            return True
    return False


def problems(root):
    """What is broken in the pages of a repository, as lines of text."""
    pages = {path: Page(path) for path in documents(root)}
    names = {path.name for folder in TOP for path in (root / folder).rglob("*") if path.suffix in (".cpp", ".hpp", ".py")}
    found = []
    for path, page in pages.items():
        where = path.relative_to(root)
        for target, line in page.links:
            if is_external(target):
                continue
            file, _, fragment = target.partition("#")
            aim = (path.parent / file).resolve() if file else path
            if not aim.exists():
                found.append(f"{where}:{line}: there is no {target}")
            elif root.resolve() not in [aim, *aim.parents]:
                found.append(f"{where}:{line}: {target} lies outside the repository")
            elif fragment:
                aimed = pages.get(aim) or (Page(aim) if aim.suffix == ".md" else None)
                if aimed is None or fragment not in aimed.anchors:
                    found.append(f"{where}:{line}: {target} names no heading")
        for code, line in page.codes:
            for name in PATH.findall(code) if "<" not in code and "NAME" not in code else []:
                if code.startswith(name) and not is_there(root, name):
                    found.append(f"{where}:{line}: there is no {name}")
            if FILE.match(code) and code not in names:
                found.append(f"{where}:{line}: there is no file {code}")
        for language, block, line in page.blocks:
            if language not in SHELL:
                continue
            for word in re.findall(r"(?<![\w./-])(?:tools|configs|examples|docs)/[\w./-]+", block):
                if not is_there(root, word):
                    found.append(f"{where}:{line}: there is no {word}")
    return found
