"""The index page of the tour: one HTML file beside its pictures."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from beltrami.cli.chapters.chapter import Chapter

_STYLE = """
:root { color-scheme: light dark; --line: #8884; --quiet: #777; --ink: #223; --paper: #fff; }
@media (prefers-color-scheme: dark) { :root { --ink: #dde; --paper: #16181d; --quiet: #9aa; } }
body { font: 16px/1.55 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 60rem; margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.9rem; margin: 0; } h2 { margin: 3rem 0 .3rem; }
nav { display: flex; flex-wrap: wrap; gap: .2rem 1rem; }
p { max-width: 46rem; } .section { color: var(--quiet); }
.warning { border-left: 4px solid #c80; padding-left: .8rem; }
figure { margin: 1.2rem 0; }
img { max-width: 100%; height: auto; border-radius: 8px; background: #fff; }
figcaption { color: var(--quiet); font-size: .92rem; max-width: 46rem; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; margin: 1rem 0; }
th, td { text-align: left; padding: .25rem 1rem .25rem 0; border-bottom: 1px solid var(--line);
  font-variant-numeric: tabular-nums; }
pre { padding: .7rem 1rem; border: 1px solid var(--line); border-radius: 8px; overflow-x: auto; }
"""


def index_page(title: str, notes: Sequence[str], chapters: Sequence[Chapter]) -> str:
    """Return the page: a contents list, then each chapter; everything is escaped.

    Examples
    --------
    >>> page = index_page("a < b", [], [Chapter("One", "3.1", ("text",))])
    >>> "a &lt; b" in page, '<h2 id="one">One</h2>' in page
    (True, True)
    """
    links = "".join(f'<a href="#{_anchor(c)}">{escape(c.title)}</a>' for c in chapters)
    return "\n".join(
        [
            '<!doctype html><html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{escape(title)}</title><style>{_STYLE}</style></head><body>",
            f"<h1>{escape(title)}</h1>",
            *(f"<p>{escape(note)}</p>" for note in notes),
            f"<nav>{links}</nav>",
            *(_section(chapter) for chapter in chapters),
            "</body></html>\n",
        ]
    )


def _anchor(chapter: Chapter) -> str:
    return re.sub(r"\W+", "-", chapter.title.lower()).strip("-")


def _section(chapter: Chapter) -> str:
    """Write one chapter."""
    told = [f"Section {escape(chapter.section)}"] if chapter.section else []
    if chapter.seconds is not None:
        told.append(f"{chapter.seconds:.1f} s")
    section = f'<p class="section">{" · ".join(told)}</p>' if told else ""
    return "\n".join(
        [
            f'<section><h2 id="{_anchor(chapter)}">{escape(chapter.title)}</h2>{section}',
            *(f"<p>{escape(paragraph)}</p>" for paragraph in chapter.text),
            *(f'<p class="warning">Warning: {escape(line)}</p>' for line in chapter.warnings),
            _table(chapter.rows),
            *(
                f'<figure><img src="{escape(figure.name)}" alt="{escape(figure.caption)}">'
                f"<figcaption>{escape(figure.caption)}</figcaption></figure>"
                for figure in chapter.figures
            ),
            _files(chapter.files),
            _commands(chapter.commands),
            "</section>",
        ]
    )


def _table(rows: Sequence[Sequence[str]]) -> str:
    if not rows:
        return ""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in rows[0])
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows[1:]
    )
    return f'<div class="scroll"><table><tr>{head}</tr>{body}</table></div>'


def _files(files: Sequence[tuple[str, str]]) -> str:
    if not files:
        return ""
    items = "".join(
        f'<li><a href="{escape(name)}">{escape(name)}</a>: {escape(what)}</li>'
        for name, what in files
    )
    return f"<ul>{items}</ul>"


def _commands(commands: Sequence[str]) -> str:
    return f"<pre>{escape(chr(10).join(commands))}</pre>" if commands else ""
