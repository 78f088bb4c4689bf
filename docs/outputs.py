"""Run the code on the pages of the site, and write what it prints below it.

python docs/outputs.py [PAGE ...]

Pages are named as in the site: start, howto/scans. All of them by default. The tests compare.
"""

import contextlib
import io
import os
import re
import shlex
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).parent
PAGES = (
    "index",
    "start",
    "viewer",
    *sorted(f"howto/{p.stem}" for p in (DOCS / "howto").glob("*.md")),
)
BLOCK = re.compile(r"^```(python|text|console)\n(.*?)^```\n", re.DOTALL | re.MULTILINE)


def run_python(text, scope, page):
    """Run a block in the scope of its page; return what it prints."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(text, f"{page}.md", "exec"), scope)  # noqa: S102
    return said.getvalue()


def run_console(text):
    """Run the lines that begin with the command; the tour has tests of its own."""
    from typer.testing import CliRunner

    from beltrami.cli.app import app

    for line in re.findall(r"^\$ beltrami (?!tour)(.*)$", text, re.MULTILINE):
        done = CliRunner().invoke(app, shlex.split(line))
        if done.exit_code:
            raise RuntimeError(f"beltrami {line}: {done.output}")


def refreshed(page, text):
    """Run a page in a folder of its own; return its text with what was printed."""
    parts, scope, said, done = [], {}, "", 0
    for found in BLOCK.finditer(text):
        parts.append(text[done : found.start()])
        done = found.end()
        kind, block = found.groups()
        if said and kind != "text":
            parts.insert(-1, f"\n```text\n{said.rstrip()}\n```\n")
            said = ""
        if kind == "text" and said:
            parts.append(f"```text\n{said.rstrip()}\n```\n")
            said = ""
            continue
        parts.append(found[0])
        if kind == "python":
            said = run_python(block, scope, page)
        elif kind == "console":
            run_console(block)
    end = f"\n```text\n{said.rstrip()}\n```\n" if said else ""
    return "".join([*parts, end, text[done:]])


def main(pages):
    """Refresh the pages."""
    for page in pages or PAGES:
        place = (DOCS / f"{page}.md").resolve()
        text = place.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            fresh = refreshed(page, text)
        if fresh != text:
            place.write_text(fresh, encoding="utf-8")
        print(page, "changed" if fresh != text else "as it was", file=sys.stderr)


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    main(sys.argv[1:])
