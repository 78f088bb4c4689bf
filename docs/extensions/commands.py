"""The command line: one page with the help of every verb, as the command itself prints it."""

from pathlib import Path

from typer.main import get_command
from typer.testing import CliRunner

from beltrami.cli.app import app as program

_HEAD = """# Command line

Files in, files out: `-o` names the result, `--data` a file with a function on the vertices,
`--json` asks for output that machines read. Exit codes: 0, 1 for bad input (one clear line that
names it), 2 for usage.
"""


def _help(*words: str) -> str:
    plain = {"COLUMNS": "84", "TERM": "dumb", "NO_COLOR": "1", "TERMINAL_WIDTH": "84"}
    done = CliRunner().invoke(program, [*words, "--help"], env=plain, prog_name="beltrami")
    if done.exit_code:
        raise RuntimeError(done.output)
    return "\n".join(line.rstrip() for line in done.output.strip("\n").splitlines())


def page() -> str:
    """Return the page, in Markdown."""
    parts = [_HEAD, f"```text\n{_help()}\n```\n"]
    for verb in get_command(program).commands:
        parts.append(f"## {verb}\n\n```text\n{_help(verb)}\n```\n")
    return "\n".join(parts)


def write(app):
    """Write the page, if it changed."""
    place, text = Path(app.srcdir, "commands.md"), page()
    if not place.exists() or place.read_text(encoding="utf-8") != text:
        place.write_text(text, encoding="utf-8")


def setup(app):
    """Register the page."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
