"""Pages with the source: those that the map of the chapter and the API lead to."""

import importlib
import inspect
import re
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path

from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer

ROOT = Path(__file__).parents[2]
_LINK = re.compile(r"\]\(\.\./((?:src|tests|benchmarks|examples)/[\w/]+\.py)\)")

_PAGE = """:root { color-scheme: light dark }
body { font: 16px system-ui, sans-serif; margin: 1em auto; max-width: 60em; padding: 0 1em }
pre { line-height: 1.35; overflow-x: auto }
"""


@cache
def line_of(module: str, name: str) -> tuple[str, int] | None:
    """Return the file, without its suffix, and the line where an object begins."""
    thing = importlib.import_module(module)
    for part in name.split("."):
        thing = inspect.getattr_static(thing, part, None) or getattr(thing, part, None)
    thing = getattr(thing, "fget", None) or getattr(thing, "func", None) or thing
    try:
        path = Path(inspect.getsourcefile(inspect.unwrap(thing)))
        line = inspect.getsourcelines(thing)[1]
    except (TypeError, OSError):
        return None
    inside = path.is_relative_to(ROOT)
    return (str(path.relative_to(ROOT)).removesuffix(".py"), max(line, 1)) if inside else None


def lead_to_pages(_app, _page, source):
    """Let links to Python files of the repository lead to their pages."""
    source[0] = _LINK.sub(lambda m: f"](code:{m[1].removesuffix('.py')})", source[0])


def pages(_app):
    """Make a page of each file of the source, of the tests and of the examples."""
    paths = [
        path
        for folder in ("src", "tests", "benchmarks", "examples")
        for path in sorted((ROOT / folder).rglob("*.py"))
    ]
    with ProcessPoolExecutor() as pool:  # twelve seconds of one core
        for path, body in zip(paths, pool.map(body_of, paths, chunksize=16), strict=True):
            name = str(path.relative_to(ROOT))
            context = {"title": name, "body": body}
            yield f"code/{name.removesuffix('.py')}", context, "code.html"


def body_of(path):
    """Return a file as lines of HTML, each with its anchor."""
    formatter = HtmlFormatter(lineanchors="L", linenos=False)
    return highlight(path.read_text(encoding="utf-8"), PythonLexer(), formatter)


def write_style(app, failure):
    """Write the colours of the code, for light and for dark screens."""
    if failure is not None:
        return
    light = HtmlFormatter(style="friendly").get_style_defs(".highlight")
    dark = HtmlFormatter(style="github-dark").get_style_defs(".highlight")
    text = f"{_PAGE}{light}\n@media (prefers-color-scheme: dark) {{\n{dark}\n}}\n"
    Path(app.outdir, "_static", "code.css").write_text(text, encoding="utf-8")


def setup(app):
    """Register the pages."""
    app.connect("source-read", lead_to_pages)
    app.connect("html-collect-pages", pages)
    app.connect("build-finished", write_style)
    return {"parallel_read_safe": True}
