"""Markdown files as pages: their headings, links and code, and their HTML."""
import html
import re
import unicodedata

from markdown_it import MarkdownIt
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_by_name
from pygments.util import ClassNotFound

SAME_ANCHOR = re.compile(r"[^\w\- ]")


def anchor(heading, taken):
    """The anchor that GitHub gives a heading, made unique."""
    text = unicodedata.normalize("NFC", heading).strip().lower()
    name = SAME_ANCHOR.sub("", text).replace(" ", "-")
    unique, n = name, 0
    while unique in taken:
        n += 1
        unique = f"{name}-{n}"
    taken.add(unique)
    return unique


def plain(token):
    """Text of an inline token, without its markup."""
    return "".join(child.content if child.type in ("text", "code_inline") else " " if child.type == "softbreak" else ""
                   for child in token.children or [])


class Page:
    """A markdown file. `headings`: (level, text, anchor, line); `links`: (target, line); `codes` and `blocks`: code in the
    text and fenced blocks with their lines."""

    def __init__(self, path, text=None):
        self.path = path
        self.tokens = MarkdownIt("commonmark").enable("table").parse(path.read_text(encoding="utf-8") if text is None else text)
        self.headings, self.links, self.codes, self.blocks = [], [], [], []
        taken = set()
        line = 1
        for number, token in enumerate(self.tokens):
            line = token.map[0] + 1 if token.map else line
            if token.type == "heading_open":
                heading = plain(self.tokens[number + 1])
                name = anchor(heading, taken)
                token.attrSet("id", name)
                self.headings.append((int(token.tag[1]), heading, name, line))
            elif token.type == "fence":
                self.blocks.append((token.info.strip(), token.content, line))
            for child in token.children or []:
                if child.type in ("link_open", "image"):
                    self.links.append((child.attrGet("href") or child.attrGet("src"), line))
                elif child.type == "code_inline":
                    self.codes.append((child.content, line))

    @property
    def title(self):
        return self.headings[0][1] if self.headings else self.path.stem

    @property
    def anchors(self):
        return {name for _, _, name, _ in self.headings}

    def html(self, address):
        """The page's body; `address` turns the target of a link into that of the site."""
        for token in self.tokens:
            for child in token.children or []:
                for attribute in ("href", "src"):
                    target = child.attrGet(attribute)
                    if target:
                        child.attrSet(attribute, address(target))
        renderer = MarkdownIt("commonmark", {"highlight": highlighted}).enable("table")
        return renderer.renderer.render(self.tokens, renderer.options, {})


def highlighted(code, language, _attributes=None):
    """A block of code with its words in colours."""
    try:
        lexer = get_lexer_by_name(language or "text")
    except ClassNotFound:
        lexer = TextLexer()
    return f'<pre class="code"><code>{highlight(code, lexer, HtmlFormatter(nowrap=True))}</code></pre>'


def source_page(text, language):
    """A source file as the body of a page."""
    return highlighted(text, language) if language else f"<pre>{html.escape(text)}</pre>"
